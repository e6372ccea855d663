// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/projection_samples.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "transfer/place_many.hpp"

namespace tenon::transfer {

namespace {

constexpr int fewest = 2, most = 6;                                  // sub-cells along an edge
constexpr std::size_t small_batch = 1 << 14, large_batch = 1 << 18;  // points

/// Collective. Box around all containers of all ranks.
Box box_of(const Communicator& comm, const Containers& containers) {
  Box mine;
  for (const Box& box : containers.set.boxes)
    if (!box.empty()) mine.add(box);
  std::array<double, 6> ends{-mine.low[0], -mine.low[1], -mine.low[2], mine.high[0], mine.high[1], mine.high[2]};
  comm.max(std::span<double>(ends));
  Box box;
  box.low = {-ends[0], -ends[1], -ends[2]};
  box.high = {ends[3], ends[4], ends[5]};
  return box;
}

/// Makes the points of the owned source elements that lie in the target's box, some elements at a time: what search
/// needs for a point is several times what is kept of it.
class Candidates {
 public:
  Candidates(const Side& source, const Box& box, double spacing, SampleTables& tables)
      : source_(source), box_(box), spacing_(spacing), tables_(tables) {}

  std::vector<Vec3> points;
  std::vector<Sample> samples;
  std::int64_t sought = 0;

  /// At least `count` points, unless there are no more.
  void next(std::size_t count) {
    points.clear(), samples.clear();
    for (; block_ < source_.mesh.blocks.size(); ++block_, element_ = 0) {
      const ElementBlock& block = source_.mesh.blocks[block_];
      for (; element_ < block.size(); ++element_, ++item_) {
        if (points.size() >= count) return;
        if (block.owners[static_cast<std::size_t>(element_)] == source_.mesh.comm.rank()) add(block);
      }
    }
  }
  bool done() const { return block_ == source_.mesh.blocks.size(); }

 private:
  void add(const ElementBlock& block) {
    const Corners corners = corners_of(block, element_, source_.coordinates);
    const auto nodes = block.nodes(element_).size();
    const double volume = element_measure(block.kind, std::span(corners).first(nodes));
    if (!(volume > 0)) return;
    const double wanted = spacing_ > 0 ? std::floor(edge_of(block.kind, volume) / spacing_ + 0.51) : 0.0;
    const int cells = static_cast<int>(std::clamp(wanted, double{fewest}, double{most}));
    const PointTable& points_of_kind = tables_.of(block.kind, cells);
    const std::vector<TabulatedPoint>& table = points_of_kind.points();
    volumes_.resize(table.size());
    points_of_kind.volumes(corners, volumes_);
    sought += static_cast<std::int64_t>(table.size());
    Sample sample;
    sample.source_element = block.ids[static_cast<std::size_t>(element_)];
    sample.source_item = item_;
    sample.source_owner = source_.mesh.comm.rank();
    sample.kind = static_cast<std::uint8_t>(block.kind);
    sample.cells = static_cast<std::uint8_t>(cells);
    for (std::size_t q = 0; q < table.size(); ++q) {
      const Vec3 x = position(table[q], static_cast<int>(nodes), corners);
      if (!box_.contains(x)) continue;
      sample.weight = volumes_[q];
      if (!(sample.weight > 0)) continue;
      sample.point = static_cast<std::uint16_t>(q);
      points.push_back(x);
      samples.push_back(sample);
    }
  }

  const Side& source_;
  Box box_;
  double spacing_;
  SampleTables& tables_;
  std::vector<double> volumes_;
  std::size_t block_ = 0;
  LocalIndex element_ = 0, item_ = 0;
};

/// Finds points in the target's elements. Those outside come back as such, or with no element.
class Finder {
 public:
  /// Collective.
  Finder(const Communicator& comm, const Containers& containers, const PlaceRules& rules, const std::string& name)
      : comm_(comm), containers_(containers), rules_(rules), name_(name) {
    if (comm.size() > 1) return;
    tree_.build(containers.set.boxes);
    // Which solid is the nearest is of no interest; a surface is never hit quite.
    double size = 0;
    for (const Box& box : containers.set.boxes) size = std::max(size, box.diagonal());
    reach_ = containers.surfaces ? greatest_gap() : rules.tolerance * size;
  }

  /// Points that are best sought at a time: a rendezvous has its price, a rank alone stays within its caches.
  std::size_t batch() const {
    return comm_.size() == 1 ? small_batch : std::max(large_batch, 4 * containers_.set.size());
  }
  /// Collective.
  std::span<const Placement> find(std::span<const Vec3> points) {
    if (comm_.size() > 1) {
      places_ = Locator(comm_, rules_, false, name_).find(containers_, points);
    } else {
      places_.assign(points.size(), Placement{});
      place_many(containers_.set, tree_, points, reach_, rules_, places_);
    }
    return places_;
  }
  bool holds(const Placement& place) const {
    return place.found() && (!place.is_outside() || (containers_.surfaces && place.distance <= greatest_gap()));
  }

 private:
  /// Between two meshes of one curved surface, m.
  double greatest_gap() const { return containers_.mean_size / 3; }

  const Communicator& comm_;
  const Containers& containers_;
  PlaceRules rules_;
  std::string name_;
  BoxTree tree_;
  double reach_ = 0;
  std::vector<Placement> places_;
};

/// Completes the samples that lie in a target element and appends them, with the owner of each element.
void take_places(const Finder& finder, std::span<const Sample> samples, std::span<const Placement> places,
                 std::vector<Sample>& kept, std::vector<int>& owners) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Placement& place = places[i];
    if (!finder.holds(place)) continue;
    kept.push_back(samples[i]);
    Sample& sample = kept.back();
    sample.target_item = place.item;
    shape_weights(place, std::span(sample.target_value).first(place.nodes()));
    owners.push_back(place.owner);
  }
}

/// Samples into rows of the local elements; those of one element by source element.
void sort_into(std::size_t elements, std::span<const Sample> arrived, TargetSamples& result) {
  result.begin.assign(elements + 1, 0);
  for (const Sample& s : arrived) ++result.begin[static_cast<std::size_t>(s.target_item) + 1];
  std::partial_sum(result.begin.begin(), result.begin.end(), result.begin.begin());
  result.samples.resize(arrived.size());
  std::vector<std::size_t> next(result.begin.begin(), result.begin.end() - 1);
  for (const Sample& s : arrived) result.samples[next[static_cast<std::size_t>(s.target_item)]++] = s;
  const auto before = [](const Sample& a, const Sample& b) { return a.source_element < b.source_element; };
  for (std::size_t t = 0; t < elements; ++t) {
    const auto first = result.samples.begin() + static_cast<std::ptrdiff_t>(result.begin[t]);
    const auto last = result.samples.begin() + static_cast<std::ptrdiff_t>(result.begin[t + 1]);
    // Those of one rank come in order; only several ranks need sorting.
    if (!std::is_sorted(first, last, before)) std::stable_sort(first, last, before);
  }
}

/// Collective. The samples in ghost elements, from their owners.
std::vector<Sample> ghost_samples(const Side& target, const TargetSamples& owned, const std::string& name) {
  struct Request {
    GlobalId id;
    LocalIndex there;
  };
  const int rank = target.mesh.comm.rank();
  std::vector<Request> requests;
  std::vector<int> owners;
  std::vector<GlobalId> ids;
  for_each_element(target.mesh, [&](LocalIndex item, const ElementBlock& block, LocalIndex e) {
    const auto i = static_cast<std::size_t>(e);
    ids.push_back(block.ids[i]);
    if (block.owners[i] == rank) return;
    requests.push_back({block.ids[i], item});
    owners.push_back(block.owners[i]);
  });
  const ExchangePlan ask = ExchangePlan::to_ranks(target.mesh.comm, owners, name);
  std::vector<Request> asked(static_cast<std::size_t>(ask.received()));
  ask.forward(std::span<const Request>(requests), std::span<Request>(asked));
  const std::vector<int> asking = ask.received_from();
  std::vector<Sample> sent;
  std::vector<int> to;
  for (std::size_t k = 0; k < asked.size(); ++k) {
    const auto item = static_cast<LocalIndex>(std::lower_bound(ids.begin(), ids.end(), asked[k].id) - ids.begin());
    for (Sample sample : owned.in(item)) {
      sample.target_item = asked[k].there;
      sent.push_back(sample);
      to.push_back(asking[k]);
    }
  }
  const ExchangePlan answer = ExchangePlan::to_ranks(target.mesh.comm, to, name);
  std::vector<Sample> arrived(static_cast<std::size_t>(answer.received()));
  answer.forward(std::span<const Sample>(sent), std::span<Sample>(arrived));
  return arrived;
}

}  // namespace

const SampleTables::Table& SampleTables::table(ElementKind kind, int cells) {
  auto& tables = tables_[static_cast<std::size_t>(kind)];
  const auto n = static_cast<std::size_t>(cells);
  if (tables.size() <= n) tables.resize(n + 1);
  Table& table = tables[n];
  if (!table.values.empty()) return table;
  table.points = PointTable(kind, subdivision_points(kind, cells));
  const auto width =
      static_cast<std::size_t>(topology(kind).nodes <= max_linear_nodes ? max_linear_nodes : max_element_nodes);
  for (const TabulatedPoint& point : table.points.points())
    table.values.insert(table.values.end(), point.value.begin(),
                        point.value.begin() + static_cast<std::ptrdiff_t>(width));
  return table;
}

TargetSamples samples_in_target(const Side& source, const Side& target, const PlaceRules& rules, double per_edge,
                                SampleTables& tables, const std::string& name) {
  const Communicator& comm = target.mesh.comm;
  const double spacing = mean_edge(target.mesh, target.coordinates) / per_edge;
  TargetSamples result;
  std::vector<Sample> arrived;
  {
    const Containers containers = containers_of(target.mesh, target.coordinates, {}, rules.tolerance, name);
    Box box = box_of(comm, containers);
    if (containers.surfaces) box.inflate(containers.mean_size / 3);  // the greatest gap that is bridged
    Candidates candidates(source, box, spacing, tables);
    std::vector<Sample> samples;
    std::vector<int> owners;
    Finder finder(comm, containers, rules, name + ".locate");
    while (comm.any(!candidates.done())) {
      candidates.next(finder.batch());
      take_places(finder, candidates.samples, finder.find(candidates.points), samples, owners);
    }
    result.points = comm.sum(candidates.sought);
    result.outside = result.points - comm.sum(static_cast<std::int64_t>(samples.size()));
    if (comm.size() == 1) {
      arrived = std::move(samples);
    } else {
      const ExchangePlan plan = ExchangePlan::to_ranks(comm, owners, name + ".samples");
      arrived.resize(static_cast<std::size_t>(plan.received()));
      plan.forward(std::span<const Sample>(samples), std::span<Sample>(arrived));
    }
  }
  const auto elements = static_cast<std::size_t>(target.mesh.elements());
  sort_into(elements, arrived, result);
  if (comm.size() == 1) return result;
  const std::vector<Sample> ghosts = ghost_samples(target, result, name + ".ghosts");
  arrived.insert(arrived.end(), ghosts.begin(), ghosts.end());
  sort_into(elements, arrived, result);
  return result;
}

}  // namespace tenon::transfer

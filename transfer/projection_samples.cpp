// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/projection_samples.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tenon::transfer {

namespace {

constexpr int fewest = 2, most = 6;  // sub-cells along an edge

double edge_of(ElementKind kind, double measure) {
  return topology(kind).dimension == 3 ? std::cbrt(measure) : std::sqrt(measure);
}

/// Collective. Mean edge of the elements, m.
double mean_edge(const Side& side) {
  ExactSum edges;
  for_each_element(side.mesh, [&](LocalIndex, const ElementBlock& block, LocalIndex e) {
    if (block.owners[static_cast<std::size_t>(e)] != side.mesh.comm.rank()) return;
    const Corners corners = corners_of(block, e, side.coordinates);
    edges.add(edge_of(block.kind,
                      std::max(0.0, element_measure(block.kind, std::span(corners).first(block.nodes(e).size())))));
  });
  const double total = side.mesh.comm.sum(edges);
  return side.mesh.global_elements > 0 ? total / static_cast<double>(side.mesh.global_elements) : 0.0;
}

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

/// Points of the owned source elements that lie in the box, with what is known of them here.
struct Candidates {
  std::vector<Vec3> points;
  std::vector<Sample> samples;
  GlobalId sought = 0;
};

Candidates candidates_in(const Side& source, const Box& box, double spacing, SampleTables& tables) {
  Candidates result;
  const int rank = source.mesh.comm.rank();
  for_each_element(source.mesh, [&](LocalIndex item, const ElementBlock& block, LocalIndex e) {
    if (block.owners[static_cast<std::size_t>(e)] != rank) return;
    const Corners corners = corners_of(block, e, source.coordinates);
    const int nodes = static_cast<int>(block.nodes(e).size());
    const double volume = element_measure(block.kind, std::span(corners).first(block.nodes(e).size()));
    if (!(volume > 0)) return;
    // The 0.01 keeps equal meshes equal in spite of round-off.
    const double wanted = spacing > 0 ? std::ceil(edge_of(block.kind, volume) / spacing - 0.01) : 0.0;
    const int cells = static_cast<int>(std::clamp(wanted, double{fewest}, double{most}));
    const std::vector<TabulatedPoint>& table = tables.of(block.kind, cells);
    for (std::size_t q = 0; q < table.size(); ++q) {
      const double weight = table[q].weight * std::max(0.0, measure(table[q], block.kind, corners));
      const Vec3 x = position(table[q], nodes, corners);
      ++result.sought;
      if (!(weight > 0) || !box.contains(x)) continue;
      Sample sample;
      sample.weight = weight;
      sample.source_element = block.ids[static_cast<std::size_t>(e)];
      sample.source_item = item;
      sample.source_owner = rank;
      sample.point = static_cast<std::uint16_t>(q);
      sample.kind = static_cast<std::uint8_t>(block.kind);
      sample.cells = static_cast<std::uint8_t>(cells);
      result.points.push_back(x);
      result.samples.push_back(sample);
    }
  });
  return result;
}

/// Completes the samples that lie in a target element and drops the others; the owner of each element.
std::vector<int> take_places(std::vector<Sample>& samples, std::span<const Placement> places) {
  std::vector<int> owners;
  owners.reserve(samples.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Placement& place = places[i];
    if (place.is_outside() || !place.found()) continue;
    Sample& sample = samples[kept++];
    sample = samples[i];
    sample.target_item = place.item;
    shape_weights(place, std::span(sample.target_value).first(place.nodes()));
    owners.push_back(place.owner);
  }
  samples.resize(kept);
  return owners;
}

/// Samples into rows of the local elements; those of one element by source element.
void sort_into(std::size_t elements, std::vector<Sample>&& arrived, TargetSamples& result) {
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

const std::vector<TabulatedPoint>& SampleTables::of(ElementKind kind, int cells) {
  auto& tables = tables_[static_cast<std::size_t>(kind)];
  const auto n = static_cast<std::size_t>(cells);
  if (tables.size() <= n) tables.resize(n + 1);
  if (tables[n].empty()) tables[n] = subdivision_points(kind, cells);
  return tables[n];
}

TargetSamples samples_in_target(const Side& source, const Side& target, const PlaceRules& rules, double per_edge,
                                SampleTables& tables, const std::string& name) {
  const Communicator& comm = target.mesh.comm;
  const double spacing = mean_edge(target) / per_edge;
  TargetSamples result;
  std::vector<Sample> arrived;
  {
    const Containers containers = containers_of(target.mesh, target.coordinates, {}, rules.tolerance, name);
    Candidates candidates = candidates_in(source, box_of(comm, containers), spacing, tables);
    const std::vector<Placement> places =
        Locator(comm, rules, false, name + ".locate").find(containers, candidates.points);
    std::vector<Sample> samples = std::move(candidates.samples);
    const std::vector<int> owners = take_places(samples, places);
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
  sort_into(elements, std::vector<Sample>(arrived), result);
  if (comm.size() == 1) return result;
  const std::vector<Sample> ghosts = ghost_samples(target, result, name + ".ghosts");
  arrived.insert(arrived.end(), ghosts.begin(), ghosts.end());
  sort_into(elements, std::move(arrived), result);
  return result;
}

}  // namespace tenon::transfer

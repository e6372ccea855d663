// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/locate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "transfer/place_many.hpp"
#include "transfer/slot_table.hpp"

namespace tenon::transfer {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
/// How far elements and points may move before a rendezvous made for motion is made anew, in mean element sizes.
constexpr double skin_of_size = 1;

/// What travels of an element besides its corners and its box.
struct ElementHead {
  GlobalId id;
  LocalIndex item, at_owner;
  std::int32_t owner;
  ElementKind kind;
};

Box global_box(const Communicator& comm, const Box& mine) {
  std::array<double, 6> ends{-mine.low[0], -mine.low[1], -mine.low[2], mine.high[0], mine.high[1], mine.high[2]};
  comm.max(std::span<double>(ends));
  Box box;
  box.low = {-ends[0], -ends[1], -ends[2]};
  box.high = {ends[3], ends[4], ends[5]};
  return box;
}

/// The reach of the next rendezvous: twice the last, but at least what the nearest of the points needs to come to the
/// source's box at all.
double next_reach(const Communicator& comm, const Box& source, std::span<const Vec3> points, double reach) {
  double nearest = infinite;
  for (const Vec3& p : points) nearest = std::min(nearest, source.distance(p));
  return std::max(2 * reach, comm.min(nearest) + reach);
}

/// Corners of the elements that are sent, in order.
std::vector<Vec3> corners_of_sent(const ElementSet& set, std::span<const LocalIndex> sent) {
  std::vector<Vec3> corners;
  corners.reserve(sent.size() * set.stride);
  for (const LocalIndex e : sent) {
    const LocalIndex* const nodes = set.nodes_of(e);
    for (std::size_t a = 0; a < set.stride; ++a) corners.push_back(set.x[static_cast<std::size_t>(nodes[a])]);
  }
  return corners;
}

/// Brings places of corners to elements that have arrived before.
void bring_corners(const DistributedSearch& search, const ElementSet& set, ElementSet& arrived) {
  const std::vector<Vec3> sent = corners_of_sent(set, search.box_of_send());
  arrived.x.resize(arrived.size() * set.stride + 1);
  if (set.stride > 0)
    search.boxes().forward(std::span<const Vec3>(sent), std::span<Vec3>(arrived.x), static_cast<int>(set.stride));
}

/// Collective. All of the elements that come to the rendezvous.
ElementSet arrived_elements(const DistributedSearch& search, const ElementSet& set) {
  const std::span<const LocalIndex> sent = search.box_of_send();
  std::vector<ElementHead> heads;
  heads.reserve(sent.size());
  for (const LocalIndex e : sent)
    heads.push_back({set.id(e), set.items[static_cast<std::size_t>(e)], e, set.rank, set.kind(e)});
  std::vector<ElementHead> came(static_cast<std::size_t>(search.boxes().received()));
  search.boxes().forward(std::span<const ElementHead>(heads), std::span<ElementHead>(came));
  ElementSet arrived;
  arrived.rank = set.rank;
  arrived.stride = set.stride;
  const bool uniform = set.kinds.size() == 1 && std::all_of(came.begin(), came.end(), [&](const ElementHead& head) {
                         return head.kind == set.kinds.front();
                       });
  if (uniform) arrived.kinds = set.kinds;
  for (const ElementHead& head : came) {
    arrived.ids.push_back(head.id);
    arrived.items.push_back(head.item);
    arrived.index.push_back(head.at_owner);
    arrived.owners.push_back(head.owner);
    if (!uniform) arrived.kinds.push_back(head.kind);
  }
  arrived.nodes.resize(came.size() * set.stride);
  std::iota(arrived.nodes.begin(), arrived.nodes.end(), LocalIndex{0});
  bring_corners(search, set, arrived);
  arrived.boxes.assign(search.arrived_boxes().begin(), search.arrived_boxes().end());
  return arrived;
}

/// The elements near a box.
ElementSet elements_near(const ElementSet& set, const Box& around) {
  ElementSet near = set;
  for (Box& box : near.boxes)
    if (!box.overlaps(around)) box = Box{};
  return near;
}

}  // namespace

void Locator::forget() {
  search_.reset();
  arrived_ = {};
  tree_ = {};
  held_ = {};
  here_ = {};
}

void Locator::build(const Containers& containers, std::span<const Vec3> points) {
  // A third of the diagonal is about half the width of an element: the gaps between meshes of the same curved body.
  reach_ = containers.mean_size / 3;
  skin_ = moving_ ? skin_of_size * containers.mean_size : 0;
  decomposed_ = true;
  absent_.clear();
  if (moving_)
    for (const Box& box : containers.set.boxes) absent_.push_back(box.empty());
  if (comm_.size() == 1) {
    tree_.build(containers.set.boxes);
    return;
  }
  search_ = std::make_unique<DistributedSearch>(
      comm_, rcb_, containers.set.boxes, points, reach_ + skin_, name_,
      work_.size() == points.size() ? std::span<const float>(work_) : std::span<const float>{});
  arrived_ = arrived_elements(*search_, containers.set);
  tree_ = search_->take_tree();
}

void Locator::search(const Containers& containers, std::span<const Vec3> points, bool again) {
  const ElementSet& set = elements(containers);
  const bool alone = comm_.size() == 1;
  const std::span<const Vec3> here = alone ? points : search_->arrived_points();
  std::vector<Placement>& places = alone ? places_ : here_;
  places.resize(here.size());
  if (!again) {
    place_many(set, tree_, here, reach_, rules_, places);
    searched_ = static_cast<std::int64_t>(here.size());
    if (moving_) held_.resize(places.size());
  } else if (place_again(set, here, held_, places)) {
    tree_.refit(set.boxes);
    searched_ = std::count(held_.begin(), held_.end(), no_index);
    place_rest(set, tree_, here, held_, reach_, rules_, places);
  } else {
    searched_ = 0;
  }
  if (moving_ && searched_ > 0)
    for (std::size_t i = 0; i < places.size(); ++i) held_[i] = places[i].here;
  if (alone) return;
  places_.resize(points.size());
  search_->points().reverse(std::span<const Placement>(places), std::span<Placement>(places_));
}

void Locator::look_farther(const Containers& containers, std::span<const Vec3> points) {
  const auto lost = [&] {
    return std::any_of(places_.begin(), places_.end(), [](const Placement& place) { return !place.found(); });
  };
  if (!comm_.any(lost())) return;
  Box mine;
  for (const Box& box : containers.set.boxes)
    if (!box.empty()) mine.add(box);
  const Box source = global_box(comm_, mine);
  double reach = reach_;
  while (comm_.any(lost())) {
    std::vector<std::size_t> missing;
    std::vector<Vec3> missing_points;
    Box around;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (places_[i].found()) continue;
      missing.push_back(i);
      missing_points.push_back(points[i]);
      around.add(points[i]);
    }
    reach = next_reach(comm_, source, missing_points, reach);
    around = global_box(comm_, around);
    Box everything = source;
    everything.add(around);
    if (!(reach <= 8 * everything.diagonal()) || !std::isfinite(reach))  // the same on every rank
      throw Error(ExitCode::geometry, fmt::format("transfer '{}': no element of the mesh has a finite distance to the "
                                                  "points near ({:.6g}, {:.6g}, {:.6g}); check its coordinates",
                                                  name_, around.low[0], around.low[1], around.low[2]));
    around.inflate(reach);
    std::vector<Placement> found(missing.size());
    if (comm_.size() == 1) {
      place_many(containers.set, tree_, missing_points, reach, rules_, found);
    } else {
      const ElementSet near = elements_near(containers.set, around);
      const DistributedSearch meeting(comm_, near.boxes, missing_points, reach, name_);
      const ElementSet came = arrived_elements(meeting, near);
      std::vector<Placement> here(meeting.arrived_points().size());
      place_many(came, meeting.tree(), meeting.arrived_points(), reach, rules_, here);
      meeting.points().reverse(std::span<const Placement>(here), std::span<Placement>(found));
    }
    for (std::size_t k = 0; k < missing.size(); ++k) places_[missing[k]] = found[k];
  }
}

const std::vector<Placement>& Locator::find(const Containers& containers, std::span<const Vec3> points) & {
  searched_ = 0;
  places_.clear();
  if (comm_.sum(static_cast<std::int64_t>(points.size())) == 0) return places_;
  if (containers.count == 0)
    throw Error(ExitCode::geometry,
                fmt::format("transfer '{}': the mesh that should hold the points has no element with volume", name_));
  build(containers, points);
  search(containers, points, false);
  look_farther(containers, points);
  if (!moving_) {
    forget();
    return places_;
  }
  work_.resize(places_.size());
  for (std::size_t i = 0; i < places_.size(); ++i) work_[i] = static_cast<float>(1 + places_[i].work);
  return places_;
}

/// Whether an element has gained volume that had none when the rendezvous was made.
bool Locator::newcomers(const Containers& containers) const {
  for (std::size_t e = 0; e < absent_.size(); ++e)
    if (absent_[e] && !containers.set.boxes[e].empty()) return true;
  return false;
}

const std::vector<Placement>& Locator::find_again(const Containers& containers, std::span<const Vec3> points,
                                                  double moved) {
  const bool known = comm_.size() == 1 ? held_.size() == points.size() : search_ != nullptr;
  // An element meets its points as long as both together have moved by less than the skin.
  if (comm_.any(!known) || 2 * moved > skin_ || comm_.any(newcomers(containers))) return find(containers, points);
  if (containers.count == 0) return find(containers, points);  // which refuses
  decomposed_ = false;
  if (comm_.size() > 1) {
    bring_corners(*search_, containers.set, arrived_);
    search_->move_points(points);
    std::vector<Box> sent;
    for (const LocalIndex e : search_->box_of_send()) sent.push_back(containers.set.boxes[static_cast<std::size_t>(e)]);
    search_->boxes().forward(std::span<const Box>(sent), std::span<Box>(arrived_.boxes));
  }
  search(containers, points, true);
  look_farther(containers, points);
  return places_;
}

std::int64_t Locator::memory() const {
  const auto bytes = [](const auto& v) { return static_cast<std::int64_t>(v.capacity() * sizeof(v[0])); };
  return bytes(arrived_.x) + bytes(arrived_.nodes) + bytes(arrived_.ids) + bytes(arrived_.items) +
         bytes(arrived_.index) + bytes(arrived_.owners) + bytes(arrived_.boxes) + bytes(held_) + bytes(work_) +
         bytes(places_) + bytes(here_) + tree_.memory();
}

/// `nodes_of(e)`: the local nodes of an element that this rank owns.
template <typename NodesOf>
void PlacedNodes::fetch(const Communicator& comm, const Items& nodes, const SlotTable& wanted, const std::string& name,
                        NodesOf nodes_of) {
  const std::size_t count = wanted.owners().size();
  const auto fill = [&](LocalIndex e, std::size_t row, std::vector<GlobalId>& id, std::vector<int>& owner,
                        std::vector<LocalIndex>& at_owner, std::vector<std::int8_t>& number) {
    const std::span<const LocalIndex> of_element = nodes_of(e);
    for (std::size_t a = 0; a < of_element.size(); ++a) {
      const auto n = static_cast<std::size_t>(of_element[a]);
      const std::size_t to = row * stride_ + a;
      id[to] = nodes.ids[n], owner[to] = nodes.owners[n], at_owner[to] = nodes.at_owner[n];
    }
    number[row] = static_cast<std::int8_t>(of_element.size());
  };
  id_.resize(count * stride_), owner_.resize(count * stride_), at_owner_.resize(count * stride_), count_.resize(count);
  if (comm.size() == 1) {
    for (std::size_t i = 0; i < count; ++i) fill(wanted.indices()[i], i, id_, owner_, at_owner_, count_);
    return;
  }
  // The owners are told which of their elements are wanted, and answer for those.
  const ExchangePlan ask = ExchangePlan::to_ranks(comm, wanted.owners(), name);
  std::vector<LocalIndex> asked(static_cast<std::size_t>(ask.received()));
  ask.forward(std::span<const LocalIndex>(wanted.indices()), std::span<LocalIndex>(asked));
  std::vector<GlobalId> id(asked.size() * stride_);
  std::vector<int> owner(id.size());
  std::vector<LocalIndex> at_owner(id.size());
  std::vector<std::int8_t> number(asked.size());
  for (std::size_t i = 0; i < asked.size(); ++i) fill(asked[i], i, id, owner, at_owner, number);
  const auto item = [](const auto& from, auto& to, std::size_t each) {
    return ExchangeItem{reinterpret_cast<const std::byte*>(from.data()), reinterpret_cast<std::byte*>(to.data()),
                        each * sizeof(from[0])};
  };
  const ExchangeItem items[] = {item(id, id_, stride_), item(owner, owner_, stride_),
                                item(at_owner, at_owner_, stride_), item(number, count_, 1)};
  ask.reverse(items);
}

PlacedNodes::PlacedNodes(const Communicator& comm, const ElementSet& elements, const Items& nodes,
                         std::span<const Placement> placements, const std::string& name)
    : stride_(elements.stride) {
  SlotTable wanted;
  for (const Placement& place : placements)
    if (place.found()) wanted.mark(place.owner, place.at_owner);
  wanted.number();
  element_of_.assign(placements.size(), no_index);
  for (std::size_t i = 0; i < placements.size(); ++i)
    if (placements[i].found()) element_of_[i] = wanted.slot(placements[i].owner, placements[i].at_owner);
  fetch(comm, nodes, wanted, name,
        [&](LocalIndex e) { return std::span(elements.nodes_of(e), elements.node_count(e)); });
}

PlacedNodes::PlacedNodes(const Mesh& mesh, const Items& nodes, const SlotTable& wanted, const std::string& name) {
  std::vector<std::span<const LocalIndex>> all;
  all.reserve(static_cast<std::size_t>(mesh.elements()));
  for_each_element(mesh, [&](LocalIndex, const ElementBlock& block, LocalIndex e) { all.push_back(block.nodes(e)); });
  for (const ElementBlock& block : mesh.blocks)
    stride_ = std::max(stride_, static_cast<std::size_t>(topology(block.kind).nodes));
  fetch(mesh.comm, nodes, wanted, name, [&](LocalIndex e) { return all[static_cast<std::size_t>(e)]; });
}

}  // namespace tenon::transfer

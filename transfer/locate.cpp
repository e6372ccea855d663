// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/locate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "framework/search/distributed_search.hpp"
#include "transfer/place_many.hpp"
#include "transfer/slot_table.hpp"

namespace tenon::transfer {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// One rendezvous: placements of the points; those with nothing within reach come back without an element.
std::vector<Placement> rendezvous(const Communicator& comm, std::span<const ElementPacket> elements,
                                  std::span<const Box> boxes, std::span<const Vec3> points, double reach,
                                  const PlaceRules& rules, const std::string& name) {
  if (comm.size() == 1) {  // nothing to bring together
    std::vector<Placement> places(points.size());
    place_many(elements, boxes, BoxTree(boxes), points, reach, rules, places);
    return places;
  }
  const DistributedSearch search(comm, boxes, points, reach, name);
  std::vector<ElementPacket> arrived(static_cast<std::size_t>(search.boxes().received()));
  {
    std::vector<ElementPacket> sent;
    sent.reserve(search.box_of_send().size());
    for (const LocalIndex i : search.box_of_send()) sent.push_back(elements[static_cast<std::size_t>(i)]);
    search.boxes().forward(std::span<const ElementPacket>(sent), std::span<ElementPacket>(arrived));
  }
  const std::span<const Vec3> here = search.arrived_points();
  std::vector<Placement> places(here.size());
  place_many(arrived, search.arrived_boxes(), search.tree(), here, reach, rules, places);
  std::vector<Placement> result(points.size());
  search.points().reverse(std::span<const Placement>(places), std::span<Placement>(result));
  return result;
}

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

}  // namespace

std::vector<Placement> locate(const Communicator& comm, const Containers& containers, std::span<const Vec3> points,
                              const PlaceRules& rules, const std::string& name) {
  const auto count = [&](std::size_t n) { return comm.sum(static_cast<std::int64_t>(n)); };
  if (count(points.size()) == 0) return {};
  if (count(containers.elements.size()) == 0)
    throw Error(ExitCode::geometry,
                fmt::format("transfer '{}': the mesh that should hold the points has no element with volume", name));
  // A third of the diagonal is about half the width of an element: the gaps between meshes of the same curved body.
  double reach = containers.mean_size / 3;
  std::vector<Placement> places = rendezvous(comm, containers.elements, containers.boxes, points, reach, rules, name);
  Box mine;
  for (const Box& box : containers.boxes) mine.add(box);
  const Box source = global_box(comm, mine);
  while (true) {
    std::vector<std::size_t> missing;
    std::vector<Vec3> missing_points;
    Box around;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i].element != no_id) continue;
      missing.push_back(i);
      missing_points.push_back(points[i]);
      around.add(points[i]);
    }
    if (count(missing.size()) == 0) return places;
    reach = next_reach(comm, source, missing_points, reach);
    around = global_box(comm, around);
    Box everything = source;
    everything.add(around);
    if (reach > 8 * everything.diagonal())  // the same on every rank
      throw Error(ExitCode::geometry, fmt::format("transfer '{}': no element of the mesh has a finite distance to the "
                                                  "points near ({:.6g}, {:.6g}, {:.6g}); check its coordinates",
                                                  name, around.low[0], around.low[1], around.low[2]));
    around.inflate(reach);
    std::vector<ElementPacket> near_elements;
    std::vector<Box> near_boxes;
    for (std::size_t e = 0; e < containers.boxes.size(); ++e) {
      if (!containers.boxes[e].overlaps(around)) continue;
      near_elements.push_back(containers.elements[e]);
      near_boxes.push_back(containers.boxes[e]);
    }
    const std::vector<Placement> found =
        rendezvous(comm, near_elements, near_boxes, missing_points, reach, rules, name);
    for (std::size_t k = 0; k < missing.size(); ++k) places[missing[k]] = found[k];
  }
}

PlacedNodes::PlacedNodes(const Mesh& mesh, const Items& nodes, std::span<const Placement> placements,
                         const std::string& name) {
  SlotTable wanted;
  for (const Placement& place : placements)
    if (place.element != no_id) wanted.mark(place.owner, place.item);
  wanted.number();
  element_of_.assign(placements.size(), no_index);
  for (std::size_t i = 0; i < placements.size(); ++i)
    if (placements[i].element != no_id) element_of_[i] = wanted.slot(placements[i].owner, placements[i].item);

  // Alone, a rank fills what it wants from its own mesh; otherwise all that somebody may ask for.
  const bool alone = mesh.comm.size() == 1;
  nodes_.resize(wanted.owners().size());
  std::vector<ElementNodes> mine(alone ? 0 : static_cast<std::size_t>(mesh.elements()));
  std::size_t next = 0;  // items that are wanted ascend
  for_each_element(mesh, [&](LocalIndex item, const ElementBlock& block, LocalIndex e) {
    if (alone && (next == nodes_.size() || wanted.indices()[next] != item)) return;
    ElementNodes& to = alone ? nodes_[next++] : mine[static_cast<std::size_t>(item)];
    const auto connectivity = block.nodes(e);
    for (std::size_t a = 0; a < connectivity.size(); ++a) {
      const auto n = static_cast<std::size_t>(connectivity[a]);
      to.id[a] = nodes.ids[n], to.owner[a] = nodes.owners[n], to.at_owner[a] = nodes.at_owner[n];
    }
    to.nodes = static_cast<std::int32_t>(connectivity.size());
  });
  if (alone) return;
  std::vector<LocalIndex> into(nodes_.size());
  std::iota(into.begin(), into.end(), LocalIndex{0});
  ExchangePlan::from_owners(mesh.comm, wanted.owners(), wanted.indices(), into, name)
      .forward(std::span<const ElementNodes>(mine), std::span<ElementNodes>(nodes_));
}

}  // namespace tenon::transfer

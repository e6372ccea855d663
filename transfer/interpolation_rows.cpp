// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "transfer/element_points.hpp"
#include "transfer/rows.hpp"

namespace tenon::transfer {

std::vector<Vec3> item_points(const Side& side) {
  std::vector<Vec3> points;
  points.reserve(side.items.owned.size());
  if (side.location == Location::node) {
    for (const LocalIndex n : side.items.owned) points.push_back(side.coordinates[static_cast<std::size_t>(n)]);
    return points;
  }
  for_each_element(side.mesh, [&](LocalIndex, const ElementBlock& block, LocalIndex e) {
    if (block.owners[static_cast<std::size_t>(e)] == side.mesh.comm.rank())
      points.push_back(centre_of(block.kind, corners_of(block, e, side.coordinates)));
  });
  return points;
}

std::vector<Vec3> local_points(const Side& side) {
  if (side.location == Location::node) return {side.coordinates.begin(), side.coordinates.end()};
  std::vector<Vec3> points;
  points.reserve(side.items.ids.size());
  for_each_element(side.mesh, [&](LocalIndex, const ElementBlock& block, LocalIndex e) {
    points.push_back(centre_of(block.kind, corners_of(block, e, side.coordinates)));
  });
  return points;
}

namespace {

/// Weights below this are round-off.
constexpr double negligible = 1e-15;

/// Shape functions of a hexahedron at a place within it, of the first and of the last four nodes.
TENON_KERNEL void hexahedron_weights(const Vec3& xi, Pack& low, Pack& high) {
  const double xl = 0.5 - 0.5 * xi[0], xh = 0.5 + 0.5 * xi[0], yl = 0.5 - 0.5 * xi[1], yh = 0.5 + 0.5 * xi[1];
  const double zl = 0.5 - 0.5 * xi[2], zh = 0.5 + 0.5 * xi[2];
  const Pack in_plane = Pack{xl, xh, xh, xl} * Pack{yl, yl, yh, yh};
  low = in_plane * zl, high = in_plane * zh;
  low = low > negligible ? low : Pack{}, high = high > negligible ? high : Pack{};
}

/// Rows of points that take the values of nodes; nodes_of(i): where the nodes of the element of placement i are kept.
template <typename NodesOf>
void set_node_rows(PointRows& rows, std::span<const Placement> places, bool drop_outside, NodesOf nodes_of) {
  std::array<double, max_nodes> weights;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Placement& place = places[i];
    if (place.is_outside() && drop_outside) {
      rows.set_empty(i);
      continue;
    }
    const LocalIndex* const slots = nodes_of(i);
    const bool within = place.state == PlaceState::inside || place.state == PlaceState::outside;
    if (place.kind == ElementKind::hex8 && within && rows.width() == 8) {
      Pack low, high;
      hexahedron_weights(place.xi, low, high);
      rows.set_hexahedron(i, low, high, slots);
      continue;
    }
    const std::span<double> w = std::span(weights).first(place.nodes());
    shape_weights(place, w);
    rows.set(i, w, [&](std::size_t a) { return slots[a]; });
  }
}

template <typename SlotOf>
void set_element_rows(PointRows& rows, std::span<const Placement> places, bool drop_outside, SlotOf slot_of) {
  constexpr double one = 1;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (places[i].is_outside() && drop_outside)
      rows.set_empty(i);
    else
      rows.set(i, std::span(&one, 1), [&](std::size_t) { return slot_of(places[i]); });
}

}  // namespace

RowMap interpolation_map(const Communicator& comm, const InterpolationSource& source, std::span<const Placement> places,
                         bool drop_outside, double empty_value, PointRows&& room, const std::string& name) {
  PointRows rows = std::move(room);
  const bool nodal = source.location == Location::node;
  rows.resize(nodal ? source.width : 1, places.size());
  if (comm.size() == 1) {
    if (nodal)
      set_node_rows(rows, places, drop_outside,
                    [&](std::size_t i) { return source.elements.nodes_of(places[i].at_owner); });
    else
      set_element_rows(rows, places, drop_outside, [](const Placement& place) { return place.item; });
    return RowMap(std::move(rows), empty_value, source.local_items);
  }
  SlotTable wanted;
  if (!nodal) {
    for (const Placement& place : places) wanted.mark(place.owner, place.item);
    wanted.number();
    set_element_rows(rows, places, drop_outside,
                     [&](const Placement& place) { return wanted.slot(place.owner, place.item); });
    return RowMap(comm, std::move(rows), empty_value, wanted, name);
  }
  const PlacedNodes nodes(comm, source.elements, source.nodes, places, name + ".nodes");
  const auto for_each_node = [&](auto&& visit) {
    for (std::size_t e = 0; e < nodes.elements(); ++e) {
      const PlacedNodes::Nodes at = nodes.element(e);
      for (std::size_t a = 0; a < at.count; ++a) visit(e, a, at);
    }
  };
  for_each_node(
      [&](std::size_t, std::size_t a, const PlacedNodes::Nodes& at) { wanted.mark(at.owner[a], at.at_owner[a]); });
  wanted.number();
  const std::size_t stride = nodes.stride();
  std::vector<LocalIndex> slots(nodes.elements() * stride, 0);
  for_each_node([&](std::size_t e, std::size_t a, const PlacedNodes::Nodes& at) {
    slots[e * stride + a] = wanted.slot(at.owner[a], at.at_owner[a]);
  });
  set_node_rows(rows, places, drop_outside, [&](std::size_t i) { return slots.data() + nodes.element_of(i) * stride; });
  return RowMap(comm, std::move(rows), empty_value, wanted, name);
}

RowMap interpolation_map(const Side& source, const Side& target, const PlaceRules& rules, bool drop_outside,
                         double empty_value, const std::string& name, Sought& sought) {
  const Communicator& comm = target.mesh.comm;
  const Containers containers = containers_of(source.mesh, source.coordinates, {}, rules.tolerance, name);
  sought.skipped = containers.skipped;
  sought.points = local_points(target);
  sought.places = Locator(comm, rules, false, name + ".locate").find(containers, sought.points);
  RowMap map = interpolation_map(
      comm, {containers.set, source.nodes, source.location, containers.set.stride, source.items.ids.size()},
      sought.places, drop_outside, empty_value, {}, name);
  const std::span<const LocalIndex> owned = target.items.owned;
  for (std::size_t k = 0; k < owned.size(); ++k) {
    const auto i = static_cast<std::size_t>(owned[k]);
    sought.ids.push_back(target.items.ids[i]);
    sought.points[k] = sought.points[i], sought.places[k] = sought.places[i];
  }
  sought.points.resize(owned.size()), sought.places.resize(owned.size());
  return map;
}

}  // namespace tenon::transfer

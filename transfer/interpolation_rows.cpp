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

namespace {

/// Local items that another rank owns know by themselves where they are: no row needs to travel.
std::vector<Vec3> local_points(const Side& side) {
  if (side.location == Location::node) return {side.coordinates.begin(), side.coordinates.end()};
  std::vector<Vec3> points;
  points.reserve(side.items.ids.size());
  for_each_element(side.mesh, [&](LocalIndex, const ElementBlock& block, LocalIndex e) {
    points.push_back(centre_of(block.kind, corners_of(block, e, side.coordinates)));
  });
  return points;
}

int greatest_width(const Side& source) {
  int width = 1;
  for (const ElementBlock& block : source.mesh.blocks)
    if (source.location == Location::node) width = std::max(width, topology(block.kind).nodes);
  return width;
}

/// Keeps the owned items of what was sought.
void keep_owned(const Side& target, Sought& sought) {
  const std::vector<LocalIndex>& owned = target.items.owned;
  for (const LocalIndex i : owned) sought.ids.push_back(target.items.ids[static_cast<std::size_t>(i)]);
  if (owned.size() == sought.points.size()) return;
  for (std::size_t k = 0; k < owned.size(); ++k) {
    const auto i = static_cast<std::size_t>(owned[k]);
    sought.points[k] = sought.points[i], sought.places[k] = sought.places[i];
  }
  sought.points.resize(owned.size()), sought.places.resize(owned.size());
}

}  // namespace

RowMap interpolation_map(const Side& source, const Side& target, const PlaceRules& rules, bool drop_outside,
                         double empty_value, const std::string& name, Sought& sought) {
  const Communicator& comm = target.mesh.comm;
  {
    const Containers containers = containers_of(source.mesh, source.coordinates, rules.tolerance, name);
    sought.skipped = containers.skipped;
    sought.points = local_points(target);
    sought.places = locate(comm, containers, sought.points, rules, name + ".locate");
  }
  PointRows rows(greatest_width(source), sought.places.size());
  if (source.location == Location::node) {
    const PlacedNodes nodes(source.mesh, source.nodes, sought.places, name + ".nodes");
    rows.take_items(nodes.elements(), [&](std::size_t e, SlotTable& table) {
      const ElementNodes& at = nodes.element(e);
      for (std::size_t a = 0; a < at.count(); ++a) table.mark(at.owner[a], at.at_owner[a]);
    });
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Placement& place = sought.places[i];
      if (place.outside && drop_outside) continue;
      const ElementNodes& at = nodes.of(i);
      rows.set(i, std::span(place.weights).first(static_cast<std::size_t>(topology(place.kind).nodes)),
               [&](std::size_t a) { return rows.slot(at.owner[a], at.at_owner[a]); });
    }
  } else {
    rows.take_items(rows.size(), [&](std::size_t i, SlotTable& table) {
      if (sought.places[i].element != no_id) table.mark(sought.places[i].owner, sought.places[i].item);
    });
    constexpr double one = 1;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Placement& place = sought.places[i];
      if (place.outside && drop_outside) continue;
      rows.set(i, std::span(&one, 1), [&](std::size_t) { return rows.slot(place.owner, place.item); });
    }
  }
  keep_owned(target, sought);
  return RowMap(comm, std::move(rows), empty_value, name);
}

}  // namespace tenon::transfer

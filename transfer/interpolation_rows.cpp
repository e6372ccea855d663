// SPDX-License-Identifier: BSD-3-Clause
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

Rows interpolation_rows(const Side& source, const Side& target, const PlaceRules& rules, bool drop_outside,
                        const std::string& name, Sought& sought) {
  const Communicator& comm = target.mesh.comm;
  const Containers containers = containers_of(source.mesh, source.coordinates, rules.tolerance, name);
  sought.skipped = containers.skipped;
  sought.points = item_points(target);
  for (const LocalIndex i : target.items.owned) sought.ids.push_back(target.items.ids[static_cast<std::size_t>(i)]);
  sought.places = locate(comm, containers, sought.points, rules, name + ".locate");

  Rows rows;
  rows.begin.reserve(sought.places.size() + 1);
  const bool by_node = source.location == Location::node;
  const PlacedNodes nodes(source.mesh, source.nodes,
                          by_node ? std::span<const Placement>(sought.places) : std::span<const Placement>{},
                          name + ".nodes");
  for (std::size_t i = 0; i < sought.places.size(); ++i) {
    const Placement& place = sought.places[i];
    if (!(place.outside && drop_outside)) {
      if (by_node) {
        const ElementNodes& at = nodes.of(i);
        const auto first = static_cast<std::ptrdiff_t>(rows.terms.size());
        for (std::size_t a = 0; a < static_cast<std::size_t>(topology(place.kind).nodes); ++a)
          if (place.weights[a] != 0) rows.terms.push_back({at.id[a], place.weights[a], at.owner[a], at.at_owner[a]});
        sort_by_source(std::span(rows.terms).subspan(static_cast<std::size_t>(first)));
      } else {
        rows.terms.push_back({place.element, 1.0, place.owner, place.item});
      }
    }
    rows.begin.push_back(static_cast<std::int64_t>(rows.terms.size()));
  }
  return rows;
}

}  // namespace tenon::transfer

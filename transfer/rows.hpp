// SPDX-License-Identifier: BSD-3-Clause
// How the rows of a map come about: by interpolation at target points, or by spreading source amounts.
#pragma once

#include <span>
#include <string>

#include "transfer/locate.hpp"
#include "transfer/row_map.hpp"

namespace tenon::transfer {

/// A mesh with where it stands and its items, as both methods need it.
struct Side {
  const Mesh& mesh;
  std::span<const Vec3> coordinates;
  Location location;
  const Items& nodes;  ///< of the mesh
  const Items& items;  ///< of `location`
};

/// Points that were sought, and what became of them; each once over all ranks.
struct Sought {
  std::vector<Vec3> points;
  std::vector<GlobalId> ids;  ///< of the item that each belongs to, for naming and ties
  std::vector<Placement> places;
  GlobalId skipped = 0;  ///< elements without volume, over all ranks
};

/// Places of the owned items: nodes, or centres of elements.
std::vector<Vec3> item_points(const Side& side);

/// Collective. The map that gives every local target item, ghosts too, the shape functions of the source element that
/// holds it. With `drop_outside`, items outside have no terms and receive `empty_value`. `sought` has the owned items.
RowMap interpolation_map(const Side& source, const Side& target, const PlaceRules& rules, bool drop_outside,
                         double empty_value, const std::string& name, Sought& sought);

/// Collective. Terms of each owned target item from all source items that have points near it. Sums over the columns
/// are 1 (totals); with `density`, weights are multiplied by the source item's volume and divided by the target's.
Rows conservation_rows(const Side& source, const Side& target, const PlaceRules& rules, bool density,
                       const std::string& name, Sought& sought);

}  // namespace tenon::transfer

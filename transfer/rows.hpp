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
/// The same of all local items, ghosts too.
std::vector<Vec3> local_points(const Side& side);

/// The values that interpolation takes: of which elements, and where on them.
struct InterpolationSource {
  const ElementSet& elements;
  const Items& nodes;
  Location location = Location::node;
  std::size_t width = 1;        ///< most nodes of an element, the same on every rank
  std::size_t local_items = 0;  ///< of `location` on this rank
};

/// Collective. The map that gives each of some points (all local target items, ghosts too, which know by themselves
/// where they are) the shape functions of the source element that holds it, or that element's value. With
/// `drop_outside`, points outside have no terms and receive `empty_value`. `room`: rows to be written over.
RowMap interpolation_map(const Communicator& comm, const InterpolationSource& source, std::span<const Placement> places,
                         bool drop_outside, double empty_value, PointRows&& room, const std::string& name);

/// Collective. The same of one mesh onto another, once, in one go. `sought` receives the owned items.
RowMap interpolation_map(const Side& source, const Side& target, const PlaceRules& rules, bool drop_outside,
                         double empty_value, const std::string& name, Sought& sought);

/// Collective. Terms of each owned target item from all source items that have points near it. Sums over the columns
/// are 1 (totals); with `density`, weights are multiplied by the source item's volume and divided by the target's.
Rows conservation_rows(const Side& source, const Side& target, const PlaceRules& rules, bool density,
                       const std::string& name, Sought& sought);

}  // namespace tenon::transfer

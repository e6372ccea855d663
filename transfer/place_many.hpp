// SPDX-License-Identifier: BSD-3-Clause
// Many points among many elements: neighbouring points share the search, hexahedra are inverted four at a time.
#pragma once

#include <span>

#include "transfer/place.hpp"

namespace tenon::transfer {

/// The placement of each point: that of place_inside, else of place_nearest within `reach`. `boxes` and `tree` are
/// those of the elements. Depends on nothing but the sets.
void place_many(std::span<const ElementPacket> elements, std::span<const Box> boxes, const BoxTree& tree,
                std::span<const Vec3> points, double reach, const PlaceRules& rules, std::span<Placement> places);

}  // namespace tenon::transfer

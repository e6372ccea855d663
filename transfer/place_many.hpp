// SPDX-License-Identifier: BSD-3-Clause
// Places many points in the elements of one rank.
#pragma once

#include <span>

#include "transfer/place.hpp"

namespace tenon::transfer {

/// Each point by place_inside among the elements whose boxes hold it, else by place_nearest: the same placement, bit
/// for bit, whatever the other points. Points near each other share the search, and hexahedra are inverted four at a
/// time. `tree` holds `elements.boxes`. One placement for each point.
void place_many(const ElementSet& elements, const BoxTree& tree, std::span<const Vec3> points, double reach,
                const PlaceRules& rules, std::span<Placement> places);

/// The same after motion, for points that are likely to be in the elements that `places` has them in (`held`: places in
/// `elements`; no_index: unknown). A point that is well inside that element stays there, which is where a new search
/// would find it unless elements overlap. Returns whether any point needs a search: those keep `held` no_index, and
/// place_rest must follow.
bool place_again(const ElementSet& elements, std::span<const Vec3> points, std::span<LocalIndex> held,
                 std::span<Placement> places);
/// Places those whose `held` is no_index.
void place_rest(const ElementSet& elements, const BoxTree& tree, std::span<const Vec3> points,
                std::span<const LocalIndex> held, double reach, const PlaceRules& rules, std::span<Placement> places);

}  // namespace tenon::transfer

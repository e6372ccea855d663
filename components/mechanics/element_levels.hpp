// SPDX-License-Identifier: BSD-3-Clause
// Which elements may take steps longer than the shortest, and groups for them.
#pragma once

#include <cstdint>
#include <vector>

#include "components/mechanics/element_groups.hpp"

namespace tenon {

/// An element of level k takes one step where those of level 0 take 2^k; by block and element of the mesh.
using ElementLevels = std::vector<std::vector<std::int32_t>>;

/// Elements above level 0 take no more than this share of the step that they allow alone, whatever the user takes of
/// the shortest one; see docs/decisions/0014.
inline constexpr double slow_share = 0.8;

/// Collective. Levels 0 ... `greatest` by the steps that the elements allow (ElementGroup::steps): 2^level `step` is at
/// most `slow_share` of it. Neighbours differ by at most one. Blocks whose elements need averages over their
/// neighbours have one level, rigid ones level 0. The same on any number of ranks.
ElementLevels find_levels(const Mesh& mesh, const ElementGroups& groups, double step, int greatest);

/// Collective. Least level of the elements around each local node; 0 where there are none.
std::vector<std::int32_t> node_levels(const Mesh& mesh, const ElementLevels& levels);

}  // namespace tenon

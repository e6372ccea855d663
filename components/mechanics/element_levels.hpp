// SPDX-License-Identifier: BSD-3-Clause
// Which elements may take steps longer than the shortest, and groups for them.
#pragma once

#include <cstdint>
#include <vector>

#include "components/mechanics/element_groups.hpp"

namespace tenon {

/// An element of level k takes one step where those of level 0 take 2^k; by block and element of the mesh.
using ElementLevels = std::vector<std::vector<std::int32_t>>;

/// Elements above level 0 take no more than this share of the step that they allow alone, even if the user takes more
/// of the shortest one; see docs/decisions/0014.
inline constexpr double slow_share = 0.8;

struct LevelRules {
  double step;     ///< of level 0, s
  double share;    ///< greatest share of what an element allows
  double longest;  ///< step that none may exceed, s
  int greatest;    ///< level
};

/// Collective. Levels by the steps that the elements allow (ElementGroup::steps): 2^level `step` is at most `share` of
/// it. Neighbours differ by at most one; beside a node with `stiff` 1 (ghosts too) no level exceeds 1. Blocks whose
/// elements need averages over their neighbours have one level, rigid ones level 0. The same on any number of ranks.
ElementLevels find_levels(const Mesh& mesh, const ElementGroups& groups, const LevelRules& rules,
                          std::span<const std::int32_t> stiff);

/// Collective. Least level of the elements around each local node; 0 where there are none.
std::vector<std::int32_t> node_levels(const Mesh& mesh, const ElementLevels& levels);

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// The items of a mesh that bear values (nodes, or the elements of all blocks in one row), and where their owners keep
// them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "framework/fields/field.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon::transfer {

inline constexpr auto max_nodes = static_cast<std::size_t>(max_element_nodes);

/// Local items of one location, owned and ghost, ascending by global id.
struct Items {
  std::vector<GlobalId> ids;
  std::vector<int> owners;
  std::vector<LocalIndex> at_owner;  ///< place in the owner's array; no_index for ghost elements (nobody needs it)
  std::vector<LocalIndex> owned;     ///< local indices, ascending
  LocalIndex size() const { return static_cast<LocalIndex>(ids.size()); }
};

/// Collective. `location` is node or element.
Items items_of(const Mesh& mesh, Location location);
/// Number of local items.
LocalIndex item_count(const Mesh& mesh, Location location);

/// Corner coordinates of an element, in the first topology(kind).nodes places.
using Corners = std::array<Vec3, max_nodes>;
Corners corners_of(const ElementBlock& block, LocalIndex element, std::span<const Vec3> coordinates);
/// Mean of the corners: the element's centre, in the order of its nodes.
Vec3 centre_of(ElementKind kind, const Corners& corners);

/// Calls `visit(item, block, element)` for every local element in ascending global order; `item` counts through all
/// blocks.
template <typename Visit>
void for_each_element(const Mesh& mesh, Visit&& visit) {
  LocalIndex item = 0;
  for (const ElementBlock& block : mesh.blocks)
    for (LocalIndex e = 0; e < block.size(); ++e) visit(item++, block, e);
}

}  // namespace tenon::transfer

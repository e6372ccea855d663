// SPDX-License-Identifier: BSD-3-Clause
// The items of a mesh that bear values (nodes, or the elements of all blocks in one row), and where their owners keep
// them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "framework/fields/field.hpp"
#include "framework/mesh/mesh.hpp"
#include "transfer/point_cloud.hpp"

namespace tenon::transfer {

inline constexpr auto max_nodes = static_cast<std::size_t>(max_element_nodes);

/// Local items of one location, owned and ghost, ascending by global id. Looks into the mesh or the cloud, which must
/// outlive it; what is not there stands in its own store.
struct Items {
  std::span<const GlobalId> ids;
  std::span<const int> owners;
  std::span<const LocalIndex> at_owner;  ///< place in the owner's array; no_index for ghost elements (nobody needs it)
  std::span<const LocalIndex> owned;     ///< local indices, ascending
  LocalIndex size() const { return static_cast<LocalIndex>(ids.size()); }
  std::int64_t memory() const;

  Items() = default;
  Items(Items&&) = default;
  Items& operator=(Items&&) = default;

  std::vector<GlobalId> own_ids;
  std::vector<int> own_owners;
  std::vector<LocalIndex> own_at_owner, own_owned;
};

/// Collective. `location` is node or element.
Items items_of(const Mesh& mesh, Location location);
/// Collective. The points of a cloud, all of them owned.
Items items_of(const PointCloud& cloud);
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

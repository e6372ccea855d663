// SPDX-License-Identifier: BSD-3-Clause
// Which elements of a mesh meet at which facet (a face of three or four nodes, or an edge of two).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "framework/mesh/mesh_data.hpp"

namespace tenon {

/// Sorts the few nodes of a facet or an element, ascending, by insertion.
inline void sort_few(std::span<GlobalId> nodes) {
  for (std::size_t i = 1; i < nodes.size(); ++i)
    for (std::size_t k = i; k > 0 && nodes[k] < nodes[k - 1]; --k) std::swap(nodes[k], nodes[k - 1]);
}

/// Global number of the first element of each block, and of all elements at the end.
std::vector<GlobalId> first_elements(const MeshData& mesh);

/// One side of one element, seen as a facet.
struct Facet {
  GlobalId element;
  std::int8_t side;
};

enum class FacetChoice {
  solid_sides,  ///< sides of solids
  all           ///< sides of solids, faces and edges of surface elements (each surface element gives its face once)
};

/// Calls `visit` with each group of facets that have the same nodes, ascending by (element, side) within a group and by
/// least node number among groups. Time and memory are linear in the number of facets.
void for_each_facet(const MeshData& mesh, FacetChoice choice, const std::function<void(std::span<const Facet>)>& visit);

}  // namespace tenon

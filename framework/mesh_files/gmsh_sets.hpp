// SPDX-License-Identifier: BSD-3-Clause
// Finds the side of an element on which a boundary element of a Gmsh file lies. Private to the room.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "framework/mesh/mesh_data.hpp"

namespace tenon::mesh_file {

class SideFinder {
 public:
  /// Faces of the solids of `mesh` (dimension 2) or edges of its surface elements (dimension 1), if all their nodes are
  /// `wanted`: the memory follows the boundary, not the mesh.
  SideFinder(const MeshData& mesh, int dimension, const std::vector<bool>& wanted);

  /// The side with these nodes; empty if no element has it. Between two solids, the one from which the boundary element
  /// points outward; otherwise that of the smallest element.
  std::optional<SideData> find(std::span<const GlobalId> nodes) const;

 private:
  using Nodes = std::array<GlobalId, max_side_nodes>;
  struct Entry {
    Nodes sorted;  ///< what is searched
    SideData side;
    Nodes ordered;  ///< outward
  };
  std::vector<Entry> entries_;
};

}  // namespace tenon::mesh_file

// SPDX-License-Identifier: BSD-3-Clause
// A side set as heat sees it: the area that each node of it stands for.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "framework/mesh/mesh.hpp"

namespace tenon::thermal {

/// Owned nodes of a side set, with the integral of N_i over its sides in the current configuration.
class Surface {
 public:
  /// Throws Error(usage) if the mesh has no such side set or it has sides that are edges.
  Surface(const Mesh& mesh, const std::string& side_set);
  /// Local. Recomputes the areas; sides add in ascending order.
  void update(std::span<const Vec3> coordinates);
  /// Local. Calls use(i, j, integral of N_i N_j) for each pair of nodes of each side, in ascending order of the sides.
  void links(std::span<const Vec3> coordinates, const std::function<void(LocalIndex, LocalIndex, double)>& use) const;
  /// Rows (positions in mesh.owned_nodes), ascending, and their areas, m^2.
  std::span<const LocalIndex> rows() const { return rows_; }
  std::span<const double> areas() const { return areas_; }

 private:
  const Mesh& mesh_;
  const SideSet* sides_;
  std::vector<LocalIndex> rows_;
  std::vector<double> areas_;
  std::vector<LocalIndex> entries_;  // for each side, max_side_nodes positions in rows_; no_index for ghosts and blanks
};

}  // namespace tenon::thermal

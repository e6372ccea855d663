// SPDX-License-Identifier: BSD-3-Clause
// A rectilinear grid laid over a mesh, whose trilinear hats carry the coarse part of a multigrid preconditioner.
#pragma once

#include <array>
#include <vector>

#include "components/thermal/sparse_matrix.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon::thermal {

/// Lines across each axis; the points are numbered x fastest.
struct RectilinearGrid {
  std::array<std::vector<double>, 3> lines;  ///< ascending, at least two each, m

  std::int64_t points() const;
  LocalIndex cells(std::size_t axis) const { return static_cast<LocalIndex>(lines[axis].size()) - 1; }
  /// Calls use(point, weight) for the hats that are not 0 at x; they add up to 1.
  template <typename Use>
  void hats(const Vec3& x, const Use& use) const {
    std::array<LocalIndex, 3> cell{};
    std::array<double, 3> t{};
    for (std::size_t axis = 0; axis < 3; ++axis) locate(axis, x[axis], cell[axis], t[axis]);
    const auto nx = static_cast<LocalIndex>(lines[0].size()), ny = static_cast<LocalIndex>(lines[1].size());
    for (LocalIndex k = 0; k < 8; ++k) {
      const LocalIndex i = k & 1, j = (k >> 1) & 1, l = k >> 2;
      const double w = (i ? t[0] : 1 - t[0]) * (j ? t[1] : 1 - t[1]) * (l ? t[2] : 1 - t[2]);
      if (w > 0) use(cell[0] + i + nx * (cell[1] + j + ny * (cell[2] + l)), w);
    }
  }
  /// The same grid with every second line left out across the axes whose cells are the narrowest (where conduction
  /// couples most); no axis if all have one cell.
  RectilinearGrid coarsened() const;

 private:
  void locate(std::size_t axis, double x, LocalIndex& cell, double& t) const;
};

/// Collective. Cells of about two and a half times the size of the elements, in each slab of the mesh and across each
/// axis by itself; where elements are longer across one axis than across another, no wider than need be. At most two
/// points per node. Made of integers summed over the ranks: the same on any number of them.
RectilinearGrid auxiliary_grid(const Mesh& mesh);

}  // namespace tenon::thermal

// SPDX-License-Identifier: BSD-3-Clause
// The levels of multigrid that every rank holds whole: a symmetric V-cycle on ever coarser rectilinear grids.
#pragma once

#include <span>
#include <vector>

#include "components/thermal/auxiliary_grid.hpp"
#include "components/thermal/chebyshev.hpp"
#include "components/thermal/sparse_matrix.hpp"

namespace tenon::thermal {

/// Local and serial: the same input gives the same bits on every rank. Matrices are kept in single precision (half the
/// memory traffic, and a preconditioner needs no more); all sums are in double.
class CoarseLevels {
 public:
  /// For matrices over `points` (numbers in `grid`, ascending).
  void lay_out(const RectilinearGrid& grid, std::vector<LocalIndex> points);
  /// `matrix`: symmetric, positive semi-definite. Coarser matrices are Galerkin products with linear interpolation
  /// between the lines. Allocates nothing if a matrix of this pattern was there before.
  void fill(const SparseMatrix<double>& matrix);
  /// One V-cycle from zero: result is about the inverse of the matrix times `b`, a symmetric map. Allocates nothing.
  void solve(std::span<const double> b, std::span<double> result);
  std::size_t levels() const { return levels_.size(); }
  std::int64_t memory() const;

 private:
  struct Level {
    SparseMatrix<double> exact, half;  // Galerkin product for this level (not the finest), and on the way to the next
    SparseMatrix<float> matrix, to_coarse, from_coarse;
    std::vector<double> inverse_diagonal, right_side, x, rest, change, product;
    Chebyshev smoother;
  };
  void fill_level(Level& level, const SparseMatrix<double>& matrix);
  void cycle(std::size_t level);
  static void smooth_level(Level& level, bool from_zero);
  void factor(const SparseMatrix<double>& coarsest);
  void solve_directly(Level& level) const;

  std::vector<Level> levels_;
  std::vector<LocalIndex> place_;
  std::vector<double> factor_;  // L D L^T of the coarsest matrix, row by row; the inverse of D on the diagonal
};

}  // namespace tenon::thermal

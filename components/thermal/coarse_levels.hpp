// SPDX-License-Identifier: BSD-3-Clause
// The levels of multigrid that every rank holds whole: a symmetric V-cycle on ever coarser rectilinear grids.
#pragma once

#include <span>
#include <vector>

#include "components/thermal/auxiliary_grid.hpp"
#include "components/thermal/sparse_matrix.hpp"

namespace tenon::thermal {

/// Chebyshev smoothing [Saa03, algorithm 12.1] on the upper part of the spectrum of D^-1 A: its coefficients.
struct Chebyshev {
  static constexpr int degree = 2;
  /// Part of the spectrum that is smoothed: from `greatest` / `range` to `greatest`.
  static constexpr double range = 5;
  explicit Chebyshev(double greatest = 1)
      : theta(0.5 * greatest * (1 + 1 / range)), delta(0.5 * greatest * (1 - 1 / range)) {}
  /// What to take for the greatest eigenvalue, from a power iteration and the greatest sum of a row.
  static double bound(double power, double row);
  double theta, delta;
};

/// Local and serial: the same input gives the same bits on every rank. Matrices are kept in single precision (half the
/// memory traffic, and a preconditioner needs no more); all sums are in double.
class CoarseLevels {
 public:
  /// `matrix`: symmetric, positive semi-definite, over `points` (numbers in `grid`, ascending). Coarser matrices are
  /// Galerkin products with linear interpolation between the lines.
  void build(const RectilinearGrid& grid, std::vector<LocalIndex> points, SparseMatrix<double> matrix);
  /// One V-cycle from zero: result is about the inverse of the matrix times `b`, a symmetric map. Allocates nothing.
  void solve(std::span<const double> b, std::span<double> result);
  std::size_t levels() const { return levels_.size(); }
  std::int64_t memory() const;

 private:
  struct Level {
    SparseMatrix<float> matrix, to_coarse, from_coarse;
    std::vector<double> inverse_diagonal, right_side, x, rest, change;
    Chebyshev smoother;
  };
  void add_level(const SparseMatrix<double>& matrix);
  void cycle(std::size_t level);
  static void smooth(Level& level, bool from_zero);
  void factor(const SparseMatrix<double>& coarsest);
  void solve_directly(Level& level) const;

  std::vector<Level> levels_;
  std::vector<double> factor_;  // L D L^T of the coarsest matrix, row by row; the inverse of D on the diagonal
};

}  // namespace tenon::thermal

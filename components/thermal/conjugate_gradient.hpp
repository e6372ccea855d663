// SPDX-License-Identifier: BSD-3-Clause
// Preconditioned conjugate gradients whose every bit is the same on any number of ranks.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "components/thermal/heat_system.hpp"
#include "components/thermal/multigrid.hpp"

namespace tenon::thermal {

struct SolveReport {
  int iterations = 0;
  double residual = 0;  ///< relative to the right-hand side, in the norm of the inverse diagonal
  bool converged = false;
};

/// The variant of Chronopoulos and Gear [CG89]: one reduction and one ghost exchange per iteration. Preconditioned by
/// the diagonal or by multigrid. Dot products are exact sums, so the iterates do not depend on the ranks.
class ConjugateGradient {
 public:
  explicit ConjugateGradient(const Mesh& mesh);

  /// Collective. `x` (matrix.width()) brings the held values and a first guess, and takes the solution, ghosts
  /// included; `residual` takes b - A x of all rows, held ones included. Converged when the true residual is
  /// `tolerance` times the right-hand side (less what the held values bring), or as small as round-off in x allows.
  /// `multigrid`: built for this system, or nullptr for the diagonal; the measure of convergence is the same.
  SolveReport solve(const HeatSystem& system, std::span<const double> b, std::span<double> x,
                    std::span<double> residual, double tolerance, int max_iterations, Multigrid* multigrid);

  std::int64_t memory() const;

 private:
  /// r = b - A x with x's ghosts refreshed.
  void true_residual(const HeatSystem& system, std::span<const double> b, std::span<double> x, std::span<double> r);
  /// Dot products of an iteration.
  struct Dots {
    double gamma, delta;  ///< r.u and u.A u
    double size;          ///< r.r / diagonal: what convergence is measured by
  };
  /// u = M^-1 r with ghosts, w = A u.
  Dots precondition(const HeatSystem& system, std::span<const double> r);
  double size_of(const HeatSystem& system, std::span<const double> r) const;
  /// Norm of the right-hand side with the held values moved there.
  double scale_of(const HeatSystem& system, std::span<const double> b, std::span<const double> x);
  int iterate(const HeatSystem& system, std::span<double> x, std::span<double> r, double target, int budget);

  const Mesh& mesh_;
  Multigrid* multigrid_ = nullptr;  // of the present solution
  std::vector<double> u_;           // of the width of the matrix
  std::vector<double> w_, p_, s_;   // rows
};

}  // namespace tenon::thermal

// SPDX-License-Identifier: BSD-3-Clause
// Preconditioned conjugate gradients whose every bit is the same on any number of ranks.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "components/thermal/conduction_matrix.hpp"

namespace tenon::thermal {

/// (diag(d) + factor * off-diagonal of K) x = b, W or J. Rows whose `inverse_diagonal` is 0 are held: x stays what it
/// was.
struct HeatSystem {
  const ConductionMatrix& matrix;
  double factor;
  std::span<const double> diagonal;
  std::span<const double> inverse_diagonal;
};

struct SolveReport {
  int iterations = 0;
  double residual = 0;  ///< relative to the right-hand side, in the norm of the inverse diagonal
  bool converged = false;
};

/// The variant of Chronopoulos and Gear [CG89]: one reduction and one ghost exchange per iteration. Preconditioned by
/// the diagonal. Dot products are exact sums, so the iterates do not depend on the ranks.
class ConjugateGradient {
 public:
  explicit ConjugateGradient(const Mesh& mesh);

  /// Collective. `x` (all local nodes) brings the held values and a first guess, and takes the solution, ghosts
  /// included; `residual` takes b - A x of all rows, held ones included. Converged when the true residual is
  /// `tolerance` times the right-hand side (less what the held values bring), or as small as round-off in x allows.
  SolveReport solve(const HeatSystem& system, std::span<const double> b, std::span<double> x,
                    std::span<double> residual, double tolerance, int max_iterations);

  std::int64_t memory() const;

 private:
  /// r = b - A x with x's ghosts refreshed.
  void true_residual(const HeatSystem& system, std::span<const double> b, std::span<double> x, std::span<double> r);
  /// u = r / diagonal with ghosts, w = A u, and the dot products r.u and w.u.
  std::array<double, 2> precondition(const HeatSystem& system, std::span<const double> r);
  /// Norm of the right-hand side with the held values moved there.
  double scale_of(const HeatSystem& system, std::span<const double> b, std::span<const double> x);
  int iterate(const HeatSystem& system, std::span<double> x, std::span<double> r, std::array<double, 2> dots,
              double target, int budget);

  const Mesh& mesh_;
  std::vector<double> u_;          // all local nodes
  std::vector<double> w_, p_, s_;  // rows
};

}  // namespace tenon::thermal

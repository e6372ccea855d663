// SPDX-License-Identifier: BSD-3-Clause
// The linear solution of an implicit step, and the choice of its preconditioner.
#include <fmt/core.h>

#include <cmath>

#include "components/thermal/thermal.hpp"

namespace tenon {

// `increment_` brings the held values and the first guess and takes the solution; `residual_` what is left.
thermal::SolveReport Thermal::solve_linear(const thermal::HeatSystem& system, std::span<const double> b,
                                           double tolerance) {
  // An iteration of multigrid costs about eight of the diagonal's and five to ten are enough.
  constexpr int patience = 60;
  const bool may_change = options_.preconditioner == ThermalPreconditioner::automatic && !multigrid_chosen_;
  if (options_.preconditioner == ThermalPreconditioner::multigrid) multigrid_chosen_ = true;
  const int budget = may_change ? std::min(patience, options_.max_iterations) : options_.max_iterations;
  last_solve_ = solver_.solve(system, b, increment_, residual_, tolerance, budget,
                              multigrid_chosen_ ? &multigrid_for(system) : nullptr);
  if (may_change && !last_solve_.converged && budget < options_.max_iterations) {
    multigrid_chosen_ = true;
    const int before = last_solve_.iterations;
    last_solve_ = solver_.solve(system, b, increment_, residual_, tolerance, options_.max_iterations - before,
                                &multigrid_for(system));
    last_solve_.iterations += before;
  }
  solver_iterations_ += last_solve_.iterations;
  if (!last_solve_.converged)
    throw Error(
        ExitCode::unstable,
        fmt::format("component '{}' at time {:.6g} s: conjugate gradients stopped after {} iterations at a relative "
                    "residual of {:.3g}, expected {:.3g}; take a smaller time step or a greater "
                    "solver.tolerance",
                    name(), time(), last_solve_.iterations, last_solve_.residual, tolerance));
  return last_solve_;
}

// Rebuilt when the matrix has changed, or the step by more than a factor of two. What it is built for can be told from
// the state alone, so that a run that was restarted builds the same.
thermal::Multigrid& Thermal::multigrid_for(const thermal::HeatSystem& system) {
  if (!multigrid_) multigrid_ = std::make_unique<thermal::Multigrid>(*mesh_);
  const double ratio = multigrid_factor_ > 0 ? system.factor / multigrid_factor_ : 0;
  const bool other_step = !(ratio >= 0.5 && ratio <= 2);
  if (multigrid_->built() && !multigrid_stale_ && !other_step) return *multigrid_;
  if (contact_) multigrid_ = std::make_unique<thermal::Multigrid>(*mesh_);  // what is tied may have changed
  if (is_nonlinear() || multigrid_stale_ || other_step) {
    multigrid_factor_ = system.factor;
    multigrid_->build(system, contact_.get());
  } else {  // after a restart: as it was built then
    std::vector<double> diagonal(capacity_.size()), inverse(capacity_.size(), 0.0);
    for (std::size_t k = 0; k < diagonal.size(); ++k) {
      const double stored = is_steady() ? 0 : capacity_[k];
      diagonal[k] = stored + multigrid_factor_ * (matrix_.diagonal()[k] + film_[k]);
      if (inverse_diagonal_[k] > 0) inverse[k] = 1 / diagonal[k];
    }
    multigrid_->build({matrix_, multigrid_factor_, diagonal, inverse}, contact_.get());
  }
  multigrid_stale_ = false;
  return *multigrid_;
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// One implicit stage: E(T) = target + factor * (heat that flows at T), solved by Newton's method.
//
// The energy of a node is a function of its temperature (capacity, or enthalpy with latent heat). The conductivity
// enters at the last iterate (Picard), so that every matrix stays symmetric; everything else by its derivative.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/thermal/thermal_loads.hpp"

namespace tenon {
/// K. The same on every rank, and so is the refusal.
double Thermal::absolute_ambient(const RadiationLoad& load, double time) const {
  const double ambient = load.ambient(time);
  if (ambient >= 0) return ambient;
  throw Error(
      ExitCode::usage,
      fmt::format("component '{}' at time {:.6g} s: the surroundings that it radiates to have {:.6g} K; expected "
                  "an absolute temperature, 0 K or more, at all times (as `20 degC` or `293.15 K`)",
                  name(), time, ambient));
}

/// rate_ at a time and the present temperature (ghosts included).
void Thermal::evaluate(double time) {
  if (warm_conductivity_) {
    const ScopedTimer timer(*assemble_time_);
    assemble_matrix();  // the geometry was found good
  }
  const ScopedTimer timer(*load_time_);
  matrix_.conducted(temperature_, rate_);
  each_load(time, [this](Supply, LocalIndex row, double power) { rate_[static_cast<std::size_t>(row)] += power; });
  for (std::size_t k = 0; k < rate_.size(); ++k) rate_[k] += received_[k];
}

/// Notes what the loads supply and what each node is given by the present rates over a time of `weight`.
void Thermal::book(double weight, double time) {
  each_load(time, [this, weight](Supply kind, LocalIndex row, double power) {
    pending_[kind][static_cast<std::size_t>(row)] += weight * power;
  });
  for (std::size_t k = 0; k < rate_.size(); ++k) given_[k] += weight * rate_[k];
  book_contacts(weight, pending_passed_);
}

/// Above that of the initial temperature, J.
double Thermal::node_energy(std::size_t k) const {
  if (content_.is_linear()) return capacity_[k] * rise_[k];
  return content_.difference(k, initial_[k], initial_[k] + rise_[k]);
}

void Thermal::hold(double time) {
  for (const Held& held : held_) {
    const auto k = static_cast<std::size_t>(held.row);
    rise_[k] = options_.prescribed[held.function].temperature(time) - initial_[k];
  }
}

/// right_side_ = what the free nodes lack; returns its size, in the norm of the inverse diagonal. Collective.
double Thermal::stage_residual(double factor) {
  for (std::size_t k = 0; k < right_side_.size(); ++k) {
    const double stored = is_steady() ? 0 : node_energy(k);
    right_side_[k] = inverse_diagonal_[k] > 0 ? target_[k] + factor * rate_[k] - stored : 0;
  }
  stage_matrix(factor);
  ExactSum size;
  for (std::size_t k = 0; k < right_side_.size(); ++k) size.add(inverse_diagonal_[k] * right_side_[k] * right_side_[k]);
  return std::sqrt(mesh_->comm.sum(size));
}

/// The diagonal of Newton's matrix at the present temperature.
void Thermal::stage_matrix(double factor) {
  for (std::size_t k = 0; k < diagonal_.size(); ++k) {
    const double t = initial_[k] + rise_[k];
    double stored = is_steady() ? 0 : capacity_[k];
    if (!is_steady() && !content_.is_linear()) stored = content_.slope(k, t, right_side_[k] >= 0);
    diagonal_[k] = stored + factor * (matrix_.diagonal()[k] + film_[k]);
  }
  for (const RadiationLoad& load : radiation_loads_)
    for (std::size_t i = 0; i < load.surface.rows().size(); ++i) {
      const auto k = static_cast<std::size_t>(load.surface.rows()[i]);
      const double t = std::max(0.0, initial_[k] + rise_[k]);
      diagonal_[k] += factor * load.surface.areas()[i] * 4 * load.emissivity * thermal::stefan_boltzmann * t * t * t;
    }
  for (std::size_t k = 0; k < diagonal_.size(); ++k)
    if (inverse_diagonal_[k] > 0) inverse_diagonal_[k] = 1 / diagonal_[k];
}

/// Either small beside the first residual, or round-off in the temperatures. Collective.
bool Thermal::newton_converged(double size, double first) const {
  constexpr double round_off = 64 * std::numeric_limits<double>::epsilon();
  const double tolerance = is_nonlinear() ? options_.nonlinear_tolerance : 2 * options_.tolerance;
  if (size <= tolerance * first) return true;
  ExactSum all;
  for (std::size_t k = 0; k < diagonal_.size(); ++k) {
    const double t = initial_[k] + rise_[k];
    if (inverse_diagonal_[k] > 0) all.add(diagonal_[k] * t * t);
  }
  return size <= round_off * std::sqrt(mesh_->comm.sum(all));
}

/// Adds the increment; a node that would run past solidus or liquidus stops there, and goes on with the other slope.
void Thermal::apply_newton() {
  for (std::size_t k = 0; k < rise_.size(); ++k) {
    if (!(inverse_diagonal_[k] > 0)) continue;
    const double change = increment_[static_cast<std::size_t>(mesh_->owned_nodes[k])];
    if (content_.is_linear() || is_steady()) {
      rise_[k] += change;
      continue;
    }
    const double from = initial_[k] + rise_[k], to = from + change, reached = content_.stop(k, from, to);
    rise_[k] = reached == to ? rise_[k] + change : reached - initial_[k];
  }
}

/// From the guess in rise_; leaves the temperature, and rate_ at it. False if it does not converge. Collective.
bool Thermal::solve_stage(double factor, double time) {
  constexpr int most = 100;
  constexpr double forcing = 1e-3;  // each linear solution of a nonlinear problem
  hold(time);
  double first = 0;
  for (int iteration = 0; iteration <= most; ++iteration) {
    show_temperatures();
    evaluate(time);
    const ScopedTimer timer(*solve_time_);
    const double size = stage_residual(factor);
    if (iteration == 0) first = size;
    if (!std::isfinite(size)) return false;
    if (newton_converged(size, first)) return true;
    std::ranges::fill(increment_, 0.0);
    solve_linear({matrix_, factor, diagonal_, inverse_diagonal_}, right_side_,
                 is_nonlinear() ? std::max(forcing, options_.tolerance) : options_.tolerance);
    ++newton_iterations_;
    apply_newton();
  }
  return false;
}

void Thermal::refuse_newton(double time) const {
  throw Error(ExitCode::unstable,
              fmt::format("component '{}' up to time {:.6g} s: Newton's iterations did not come down to {:.3g} of the "
                          "first residual; look for loads that are not numbers, or take a smaller time step, smoother "
                          "tables, a wider interval between solidus and liquidus, or a greater "
                          "solver.nonlinear_tolerance",
                          name(), time, options_.nonlinear_tolerance));
}

void Thermal::begin_stages() {
  if (is_nonlinear()) multigrid_stale_ = true;  // the coefficients have changed
  start_rise_ = rise_;
  for (std::size_t k = 0; k < rise_.size(); ++k) start_energy_[k] = node_energy(k);
  std::ranges::fill(given_, 0.0);
  for (std::vector<double>& p : pending_) std::ranges::fill(p, 0.0);
  pending_passed_.assign(passed_.size(), 0.0);
}

/// Books a step that is taken. What a free node got but did not store (the solver's residual) waits for the next step;
/// a held node got the rest from outside. So the energies add up node by node.
void Thermal::end_stages() {
  const ScopedTimer timer(*update_time_);
  for (std::size_t kind = 0; kind < supplies; ++kind)
    for (std::size_t k = 0; k < pending_[kind].size(); ++k) supplied_[kind][k] += pending_[kind][k];
  for (std::size_t k = 0; k < passed_.size(); ++k) passed_[k] += pending_passed_[k];
  const auto reaction = static_cast<std::size_t>(is_steady() ? steady : prescribed);
  for (std::size_t k = 0; k < rise_.size(); ++k) {
    const double stored = node_energy(k) - start_energy_[k];
    if (is_steady()) {
      const bool free = inverse_diagonal_[k] > 0;
      supplied_[steady][k] += free ? stored - given_[k] : stored;
      if (!free && booked_[prescribed]) supplied_[prescribed][k] -= given_[k];
    } else if (inverse_diagonal_[k] > 0) {
      waiting_heat_[k] += given_[k] - stored;
    } else if (!supplied_[reaction].empty()) {
      supplied_[reaction][k] += stored - given_[k];
    }
  }
}

void Thermal::advance_by_stages(double dt) {
  for (std::size_t k = 0; k < received_.size(); ++k) received_[k] = waiting_heat_[k] / dt;
  std::ranges::fill(waiting_heat_, 0.0);
  switch (options_.stepper) {
    case ThermalStepper::steady:
      return steady_step(dt);
    case ThermalStepper::tr_bdf2:
      return tr_bdf2_steps(dt);
    default:
      return theta_step(dt);
  }
}

void Thermal::theta_step(double dt) {
  begin_stages();
  if (theta() < 1) {
    evaluate(time());
    book((1 - theta()) * dt, time());
  }
  for (std::size_t k = 0; k < target_.size(); ++k) target_[k] = start_energy_[k] + given_[k];
  if (!solve_stage(theta() * dt, time() + dt)) refuse_newton(time() + dt);
  book(theta() * dt, time() + dt);
  end_stages();
}

// No storage: the loads at the end of the step, for as long as the step.
void Thermal::steady_step(double dt) {
  multigrid_stale_ = multigrid_stale_ || warm_conductivity_;
  begin_stages();
  std::ranges::fill(target_, 0.0);
  if (!solve_stage(1.0, time() + dt)) refuse_newton(time() + dt);
  book(dt, time() + dt);
  end_stages();
}

}  // namespace tenon

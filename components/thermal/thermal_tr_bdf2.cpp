// SPDX-License-Identifier: BSD-3-Clause
// TR-BDF2: two implicit stages with one matrix, of second order, L-stable, with an embedded third-order result
// [BCF85, HS96]; and the step that it chooses from the error.
//   E(g) = E0 + d dt (f0 + fg)              g = 2 - sqrt 2, d = g / 2
//   E(1) = E0 + dt (w f0 + w fg + d f1)     w = sqrt 2 / 4
//   error = dt ((w - (1 - w)/3) f0 + (w - (3 w + 1)/3) fg + (d - d/3) f1), smoothed by the matrix of the stages.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "components/thermal/thermal_loads.hpp"

namespace tenon {
namespace {

constexpr double g = 2 - std::numbers::sqrt2, d = g / 2, w = std::numbers::sqrt2 / 4;
constexpr double least_change = 0.2, greatest_change = 4, worth_a_change = 1.2, caution = 0.9;

}  // namespace

/// The two stages; false if one does not converge. Collective.
bool Thermal::tr_bdf2_stages(double start, double dt) {
  begin_stages();
  evaluate(start);
  first_rate_ = rate_;
  book(w * dt, start);
  for (std::size_t k = 0; k < target_.size(); ++k) target_[k] = start_energy_[k] + d * dt * rate_[k];
  if (!solve_stage(d * dt, start + g * dt)) return false;
  mid_rate_ = rate_;
  book(w * dt, start + g * dt);
  for (std::size_t k = 0; k < target_.size(); ++k) {
    target_[k] = start_energy_[k] + given_[k];
    if (content_.is_linear()) rise_[k] = start_rise_[k] + (rise_[k] - start_rise_[k]) / g;  // the guess
  }
  if (!solve_stage(d * dt, start + dt)) return false;
  book(d * dt, start + dt);
  return true;
}

/// One step from the present state; false, with nothing changed, if its error is too great.
bool Thermal::tr_bdf2_step(double start, double dt) {
  const bool solved = tr_bdf2_stages(start, dt);
  if (options_.fixed_step && !solved) refuse_newton(start + dt);
  bool good = solved;
  if (!options_.fixed_step) {
    const double error = solved ? error_of_step(dt) : std::numeric_limits<double>::infinity();
    good = error <= options_.control.tolerance;
    choose_step(dt, error, good);
  }
  if (good) {
    end_stages();
    ++steps_taken_;
  } else {
    rise_ = start_rise_;
    show_temperatures();
    ++steps_repeated_;
  }
  return good;
}

/// Greatest error of a temperature, K. Collective.
double Thermal::error_of_step(double dt) {
  constexpr double tolerance = 1e-2;  // of an estimate
  const ScopedTimer timer(*solve_time_);
  const double e0 = w - (1 - w) / 3, eg = w - (3 * w + 1) / 3, e1 = d - d / 3;
  for (std::size_t k = 0; k < right_side_.size(); ++k) {
    const double energy = dt * (e0 * first_rate_[k] + eg * mid_rate_[k] + e1 * rate_[k]);
    right_side_[k] = inverse_diagonal_[k] > 0 ? energy : 0;
  }
  std::ranges::fill(increment_, 0.0);
  solve_linear({matrix_, d * dt, diagonal_, inverse_diagonal_}, right_side_, tolerance);
  double greatest = 0;
  for (const LocalIndex n : mesh_->owned_nodes) {
    const double error = std::abs(increment_[static_cast<std::size_t>(n)]);
    greatest = error <= greatest ? greatest : error;  // keeps what is not a number
  }
  return mesh_->comm.max(std::isfinite(greatest) ? greatest : std::numeric_limits<double>::infinity());
}

/// The error of a step grows as its cube. A step that was cut short by others says nothing against a longer one, unless
/// it was by what came from outside, of which the longer one knew nothing.
void Thermal::choose_step(double dt, double error, bool taken) {
  const double limit = options_.control.maximum.value_or(std::numeric_limits<double>::infinity());
  double change = error > 0 ? caution * std::cbrt(options_.control.tolerance / error) : greatest_change;
  change = std::clamp(change, least_change, taken ? greatest_change : caution);
  if (taken && change >= 1 && change < worth_a_change) change = 1;
  const double wanted = std::min(dt * change, limit);
  next_step_ = taken && dt < next_step_ && !hastened_ ? std::max(next_step_, wanted) : wanted;
}

/// What the scene says, or a step in which no temperature changes by more than the tolerance. Collective.
void Thermal::first_step() {
  const StepControl& control = options_.control;
  const double limit = control.maximum.value_or(std::numeric_limits<double>::infinity());
  if (control.initial) {
    next_step_ = std::min(*control.initial, limit);
    return;
  }
  std::ranges::fill(received_, 0.0);
  evaluate(time());
  double fastest = 0;
  for (std::size_t k = 0; k < rate_.size(); ++k) {
    if (!(inverse_diagonal_[k] > 0)) continue;
    fastest = std::max(fastest, std::abs(rate_[k]) / capacity_of_change(k, rate_[k]));
  }
  fastest = mesh_->comm.max(fastest);
  next_step_ = fastest > 0 ? std::min(control.tolerance / fastest, limit) : limit;
}

/// J/K, for heat of this sign.
double Thermal::capacity_of_change(std::size_t k, double heat) const {
  return content_.is_linear() ? capacity_[k] : content_.slope(k, initial_[k] + rise_[k], heat >= 0);
}

/// Greatest change of a temperature, K, that has come from outside since the step began and that the choice of the step
/// could not know: heat received, loads and held temperatures that are others than at the start. Collective.
double Thermal::withheld_change(double now) {
  const ScopedTimer timer(*load_time_);
  const double lag = now - time();
  std::ranges::copy(waiting_heat_, residual_.begin());
  const auto add = [this](double weight) {
    return [this, weight](Supply, LocalIndex row, double power) {
      residual_[static_cast<std::size_t>(row)] += weight * power;
    };
  };
  each_load(now, add(lag));
  each_load(time(), add(-lag));
  double greatest = 0;
  for (std::size_t k = 0; k < residual_.size(); ++k)
    if (inverse_diagonal_[k] > 0)
      greatest = std::max(greatest, std::abs(residual_[k]) / capacity_of_change(k, residual_[k]));
  for (const PrescribedTemperature& held : options_.prescribed)
    greatest = std::max(greatest, std::abs(held.temperature(now) - held.temperature(time())));
  return mesh_->comm.max(greatest);
}

/// As many steps as dt takes: one, if it is not longer than what time_step() gave and the error allows.
void Thermal::tr_bdf2_steps(double dt) {
  if (options_.fixed_step) {
    tr_bdf2_step(time(), dt);
    return;
  }
  if (next_step_ == 0) first_step();
  const double round_off = 1e-12 * dt;
  for (double done = 0; dt - done > round_off;) {
    const double left = dt - done, step = next_step_ < left * (1 - 1e-9) ? next_step_ : left;
    if (!(step > round_off)) refuse_newton(time() + done);
    if (tr_bdf2_step(time() + done, step)) done += step;
    hastened_ = false;
  }
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// One step: loads, increment of temperature, energy, update.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "components/thermal/thermal_loads.hpp"

namespace tenon {

void Thermal::advance(double dt) {
  refresh_geometry();
  follow_contacts(is_explicit() ? time() : time() + 0.5 * dt);
  if (goes_by_stages())
    advance_by_stages(dt);
  else
    advance_at_once(dt);
  throw_if_not_finite();
  if (!assembled_) ++skipped_assemblies_;
  assembled_ = false;
  element_steps_ += owned_elements_;
  last_dt_ = dt;
  set_time(time() + dt);
}

// The theta method with constant coefficients.
void Thermal::advance_at_once(double dt) {
  gather_loads(dt);
  book_contacts((1 - theta()) * dt, passed_);
  hold_prescribed(time() + dt);
  if (is_explicit())
    solve_explicit();
  else
    solve_implicit(dt);
  const ScopedTimer timer(*update_time_);
  book_reactions(dt);
  apply_increment();
  show_temperatures();
  book_contacts(theta() * dt, passed_);
}

// Energy (J) that the step brings to each node, as far as it is known before the new temperature. Convection at the
// temperature of the start; book_reactions adds what the increment changes.
void Thermal::gather_loads(double dt) {
  const ScopedTimer timer(*load_time_);
  right_side_.swap(waiting_heat_);  // what was received, booked on receipt
  std::ranges::fill(waiting_heat_, 0.0);
  const auto add = [this](double weight) {
    return [this, weight](Supply kind, LocalIndex row, double power) {
      right_side_[static_cast<std::size_t>(row)] += weight * power;
      supplied_[kind][static_cast<std::size_t>(row)] += weight * power;
    };
  };
  if (theta() < 1) each_load(time(), add((1 - theta()) * dt));
  if (theta() > 0) each_load(time() + dt, add(theta() * dt));
  add_conduction(dt);
}

void Thermal::add_conduction(double dt) {
  matrix_.conducted(temperature_, residual_);
  for (std::size_t k = 0; k < right_side_.size(); ++k) right_side_[k] += dt * residual_[k];
}

void Thermal::hold_prescribed(double end) {
  for (const Held& held : held_) {
    const auto k = static_cast<std::size_t>(held.row);
    const double wanted = options_.prescribed[held.function].temperature(end) - initial_[k];
    increment_[static_cast<std::size_t>(mesh_->owned_nodes[k])] = wanted - rise_[k];
  }
}

void Thermal::solve_explicit() {
  const ScopedTimer timer(*solve_time_);
  for (std::size_t k = 0; k < right_side_.size(); ++k) {
    const bool free = inverse_diagonal_[k] > 0;
    double& increment = increment_[static_cast<std::size_t>(mesh_->owned_nodes[k])];
    if (free) increment = inverse_diagonal_[k] * right_side_[k];
    residual_[k] = free ? 0 : right_side_[k] - capacity_[k] * increment;
  }
}

void Thermal::solve_implicit(double dt) {
  const ScopedTimer timer(*solve_time_);
  const double factor = theta() * dt;
  for (std::size_t k = 0; k < diagonal_.size(); ++k) {
    diagonal_[k] = capacity_[k] + factor * (matrix_.diagonal()[k] + film_[k]);
    if (inverse_diagonal_[k] > 0) inverse_diagonal_[k] = 1 / diagonal_[k];
  }
  if (last_dt_ > 0 && last_dt_ != dt)  // the first guess: the change goes on as in the last step
    for (std::size_t k = 0; k < diagonal_.size(); ++k)
      if (inverse_diagonal_[k] > 0) increment_[static_cast<std::size_t>(mesh_->owned_nodes[k])] *= dt / last_dt_;
  solve_linear({matrix_, factor, diagonal_, inverse_diagonal_}, right_side_, options_.tolerance);
}

void Thermal::book_reactions(double dt) {
  for (const Held& held : held_)
    supplied_[prescribed][static_cast<std::size_t>(held.row)] -= residual_[static_cast<std::size_t>(held.row)];
  if (convection_loads_.empty() || is_explicit()) return;
  const double factor = theta() * dt;
  for (std::size_t k = 0; k < film_.size(); ++k)
    if (film_[k] > 0)
      supplied_[convection][k] -= factor * film_[k] * increment_[static_cast<std::size_t>(mesh_->owned_nodes[k])];
}

// What the solver left over (the sum of the residual of the free nodes) is spread over them evenly, so that the energy
// balance closes to round-off whatever the tolerance. Node by node, as residual / capacity, it would stir up the very
// modes that the implicit step damps. Collective.
double Thermal::balance_shift() const {
  ExactSum left;
  for (std::size_t k = 0; k < residual_.size(); ++k)
    if (inverse_diagonal_[k] > 0) left.add(residual_[k]);
  const double all = mesh_->comm.sum(left);
  return free_capacity_ > 0 ? all / free_capacity_ : 0;
}

void Thermal::apply_increment() {
  const double shift = is_explicit() ? 0 : balance_shift();
  for (std::size_t k = 0; k < rise_.size(); ++k)
    rise_[k] += increment_[static_cast<std::size_t>(mesh_->owned_nodes[k])] + (inverse_diagonal_[k] > 0 ? shift : 0);
}

void Thermal::show_temperatures() {
  for (std::size_t k = 0; k < rise_.size(); ++k)
    temperature_[static_cast<std::size_t>(mesh_->owned_nodes[k])] = initial_[k] + rise_[k];
  matrix_.halo().forward(std::span<const double>(temperature_), std::span<double>(temperature_));
}

void Thermal::throw_if_not_finite() const {
  const auto bad = std::ranges::find_if(
      mesh_->owned_nodes, [&](LocalIndex n) { return !std::isfinite(temperature_[static_cast<std::size_t>(n)]); });
  const bool mine = bad != mesh_->owned_nodes.end();
  if (!mesh_->comm.any(mine)) return;
  const auto n = mine ? static_cast<std::size_t>(*bad) : 0;
  const std::int64_t id = mine ? mesh_->node_ids[n] : std::numeric_limits<std::int64_t>::max();
  std::optional<Error> error;
  if (id == mesh_->comm.min(id) && mine) {
    const Vec3& x = coordinates_[n];
    error = Error(
        ExitCode::unstable,
        fmt::format("component '{}' after time {:.6g} s: the temperature of node {} at ({:.6g}, {:.6g}, {:.6g}) m "
                    "is not a number; look for loads that are too great, or take a smaller time step",
                    name(), time(), mesh_->node_labels[n], x[0], x[1], x[2]));
  }
  mesh_->comm.throw_if_any(error);
}

}  // namespace tenon

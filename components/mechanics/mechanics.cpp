// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/mechanics.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenon {

Mechanics::Mechanics(std::string name, std::shared_ptr<const Mesh> mesh, MechanicsOptions options)
    : Component(std::move(name)),
      mesh_(std::move(mesh)),
      options_(std::move(options)),
      conditions_(*mesh_, options_.motions, options_.walls),
      nodes_(mesh_->coordinates) {
  make_groups();
  set_loads();
  sum_masses();
  set_temperatures();
  set_constraints();
  follow_limit();
}

void Mechanics::initialize() {
  phases_ = {&phase("forces"), &phase("update"), &phase("halo"), &phase("reduce")};
  if (!loaded_) set_velocities();
  compute_forces(0);
  choose_step();
}

void Mechanics::advance(double dt) {
  kick(dt);
  refresh_ghosts();
  drift(dt);
  compute_forces(dt);
  set_time(time() + dt);
  started_ = true;
  ++steps_;
  work_done_ += owned_elements_;
  choose_step();
}

namespace {

/// v* = v- - kick f/m on every node; books the work of the nodes against f.
void kick_vectors(std::span<Vec3> velocity, std::span<const ForceRow> force, std::span<const double> inverse_mass,
                  double kick, std::vector<double>& work) {
  for (std::size_t n = 0; n < velocity.size(); ++n) {
    const double* f = force[n].v;
    const double scale = kick * inverse_mass[n];
    Vec3& v = velocity[n];
    const Vec3 kicked{v[0] - scale * f[0], v[1] - scale * f[1], v[2] - scale * f[2]};
    const double power = f[0] * (v[0] + kicked[0]) + f[1] * (v[1] + kicked[1]) + f[2] * (v[2] + kicked[2]);
    work[n] += 0.5 * kick * power;
    v = kicked;
  }
}

}  // namespace

// Ghosts are replaced by what their owners find. Conditions correct v* and the work; loads book theirs when the
// velocities are final. Nodes of rigid bodies have the body's velocity before and after the kick, then that which takes
// them to its next place.
void Mechanics::kick(double dt) {
  const ScopedTimer timer(*phases_.update);
  if (relaxation_ && relaxation_->begin(nodes_)) previous_dt_ = 0;
  const double kick = 0.5 * (previous_dt_ + dt);
  if (!loads_->empty()) loads_->apply(nodes_, groups_, time(), kick);
  if (!rigid_->empty()) set_rigid_rates();
  if (!loads_->empty()) loads_->remember(nodes_);
  if (!ties_->empty()) ties_->gather(nodes_);
  if (!rigid_->empty()) rigid_->kick(nodes_, time(), kick, dt);
  kick_vectors(nodes_.velocity(), nodes_.force, nodes_.inverse_mass, kick, nodes_.internal_work);
  if (nodes_.has_rotations())
    kick_vectors(nodes_.spin(), nodes_.moment, nodes_.inverse_inertia, kick, nodes_.internal_work);
  conditions_.apply(nodes_, time(), kick, dt);
  if (!rigid_->empty())
    set_rigid_rates();
  else if (!ties_->empty())
    ties_->follow(nodes_);
  if (!loads_->empty()) loads_->book(nodes_, kick);
  if (relaxation_) relaxation_->watch(nodes_, *loads_, kick, previous_dt_, dt, time());
  if (rigid_->empty()) return;
  rigid_->move(nodes_, dt);
  if (!ties_->empty()) ties_->follow(nodes_);
}

// Ghosts keep the velocities that they came with: no force may look at them from here on.
void Mechanics::set_rigid_rates() {
  rigid_->set_rates(nodes_);
  if (!ties_->empty()) ties_->follow(nodes_);
}

void Mechanics::refresh_ghosts() {
  if (mesh_->comm.size() == 1) return;
  const ScopedTimer timer(*phases_.halo);
  const auto item = [](std::span<Vec3> values) {
    return ExchangeItem{reinterpret_cast<const std::byte*>(values.data()), reinterpret_cast<std::byte*>(values.data()),
                        sizeof(Vec3)};
  };
  const std::array<ExchangeItem, 2> items{item(nodes_.velocity()), item(nodes_.spin())};
  mesh_->node_halo.forward(std::span(items).first(nodes_.has_rotations() ? 2 : 1));
}

void Mechanics::drift(double dt) {
  const ScopedTimer timer(*phases_.update);
  const std::span<Vec3> position = nodes_.position();
  const std::span<const Vec3> velocity = nodes_.velocity();
  for (std::size_t n = 0; n < nodes_.size(); ++n) position[n] = position[n] + dt * velocity[n];
}

// Advances the elements over the step of length dt that ends at the present positions; forces belong to these.
void Mechanics::compute_forces(double dt) {
  const ScopedTimer timer(*phases_.forces);
  std::fill(nodes_.force.begin(), nodes_.force.end(), ForceRow{});
  std::fill(nodes_.moment.begin(), nodes_.moment.end(), ForceRow{});
  local_least_ = {std::numeric_limits<double>::infinity(), no_index};
  for (int pass = 0; pass + 1 < passes_; ++pass)
    for (const auto& group : groups_) {
      if (group->rigid || pass + 1 >= group->passes()) continue;
      group->prepare(pass, nodes_.arrays(), dt);
      exchange_nodal_values(*group);
    }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (groups_[g]->rigid) continue;
    const GroupStep found = groups_[g]->advance(nodes_.arrays(), dt);
    const double shrink = std::min(local_least_.shrink, found.shrink);
    if (found.step < local_least_.step) local_least_ = found, local_least_group_ = g;
    local_least_.shrink = shrink;
  }
  if (dt > 0) previous_dt_ = dt;
}

void Mechanics::exchange_nodal_values(ElementGroup& group) {
  if (mesh_->comm.size() == 1) return;
  const ScopedTimer timer(*phases_.halo);
  mesh_->node_halo.forward<Vec3>(group.nodal_values(), group.nodal_values());
}

// Codes of bad elements are negative, so the same reduction finds them.
void Mechanics::choose_step() {
  const ScopedTimer timer(*phases_.reduce);
  last_good_ = limit_;
  std::array<double, 2> least{local_least_.step, local_least_.shrink};
  mesh_->comm.min(std::span<double>(least));
  estimate_ = least[0];
  if (estimate_ < 0) fail(estimate_);
  if (first_estimate_ == 0) first_estimate_ = estimate_;
  if (estimate_ < options_.time_step.collapse * first_estimate_) fail(estimate_);
  limit_ = std::max(estimate_, verified_step_ * least[1]);
  if (assembled_ && search_is_due()) search_step();
  stable_step_ = std::min(options_.time_step.scale * loads_->stable_step(limit_), rigid_->stable_step());
  if (options_.time_step.maximum) stable_step_ = std::min(stable_step_, *options_.time_step.maximum);
  if (options_.time_step.fixed) stable_step_ = *options_.time_step.fixed;
  if (stable_step_ > 1.02 * limit_ && warnings_.empty())
    warnings_.push_back(
        fmt::format("{}: the time step, {:.4g} s, is {:.2f} times that which is known to be stable, {:.4g} s; this can "
                    "be unstable (time_step.fixed, time_step.scale)",
                    name(), stable_step_, stable_step_ / limit_, limit_));
}

// A search costs some forty steps. It is done again when a tenth of what it gave may be lost, at first after 500 steps,
// and half as often each time that it gained little over what the elements alone allow.
bool Mechanics::search_is_due() const {
  if (verified_step_ == 0) return true;
  return limit_ < 0.9 * verified_step_ && steps_ - searched_at_ >= search_interval_;
}

void Mechanics::search_step() {
  verified_step_ = assembled_->find(nodes_, groups_, estimate_);
  if (search_interval_ == 0)
    search_interval_ = 500;
  else if (verified_step_ < 1.1 * estimate_)
    search_interval_ *= 2;
  searched_at_ = steps_;
  limit_ = std::max(limit_, verified_step_);
  for (const auto& group : groups_) group->verify(verified_step_);
}

}  // namespace tenon

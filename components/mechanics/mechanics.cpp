// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/mechanics.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/mechanics/nodal_kick.hpp"

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
  if (loaded_ && mesh_->comm.any(any_gone())) drop_gone_masses();
  if (!loaded_) set_velocities();
  forget_steps();
  compute_forces(0, 0);
  if (!loaded_ && mesh_->comm.any(local_deaths() > 0))
    throw Error(ExitCode::usage, fmt::format("{}: erosion would take out elements of the undeformed body; expected a "
                                             "minimum_step below the stable step of each (given {:.4g} s)",
                                             name(), options_.erosion.minimum_step.value_or(0)));
  choose_step();
  if (options_.time_step.subcycling > 1 && !subcycling_) choose_levels();
  if (subcycling_) report_levels();
}

void Mechanics::advance(double dt) {
  begin_step(dt);
  end_step(dt);
}

void Mechanics::begin_step(double dt) {
  if (!subcycling_) kick(0, time(), dt);
}

void Mechanics::end_step(double dt) {
  if (subcycling_) {
    take_short_steps(dt);
    return;
  }
  forget_steps();
  finish_kick(time(), dt);
  refresh_ghosts();
  drift(0, dt);
  compute_forces(1, dt);
  finish_step(dt);
}

void Mechanics::take_short_steps(double dt) {
  const int steps = short_steps();
  const double h = dt / steps;
  for (int step = 0; step < steps; ++step) {
    forget_steps();  // all levels end a step with the last one
    take_step(step, time() + step * h, h);
    if (step + 1 < steps) stop_if_bad();
  }
  finish_step(dt);
}

void Mechanics::finish_step(double dt) {
  set_time(time() + dt);
  started_ = true;
  ++steps_;
  choose_step();
  if (subcycling_ && levels_are_due()) choose_levels();
}

ContactParty* Mechanics::contact_party() {
  if (options_.time_step.subcycling > 1)
    throw Error(ExitCode::usage, name() +
                                     ": contact needs all of its nodes in each step, and elements with longer steps of "
                                     "their own have none; use time_step.subcycling: 1");
  if (contact_) return contact_.get();
  contact_ = std::make_unique<ContactSide>(
      ContactSide::Parts{*mesh_, options_, groups_, nodes_, conditions_, *rigid_, *ties_, loose_.get(), *loads_});
  if (contact_->left_out() > 0)
    warnings_.push_back(fmt::format("{}: contact leaves out {} faces all of whose nodes are tied, or tied to", name(),
                                    contact_->left_out()));
  return contact_.get();
}

// Between the steps of the longest: as choose_step does after them.
void Mechanics::stop_if_bad() {
  const ScopedTimer timer(*phases_.reduce);
  const double least = mesh_->comm.min(local_least_.step);
  if (least < 0) fail(least);
}

void Mechanics::take_step(int step, double now, double dt) {
  kick(step, now, dt);
  finish_kick(now, dt);
  refresh_ghosts();
  drift(step, dt);
  compute_forces(step + 1, dt);
}

namespace {

void kick_vectors(std::span<Vec3> velocity, std::span<const ForceRow> force, std::span<const double> inverse_mass,
                  double kick, std::vector<double>& work) {
  for (std::size_t n = 0; n < velocity.size(); ++n) kick_node(velocity[n], force[n], inverse_mass[n], kick, work[n]);
}

}  // namespace

// Ghosts are replaced by what their owners find. Conditions correct v* and the work; loads book theirs when the
// velocities are final. Nodes of rigid bodies have the body's velocity before and after the kick, then that which takes
// them to its next place.
void Mechanics::kick(int step, double now, double dt) {
  const ScopedTimer timer(*phases_.update);
  if (relaxation_ && relaxation_->begin(nodes_)) previous_dt_ = 0;
  const double kick = kick_length(dt);
  if (!former_force_.empty()) blend_forces(dt);
  if (!loads_->empty()) loads_->apply(nodes_, groups_, now, kick);
  if (!rigid_->empty()) set_rigid_rates();
  if (!loads_->empty()) loads_->remember(nodes_);
  if (contact_) contact_->begin(kick);
  if (!ties_->empty()) ties_->gather(nodes_);
  if (!rigid_->empty()) rigid_->kick(nodes_, now, kick, dt);
  if (subcycling_) {
    subcycling_->kick(nodes_, step, kick);
  } else {
    kick_vectors(nodes_.velocity(), nodes_.force, nodes_.inverse_mass, kick, nodes_.internal_work);
    if (nodes_.has_rotations())
      kick_vectors(nodes_.spin(), nodes_.moment, nodes_.inverse_inertia, kick, nodes_.internal_work);
  }
  conditions_.apply(nodes_, now, kick, dt);
  set_bound_rates();
}

// What follows from the final velocities. The books of the kick are closed with them, and what moves on its own path
// does so.
void Mechanics::finish_kick(double now, double dt) {
  const ScopedTimer timer(*phases_.update);
  const double kick = kick_length(dt);
  if (contact_) contact_->end(dt);
  if (!loads_->empty()) loads_->book(nodes_, kick);
  if (!rigid_->empty()) rigid_->book(nodes_, kick);
  if (relaxation_) relaxation_->watch(nodes_, *loads_, kick, previous_dt_, dt, now);
  if (rigid_->empty()) return;
  rigid_->move(nodes_, dt);
  if (!ties_->empty()) ties_->follow(nodes_);
}

// The half kick that ends the step before belongs to the levels of then.
void Mechanics::blend_forces(double dt) {
  const double before = previous_dt_ / (previous_dt_ + dt), after = dt / (previous_dt_ + dt);
  const auto blend = [&](std::vector<ForceRow>& former, std::vector<ForceRow>& now) {
    for (std::size_t n = 0; n < former.size(); ++n)
      for (int c = 0; c < 3; ++c) now[n].v[c] = before * former[n].v[c] + after * now[n].v[c];
    former.clear();
  };
  blend(former_force_, nodes_.force);
  blend(former_moment_, nodes_.moment);
}

// Of nodes that have no velocity of their own.
void Mechanics::set_bound_rates() {
  if (!rigid_->empty())
    set_rigid_rates();
  else if (!ties_->empty())
    ties_->follow(nodes_);
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

void Mechanics::drift(int step, double dt) {
  const ScopedTimer timer(*phases_.update);
  if (subcycling_) {
    subcycling_->drift(nodes_, step, dt);
    return;
  }
  const std::span<Vec3> position = nodes_.position();
  const std::span<const Vec3> velocity = nodes_.velocity();
  for (std::size_t n = 0; n < nodes_.size(); ++n) position[n] = position[n] + dt * velocity[n];
}

void Mechanics::forget_steps() {
  local_least_ = {std::numeric_limits<double>::infinity(), no_index};
  local_shortest_ = local_least_.step;
}

// Advances the elements over the short step of length dt that ends at the present positions, or, of higher levels, over
// their own steps if they end there; forces belong to these positions. `step` counts from 1 within a step of the
// longest.
void Mechanics::compute_forces(int step, double dt) {
  const ScopedTimer timer(*phases_.forces);
  if (subcycling_) {
    subcycling_->clear_forces(nodes_, step);
  } else {
    std::fill(nodes_.force.begin(), nodes_.force.end(), ForceRow{});
    std::fill(nodes_.moment.begin(), nodes_.moment.end(), ForceRow{});
  }
  const int levels = subcycling_ ? subcycling_->greatest() + 1 : 1;
  for (int level = 0; level < levels; ++level) {
    const std::int64_t elements = owned_elements_[static_cast<std::size_t>(level)];
    if (!Subcycling::is_due(level, step)) {
      work_spared_ += elements;
      continue;
    }
    advance_groups(level, dt * (1 << level));
    if (dt > 0) work_done_ += elements;
  }
  if (dt > 0) previous_dt_ = dt;
}

void Mechanics::advance_groups(int level, double dt) {
  const NodeArrays arrays = subcycling_ ? subcycling_->begin(level, nodes_, dt) : nodes_.arrays();
  const auto moves = [&](std::size_t g) {
    return !groups_[g]->rigid && (!subcycling_ || subcycling_->level_of_group(g) == level);
  };
  for (int pass = 0; pass + 1 < passes_; ++pass)
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (!moves(g) || pass + 1 >= groups_[g]->passes()) continue;
      groups_[g]->prepare(pass, arrays, dt);
      exchange_nodal_values(*groups_[g]);
    }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (!moves(g)) continue;
    GroupStep found = groups_[g]->advance(arrays, dt);
    const double shrink = std::min(local_least_.shrink, found.shrink);
    local_shortest_ = std::min(local_shortest_, found.step);
    if (level > 0 && found.step > 0)  // a code is no step
      found.step *= std::min(1.0, slow_share / options_.time_step.scale) / (1 << level);
    if (found.step < local_least_.step) local_least_ = found, local_least_group_ = g;
    local_least_.shrink = shrink;
  }
  if (subcycling_) subcycling_->end(level, nodes_);
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
  const std::int64_t deaths = local_deaths();
  std::array<double, 4> least{local_least_.step, local_least_.shrink, local_shortest_, deaths != deaths_ ? 0.0 : 1.0};
  deaths_ = deaths;
  mesh_->comm.min(std::span<double>(least));
  if (least[3] == 0) follow_deaths();
  estimate_ = least[0], shortest_ = least[2];
  if (estimate_ < 0) fail(estimate_);
  if (first_estimate_ == 0) first_estimate_ = estimate_;
  if (estimate_ < options_.time_step.collapse * first_estimate_) fail(estimate_);
  limit_ = std::max(estimate_, verified_step_ * least[1]);
  if (assembled_ && search_is_due()) search_step();
  stable_step_ = short_steps() * short_step(limit_);
  warn_of_instability();
}

std::int64_t Mechanics::local_deaths() const {
  std::int64_t sum = 0;
  for (const auto& group : groups_) sum += group->deaths;
  return sum;
}

// Elements have died on some rank.
void Mechanics::follow_deaths() {
  ++death_events_;
  if (contact_) contact_->change_surface();
  if (!loose_ || options_.erosion.loose_nodes == ErosionOptions::LooseNodes::keep) return;
  loose_->remove(groups_, nodes_);
  sum_removed();
}

void Mechanics::sum_removed() {
  std::array<ExactSum, 4> sums;
  for (const LooseNodes::Removed& removed : loose_->removed()) {
    sums[0].add(removed.mass);
    for (std::size_t c = 0; c < 3; ++c) sums[1 + c].add(removed.momentum[c]);
  }
  mesh_->comm.sum(sums, removed_);
}

// What the user wants of what elements that allow `limit` allow together with everything else, s.
double Mechanics::short_step(double limit) const {
  const TimeStepOptions& options = options_.time_step;
  double step = std::min(options.scale * loads_->stable_step(limit), rigid_->stable_step());
  if (options.maximum) step = std::min(step, *options.maximum);
  return options.fixed.value_or(step);
}

void Mechanics::warn_of_instability() {
  const double stable = std::min(loads_->stable_step(limit_), rigid_->stable_step());
  const double step = stable_step_ / short_steps();
  if (warned_ || step <= 1.02 * stable) return;
  warned_ = true;
  warnings_.push_back(
      fmt::format("{}: the time step, {:.4g} s, is {:.2f} times that which is known to be stable, {:.4g} s; this can "
                  "be unstable (time_step.fixed, time_step.scale)",
                  name(), step, step / stable, stable));
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

// SPDX-License-Identifier: BSD-3-Clause
#include "components/sph/sph.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tenon {

namespace {

std::unique_ptr<Formulation> make_formulation(const SphContext& context) {
  switch (context.options.formulation) {
    case SphFormulation::fluid:
      return make_fluid(context);
    case SphFormulation::gas:
      return make_gas(context);
    case SphFormulation::solid:
      return make_solid(context);
    case SphFormulation::total_lagrangian:
      return make_total_lagrangian(context);
  }
  return nullptr;
}

double support_of(SphKernelKind kernel) {
  return kernel == SphKernelKind::quintic_spline ? 3 : 2;
}

}  // namespace

Sph::Sph(std::string name, std::shared_ptr<const Mesh> mesh, SphOptions options)
    : Component(std::move(name)), mesh_(std::move(mesh)), options_(std::move(options)) {
  refuse_misfits();
  decomposition_ = std::make_unique<ParticleDecomposition>(
      mesh_->comm, this->name(), particles_, options_.domain,
      DecompositionOptions{support_of(options_.kernel), options_.skin, options_.always_search,
                           options_.always_rebalance,
                           options_.most_neighbours.value_or(most_neighbours_of(
                               support_of(options_.kernel), options_.smoothing, options_.skin, options_.dimension))});
  const bool solid =
      options_.formulation == SphFormulation::solid || options_.formulation == SphFormulation::total_lagrangian;
  if (solid || options_.heat_conduction)
    heat_ = std::make_unique<ParticleHeat>(this->name(), options_, particles_, *decomposition_);
  formulation_ = make_formulation({mesh_->comm, this->name(), options_, particles_, *decomposition_, heat_.get()});
  forces_ = formulation_->forces();
  home_ = std::make_unique<HomeExchange>(*mesh_, particles_, this->name());
  for (const TimeFunction& g : options_.gravity) has_gravity_ = has_gravity_ || !g.is_constant() || g(0) != 0;
  for (const SphBody& body : options_.bodies) has_walls_ = has_walls_ || body.wall;
  if (has_gravity_) gravity_work_ = &particles_.add("gravity_work", ColumnKind::scalar, 1, true);
  if (has_walls_) boundary_work_ = &particles_.add("boundary_work", ColumnKind::scalar, 1, true);
  if (std::ranges::any_of(options_.bodies, [](const SphBody& body) { return body.inflow.has_value(); }))
    inflow_energy_ = &particles_.add("inflow_energy", ColumnKind::scalar, 1, true);
  if (std::ranges::any_of(options_.bodies, &SphBody::waits)) {
    debris_heat_ = &particles_.add("debris_energy", ColumnKind::scalar, 1, true);
    debris_work_ = &particles_.add("taken_from_elements", ColumnKind::scalar, 1, true);
  }
  place_particles();
}

Sph::~Sph() = default;

void Sph::refuse_misfits() const {
  if (mesh_->blocks.size() != options_.bodies.size())
    throw Error(ExitCode::usage, fmt::format("{}: the mesh has {} blocks, but {} bodies are described", name(),
                                             mesh_->blocks.size(), options_.bodies.size()));
  for (std::size_t b = 0; b < mesh_->blocks.size(); ++b)
    if (mesh_->blocks[b].kind != ElementKind::particle)
      throw Error(ExitCode::usage,
                  fmt::format("{}: block '{}' of the mesh consists of {}, not of particles; make it with `type: "
                              "particles`",
                              name(), mesh_->blocks[b].name, topology(mesh_->blocks[b].kind).name));
}

// Particles start on the rank where their node is.
void Sph::place_particles() {
  node_body_.assign(static_cast<std::size_t>(mesh_->nodes()), 0);
  for (std::size_t b = 0; b < mesh_->blocks.size(); ++b)
    for (const LocalIndex n : mesh_->blocks[b].connectivity)
      node_body_[static_cast<std::size_t>(n)] = static_cast<std::int32_t>(b);
  find_waiting();
  particles_.resize(0, 0);
  for (const LocalIndex n : mesh_->owned_nodes) {
    if (!waits_.empty() && waits_[static_cast<std::size_t>(n)] != 0) continue;
    particles_.resize(particles_.owned() + 1, 0);
    place(particles_.owned() - 1, n);
  }
}

void Sph::place(std::size_t particle, LocalIndex node) {
  const auto n = static_cast<std::size_t>(node);
  particles_.ids[particle] = mesh_->node_ids[n];
  particles_.body[particle] = node_body_[n], particles_.image[particle] = 0;
  particles_.home_rank[particle] = mesh_->comm.rank();
  particles_.home_node[particle] = node;
  const SphBody& of = options_.bodies[static_cast<std::size_t>(node_body_[n])];
  const Vec3 x = mesh_->coordinates[n];
  particles_.position.set(particle, options_.displaced ? x + options_.displaced(x) : x);
  const double density = of.initial_density ? (*of.initial_density)(0, x) : of.material.density;
  particles_.density[particle] = density;
  particles_.mass[particle] = density * mesh_->volumes[n];
  particles_.length[particle] = options_.smoothing * std::pow(mesh_->volumes[n], 1.0 / options_.dimension);
}

void Sph::set_velocities() {
  for (std::size_t i = 0; i < particles_.owned(); ++i) {
    const SphBody& body = options_.bodies[static_cast<std::size_t>(particles_.body[i])];
    const Vec3 x = mesh_->coordinates[static_cast<std::size_t>(particles_.home_node[i])];
    for (std::size_t c = 0; c < 3; ++c)
      particles_.velocity[3 * i + c] = body.wall ? body.velocity[c](time()) : body.initial_velocity[c](time(), x);
    if (!body.wall && options_.initial_velocity_function)
      particles_.velocity.set(i, particles_.velocity.vec(i) + options_.initial_velocity_function(x));
  }
}

void Sph::initialize() {
  phases_ = {&phase("forces"), &phase("update"), &phase("order and lists"), &phase("exchange")};
  if (loaded_) {
    decomposition_->arrange();
  } else {
    set_velocities();
    if (heat_) heat_->start(time());
    formulation_->start();
    decomposition_->renew();
    compute(0);
  }
  if (contact_) contact_->initialize();
  choose_step();
}

void Sph::advance(double dt) {
  begin_step(dt);
  end_step(dt);
}

void Sph::begin_step(double dt) {
  kick(dt);
  if (contact_) contact_->begin(kick_);
}

void Sph::end_step(double dt) {
  if (contact_) contact_->end();
  settle();
  drift(dt);
  {
    const ScopedTimer timer(*phases_.order);
    if (bring_in() || decomposition_->follow()) ++renewals_;
  }
  compute(dt);
  set_time(time() + dt);
  ++steps_;
  previous_dt_ = dt;
  work_done_ += static_cast<std::int64_t>(particles_.owned());
  choose_step();
}

// The first kick is half a step. Walls have the velocity that they are told, of the middle of the step.
void Sph::kick(double dt) {
  const ScopedTimer timer(*phases_.update);
  kick_ = 0.5 * (previous_dt_ + dt);
  const std::size_t owned = particles_.owned();
  double* const v = particles_.velocity.data();
  const double* const a = particles_.acceleration.data();
  std::copy_n(v, 3 * owned, particles_.former_velocity.data());
  Vec3 g{};
  for (std::size_t c = 0; c < 3; ++c) g[c] = options_.gravity[c](time());
  told_.resize(options_.bodies.size());
  for (std::size_t b = 0; b < told_.size(); ++b)
    for (std::size_t c = 0; c < 3; ++c) told_[b][c] = options_.bodies[b].velocity[c](time() + 0.5 * dt);
  for (std::size_t i = 0; i < owned; ++i) {
    if (has_walls_ && is_wall(i))
      particles_.velocity.set(i, told_[static_cast<std::size_t>(particles_.body[i])]);
    else
      for (std::size_t c = 0; c < 3; ++c) v[3 * i + c] += kick_ * (a[3 * i + c] + g[c]);
  }
}

// What the forces did in the kick, with the velocities that contact left. What acts on a wall is taken up by what moves
// it: its kinetic energy is not counted, but the work of others on it is. Velocities are carried on to x(n+1) by all
// that changed them, gravity and contact too: a particle that is held by a wall would else seem to leave it.
void Sph::settle() {
  const ScopedTimer timer(*phases_.update);
  Vec3 g{};
  for (std::size_t c = 0; c < 3; ++c) g[c] = options_.gravity[c](time());
  const Column &before = particles_.former_velocity, &after = particles_.velocity;
  for (std::size_t i = 0; i < particles_.owned(); ++i) {
    const bool wall = has_walls_ && is_wall(i);
    const Vec3 way = 0.5 * kick_ * (before.vec(i) + after.vec(i));
    for (const ForcePart& force : forces_) {
      const double work = particles_.mass[i] * dot(force.acceleration->vec(i), way);
      if (force.energy) (*force.energy)[i] -= work;
      if (wall) (*boundary_work_)[i] -= work;
    }
    if (has_gravity_ && !wall) (*gravity_work_)[i] += particles_.mass[i] * dot(g, way);
  }
  formulation_->settle(kick_);
  const std::size_t count = 3 * particles_.owned();
  for (std::size_t k = 0; k < count; ++k) particles_.acceleration[k] = (after[k] - before[k]) / kick_;
}

void Sph::drift(double dt) {
  const ScopedTimer timer(*phases_.update);
  const double* const v = formulation_->transport() ? formulation_->transport()->data() : particles_.velocity.data();
  double* const x = particles_.position.data();
  const std::size_t count = 3 * particles_.owned();
  for (std::size_t k = 0; k < count; ++k) x[k] += dt * v[k];
}

void Sph::compute(double dt) {
  const ScopedTimer timer(*phases_.forces);
  if (heat_ && dt > 0) heat_->advance(time(), dt);
  formulation_->compute(time() + dt, dt);
  if (heat_) heat_->compute();
}

Formulation::Limit Sph::stable_limit() const {
  const Formulation::Limit waves = formulation_->stable_step();
  if (!heat_) return waves;
  const Formulation::Limit heat = heat_->stable_step();
  return heat.dt < waves.dt ? heat : waves;
}

void Sph::choose_step() {
  Formulation::Limit limit = stable_limit();
  std::size_t bad = particles_.owned();
  for (std::size_t i = 0; i < particles_.owned() && bad == particles_.owned(); ++i) {
    const Vec3 x = particles_.position.vec(i), a = particles_.acceleration.vec(i);
    if (!std::isfinite(x[0] + x[1] + x[2]) || !std::isfinite(a[0] + a[1] + a[2])) bad = i;
  }
  if (bad < particles_.owned()) limit = {-1, bad};
  const double least = mesh_->comm.min(limit.dt);
  if (least < 0) fail("is not a number any more", bad);
  if (options_.time_step.fixed)
    stable_step_ = *options_.time_step.fixed;
  else
    stable_step_ = options_.time_step.maximum ? std::min(least, *options_.time_step.maximum) : least;
}

// Of several ranks that fail the one with the least id speaks.
void Sph::fail(const std::string& what, std::size_t particle) {
  const bool mine = particle < particles_.owned();
  const std::int64_t id = mine ? particles_.ids[particle] : std::numeric_limits<std::int64_t>::max();
  const std::int64_t first = mesh_->comm.min(id);
  std::optional<Error> error;
  if (mine && id == first)
    error.emplace(ExitCode::unstable,
                  fmt::format("{}: {} {} at t = {:.6g} s; take a smaller time_step.cfl, and look at the last frame for "
                              "particles that overlap or meet too fast",
                              name(), describe(particle), what, time()));
  mesh_->comm.throw_if_any(error);
  throw Error(ExitCode::unstable, name() + ": a particle " + what);
}

std::string Sph::describe(std::size_t particle) const {
  const Vec3 x = particles_.reference.vec(particle);
  return fmt::format("particle {} of {} near ({:.4g}, {:.4g}, {:.4g})", particles_.ids[particle] + 1,
                     options_.bodies[static_cast<std::size_t>(particles_.body[particle])].name, x[0], x[1], x[2]);
}

StepLimiter Sph::limiter() {
  if (options_.time_step.fixed) return {stable_step_, "time_step.fixed"};
  const Formulation::Limit limit = stable_limit();
  const double least = mesh_->comm.min(limit.dt);
  const bool mine = limit.dt == least && particles_.owned() > 0;
  const std::int64_t first =
      mesh_->comm.min(mine ? particles_.ids[limit.particle] : std::numeric_limits<std::int64_t>::max());
  std::string reason = mine && particles_.ids[limit.particle] == first ? describe(limit.particle) : "";
  const auto root = static_cast<int>(
      mesh_->comm.min(static_cast<std::int64_t>(reason.empty() ? mesh_->comm.size() : mesh_->comm.rank())));
  if (root < mesh_->comm.size()) mesh_->comm.broadcast(reason, root);
  return {stable_step_, stable_step_ < least ? "time_step.maximum" : reason};
}

ContactParty* Sph::contact_party() {
  if (contact_) return contact_.get();
  contact_ = std::make_unique<ParticleContact>(
      ParticleContact::Parts{*mesh_, options_, particles_, *decomposition_, *home_, [this] {
                               decomposition_->renew();
                               compute(0);
                               choose_step();
                             }});
  return contact_.get();
}

}  // namespace tenon

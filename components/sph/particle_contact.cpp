// SPDX-License-Identifier: BSD-3-Clause
#include "components/sph/particle_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tenon {

// What was sought is of no kind that mirrors and periods change: a particle that jumps from one end of space to the
// other has left its skin.
ParticleContact::ParticleContact(const Parts& parts)
    : parts_(parts), sought_(parts.particles.add("contact_skin", ColumnKind::scalar, 4, true)) {
  sought_.saved = false;  // the way since the last search; a restart searches anew
  const auto nodes = static_cast<std::size_t>(parts_.mesh.nodes());
  surface_.assign(nodes, -1);
  find_surfaces();
  for (std::vector<double>* const array : {&inverse_mass_, &radius_, &work_}) array->resize(nodes);
  for (std::vector<Vec3>* const array : {&position_, &velocity_, &former_, &impulse_}) array->resize(nodes);
}

// Walls do not touch, nor does what has yet to come in.
void ParticleContact::find_surfaces() {
  const std::size_t owned = parts_.particles.owned();
  const std::vector<double> bodies(parts_.particles.body.begin(),
                                   parts_.particles.body.begin() + static_cast<std::ptrdiff_t>(owned));
  std::vector<double> of_nodes(surface_.size(), -1);
  parts_.home.to_nodes(parts_.decomposition.version(), bodies, of_nodes, 1);
  for (const LocalIndex n : parts_.mesh.owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    const auto body = static_cast<std::int32_t>(of_nodes[i]);
    surface_[i] = body >= 0 && !parts_.options.bodies[static_cast<std::size_t>(body)].wall ? body : -1;
  }
}

std::vector<std::string> ParticleContact::surface_names() const {
  std::vector<std::string> names;
  for (const ElementBlock& block : parts_.mesh.blocks) names.push_back(block.name);
  return names;
}

// Half the spacing at the start, so that bodies in contact are as far apart as particles of one body.
void ParticleContact::contact_particles(std::vector<ContactParticle>& particles) const {
  particles.clear();
  for (const LocalIndex n : parts_.mesh.owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    if (surface_[i] < 0) continue;
    const double spacing = std::pow(parts_.mesh.volumes[i], 1.0 / parts_.options.dimension);
    particles.push_back({n, 0.5 * spacing, surface_[i]});
  }
}

double ParticleContact::effusivity(std::int32_t surface) const {
  const MaterialDescription& material = parts_.options.bodies[static_cast<std::size_t>(surface)].material;
  if (!material.thermal) return 0;
  return std::sqrt(material.thermal->conductivity * material.density * material.thermal->specific_heat);
}

void ParticleContact::watch(std::span<const LocalIndex> nodes) {
  watched_.assign(nodes.begin(), nodes.end());
  watched_former_.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto n = static_cast<std::size_t>(nodes[i]);
    watched_former_[i] = former_[n];
    impulse_[n] = {};  // of an earlier step, if it was not watched meanwhile
  }
}

void ParticleContact::bring(const Column& column, std::vector<Vec3>& nodes) {
  const std::span<const double> values(column.data(), 3 * parts_.particles.owned());
  parts_.home.to_nodes(parts_.decomposition.version(), values, {nodes.data()->data(), 3 * nodes.size()}, 3);
}

// Places and both velocities in one message. What has yet to come in stays at nothing.
void ParticleContact::bring_all() {
  const ParticleData& p = parts_.particles;
  const std::size_t owned = p.owned();
  const std::array<const Column*, 3> columns{&p.position, &p.velocity, &p.former_velocity};
  leaving_.resize(9 * owned), arrived_.resize(9 * position_.size());
  for (std::size_t i = 0; i < owned; ++i)
    for (std::size_t k = 0; k < 3; ++k) std::copy_n(columns[k]->data() + 3 * i, 3, &leaving_[9 * i + 3 * k]);
  parts_.home.to_nodes(parts_.decomposition.version(), leaving_, arrived_, 9);
  const std::array<std::vector<Vec3>*, 3> nodes{&position_, &velocity_, &former_};
  for (const LocalIndex n : parts_.mesh.owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    for (std::size_t k = 0; k < 3; ++k) std::copy_n(&arrived_[9 * i + 3 * k], 3, (*nodes[k])[i].data());
  }
}

void ParticleContact::initialize() {
  find_surfaces();
  const std::span<const double> mass(parts_.particles.mass.data(), parts_.particles.owned());
  parts_.home.to_nodes(parts_.decomposition.version(), mass, inverse_mass_, 1);
  for (const LocalIndex n : parts_.mesh.owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    inverse_mass_[i] = surface_[i] < 0 ? 0 : 1 / inverse_mass_[i];
  }
  bring(parts_.particles.position, position_);
  bring(parts_.particles.velocity, velocity_);
  former_ = velocity_;
}

void ParticleContact::begin(double kick) {
  kick_ = kick;
  pushed_ = false;
  if (resting_) return;
  ++times_home_;
  bring_all();
  for (std::size_t i = 0; i < watched_.size(); ++i) {
    const auto n = static_cast<std::size_t>(watched_[i]);
    watched_former_[i] = former_[n];
    impulse_[n] = {};
  }
}

// What is outside of the space of the particles (z of two dimensions) does not move: a layer between a face and its own
// particles would buckle out of the plane.
Vec3 ParticleContact::within(const Vec3& a) const {
  return {a[0], parts_.options.dimension > 1 ? a[1] : 0, parts_.options.dimension > 2 ? a[2] : 0};
}

void ParticleContact::mobilities(std::span<const LocalIndex> nodes, std::span<Mobility> mobility) const {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double w = inverse_mass_[static_cast<std::size_t>(nodes[i])];
    const Vec3 along = within({w, w, w});
    mobility[i] = {{along[0], along[1], along[2], 0, 0, 0}, -1};
  }
}

// As it is known at the end what the velocity becomes, earlier impulses of the step get their share of each change.
void ParticleContact::push(std::span<const LocalIndex> nodes, std::span<const Vec3> impulses,
                           std::span<const BodyImpulse>) {
  pushed_ = true;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto n = static_cast<std::size_t>(nodes[i]);
    const Vec3 dv = inverse_mass_[n] * within(impulses[i]);
    velocity_[n] = velocity_[n] + dv;
    work_[n] += 0.5 * dot(impulses[i], former_[n] + velocity_[n]) + 0.5 * dot(impulse_[n], dv);
    impulse_[n] = impulse_[n] + impulses[i];
  }
}

// All ranks push, or none.
void ParticleContact::end() {
  if (!pushed_) return;
  ++times_back_;
  const std::size_t owned = parts_.particles.owned();
  parts_.home.to_particles(parts_.decomposition.version(), {velocity_.data()->data(), 3 * velocity_.size()},
                           std::span(parts_.particles.velocity.values).first(3 * owned), 3);
}

void ParticleContact::shift(std::span<const LocalIndex> nodes, std::span<const Vec3> by) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto n = static_cast<std::size_t>(nodes[i]);
    position_[n] = position_[n] + within(by[i]);
  }
  const std::size_t owned = parts_.particles.owned();
  parts_.home.to_particles(parts_.decomposition.version(), {position_.data()->data(), 3 * position_.size()},
                           std::span(parts_.particles.position.values).first(3 * owned), 3);
  parts_.moved();
}

ExactSum ParticleContact::contact_work() const {
  ExactSum sum;
  for (const LocalIndex n : parts_.mesh.owned_nodes) sum.add(work_[static_cast<std::size_t>(n)]);
  return sum;
}

ContactFields& ParticleContact::contact_fields() {
  if (!fields_) {
    const auto size = static_cast<std::size_t>(parts_.mesh.nodes());
    fields_ = std::make_unique<ContactFields>();
    fields_->force.resize(size), fields_->slip.resize(size);
    fields_->gap.assign(size, std::numeric_limits<double>::infinity());
    fields_->status.resize(size), fields_->pressure.resize(size), fields_->friction_heat.resize(size);
  }
  return *fields_;
}

void ParticleContact::rest(std::span<const double> inverse_square) {
  std::vector<double> nodes(4 * position_.size());
  for (const LocalIndex n : parts_.mesh.owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    std::copy_n(position_[i].data(), 3, &nodes[4 * i]);
    nodes[4 * i + 3] = inverse_square[i];
  }
  parts_.home.to_particles(parts_.decomposition.version(), nodes,
                           std::span(sought_.values).first(4 * parts_.particles.owned()), 4);
  resting_ = true;
}

double ParticleContact::used_squared(const Vec3& before, const Vec3& step, double dt) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const ParticleData& p = parts_.particles;
  double greatest = 0;
  for (std::size_t i = 0; i < p.owned(); ++i) {
    const double* const sought = sought_.data() + 4 * i;
    if (sought[3] == 0) continue;
    const Vec3 moved = p.position.vec(i) - Vec3{sought[0], sought[1], sought[2]} - before;
    const Vec3 then = moved + (dt * p.velocity.vec(i) - step);
    const double share = std::max(dot(then, then), dot(moved, moved)) * sought[3];
    if (!(share < infinity)) return infinity;
    greatest = std::max(greatest, share);
  }
  return greatest;
}

void ParticleContact::show() {
  if (!resting_) return;
  resting_ = false;
  ++times_home_;
  bring_all();
}

std::int64_t ParticleContact::memory() const {
  return static_cast<std::int64_t>(position_.size() * (4 * sizeof(Vec3) + 4 * sizeof(double)));
}

}  // namespace tenon

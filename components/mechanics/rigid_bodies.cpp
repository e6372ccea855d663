// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/rigid_bodies.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/mechanics/nodal_damping.hpp"

namespace tenon {

using Rotation = RigidBody::Rotation;

namespace {

bool has_axis(const RigidBody& options) {
  return options.rotation == Rotation::hinge || options.rotation == Rotation::prescribed;
}

}  // namespace

Vec3 RigidBodies::spin(const Body& body) const {
  if (has_axis(body.options)) return body.rate * body.options.axis;
  return body.options.rotation == Rotation::fixed ? Vec3{} : angular_velocity(body.inertia, body.state);
}

Vec3 RigidBodies::velocity_at(const Body& body, const Vec3& place) const {
  return body.state.velocity + cross(spin(body), place - body.state.pivot);
}

void RigidBodies::bound_inverse_mass(std::span<double> inverse_mass) const {
  for (const Held& held : held_) {
    const Body& body = bodies_[static_cast<std::size_t>(held.body)];
    const Vec3 arm = mesh_.coordinates[static_cast<std::size_t>(held.node)] - body.reference_pivot;
    inverse_mass[static_cast<std::size_t>(held.node)] =
        1 / body.inertia.mass + dot(arm, arm) * trace(body.inertia.inverse);
  }
}

double RigidBodies::stable_step() const {
  double fastest = 0;
  for (const Body& body : bodies_) fastest = std::max(fastest, norm(spin(body)));
  return fastest > 0 ? greatest_turn / fastest : std::numeric_limits<double>::infinity();
}

void RigidBodies::set_rates(NodalState& nodes) const {
  for (const Held& held : held_) {
    const auto n = static_cast<std::size_t>(held.node);
    const Body& body = bodies_[static_cast<std::size_t>(held.body)];
    nodes.velocity()[n] = velocity_at(body, nodes.position()[n]);
    if (nodes.has_rotations()) nodes.spin()[n] = spin(body);
  }
}

void RigidBodies::kick(NodalState& nodes, double time, double kick, double dt) {
  for (ExactSum& sum : sums_) sum.clear();
  for (std::size_t i = 0; i < held_.size(); ++i) {
    const auto n = static_cast<std::size_t>(held_[i].node);
    const auto b = static_cast<std::size_t>(held_[i].body);
    const Vec3 f{-nodes.force[n].v[0], -nodes.force[n].v[1], -nodes.force[n].v[2]};
    const Vec3 moment = cross(nodes.position()[n] - bodies_[b].state.pivot, f);
    rates_before_[i] = velocity_at(bodies_[b], nodes.position()[n]);
    force_[i] = nodes.force[n];
    for (std::size_t c = 0; c < 3; ++c) {
      sums_[6 * b + c].add(f[c]), sums_[6 * b + 3 + c].add(moment[c]);
      if (nodes.has_rotations()) sums_[6 * b + 3 + c].add(-nodes.moment[n].v[c]);
    }
    nodes.force[n] = {};
    if (!nodes.has_rotations()) continue;
    moment_[i] = nodes.moment[n];
    nodes.moment[n] = {};
  }
  mesh_.comm.sum(sums_, totals_);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const double* t = totals_.data() + 6 * b;
    bodies_[b].velocity_before = bodies_[b].state.velocity, bodies_[b].spin_before = spin(bodies_[b]);
    bodies_[b].lost = bodies_[b].lost_spin = {}, bodies_[b].pushed = {};
    kick_body(bodies_[b], {t[0], t[1], t[2]}, {t[3], t[4], t[5]}, time, kick, dt);
  }
}

void RigidBodies::book(NodalState& nodes, double kick) const {
  for (std::size_t i = 0; i < held_.size(); ++i) {
    const auto n = static_cast<std::size_t>(held_[i].node);
    const Body& body = bodies_[static_cast<std::size_t>(held_[i].body)];
    const Vec3 sum = rates_before_[i] + velocity_at(body, nodes.position()[n]);
    const double* f = force_[i].v;
    nodes.internal_work[n] += 0.5 * kick * (f[0] * sum[0] + f[1] * sum[1] + f[2] * sum[2]);
    if (!nodes.has_rotations()) continue;
    const Vec3 turn = body.spin_before + spin(body);
    const double* m = moment_[i].v;
    nodes.internal_work[n] += 0.5 * kick * (m[0] * turn[0] + m[1] * turn[1] + m[2] * turn[2]);
  }
}

void RigidBodies::kick_body(Body& body, const Vec3& force, const Vec3& moment, double time, double kick,
                            double dt) const {
  if (!body.options.joint) push(body, force, time, kick, dt);
  turn(body, moment, time, kick, dt);
}

// From M (V+ - V-) = kick (F - alpha M (V- + V+)/2) follows (1 + c) V = V- + kick F/(2M) for the mean V, c = alpha
// kick/2.
void RigidBodies::push(Body& body, const Vec3& force, double time, double kick, double dt) const {
  const double mass = body.inertia.mass, c = 0.5 * kick * damping_;
  for (std::size_t i = 0; i < 3; ++i) {
    double& v = body.state.velocity[i];
    const double before = v, impulse = kick * force[i];
    const auto& given = body.options.prescribed_velocity[i];
    if (given)
      v = (*given)(time + 0.5 * dt);
    else if (c == 0)
      v += impulse / mass;
    else
      v = (2 * before + impulse / mass) / (1 + c) - before;
    const double mean = 0.5 * (before + v), lost = 2 * c * mass * mean;  // kg m/s
    body.damped += lost * mean, body.lost[i] = lost;
    if (given) body.work += (mass * (v - before) - impulse + lost) * mean;
  }
}

void RigidBodies::turn(Body& body, const Vec3& moment, double time, double kick, double dt) const {
  const double c = 0.5 * kick * damping_;
  if (body.options.rotation == Rotation::free) {
    Vec3& momentum = body.state.momentum;
    if (c == 0) {
      momentum = momentum + kick * moment;
      return;
    }
    const Vec3 before = momentum, rate = spin(body);
    momentum = (1 / (1 + c)) * (2.0 * before + kick * moment) - before;
    body.lost_spin = c * (before + momentum);
    body.damped += 2 * c * dot(0.5 * (before + momentum), 0.5 * (rate + spin(body)));
  }
  if (!has_axis(body.options)) return;
  const double before = body.rate, impulse = kick * dot(moment, body.options.axis);
  const bool prescribed = body.options.rotation == Rotation::prescribed;
  if (prescribed)
    body.rate = (body.options.angle(time + dt) - body.state.angle) / dt;
  else if (c == 0)
    body.rate += impulse / body.axial_inertia;
  else
    body.rate = (2 * before + impulse / body.axial_inertia) / (1 + c) - before;
  const double mean = 0.5 * (before + body.rate), lost = 2 * c * body.axial_inertia * mean;
  body.damped += lost * mean, body.lost_spin = lost * body.options.axis;
  if (prescribed) body.work += (body.axial_inertia * (body.rate - before) - impulse + lost) * mean;
}

void RigidBodies::move(NodalState& nodes, double dt) {
  for (Body& body : bodies_) {
    RigidState& s = body.state;
    s.pivot = s.pivot + dt * s.velocity;
    if (body.options.rotation == Rotation::free) spin_freely(body.inertia, s, dt);
    if (!has_axis(body.options)) continue;
    s.angle += dt * body.rate;
    s.orientation = rotation_by(s.angle * body.options.axis);
  }
  for (const Held& held : held_) {
    const auto n = static_cast<std::size_t>(held.node);
    const Body& body = bodies_[static_cast<std::size_t>(held.body)];
    const Vec3 place = body.state.pivot + rotate(body.state.orientation, mesh_.coordinates[n] - body.reference_pivot);
    nodes.velocity()[n] = (1 / dt) * (place - nodes.position()[n]);
  }
}

std::vector<ContactRigidBody> RigidBodies::contact_bodies() const {
  std::vector<ContactRigidBody> result;
  for (const Body& body : bodies_) {
    ContactRigidBody& b = result.emplace_back();
    b.pivot = body.state.pivot;
    b.velocity = body.state.velocity, b.spin = spin(body);
    b.former_velocity = body.velocity_before, b.former_spin = body.spin_before;
    for (std::size_t i = 0; i < 3; ++i)
      b.inverse_mass[i] = body.options.joint || body.options.prescribed_velocity[i] ? 0 : 1 / body.inertia.mass;
    for (std::size_t j = 0; j < 3; ++j) {
      Vec3 unit{}, column{};
      unit[j] = 1;
      const Quaternion& q = body.state.orientation;
      const Vec3& axis = body.options.axis;
      if (body.options.rotation == Rotation::free)
        column = rotate(q, times(body.inertia.inverse, rotate_back(q, unit)));
      if (body.options.rotation == Rotation::hinge) column = (axis[j] / body.axial_inertia) * axis;
      for (std::size_t i = 0; i < 3; ++i) b.inverse_inertia[3 * i + j] = column[i];
    }
  }
  return result;
}

// What is prescribed stays as it is: there the reaction takes up the impulse.
double RigidBodies::push(std::span<const BodyImpulse> impulses) {
  double work = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& body = bodies_[b];
    const BodyImpulse& p = impulses[b];
    const Vec3 velocity = body.state.velocity, turn = spin(body);
    for (std::size_t i = 0; i < 3; ++i)
      if (!body.options.joint && !body.options.prescribed_velocity[i])
        body.state.velocity[i] += p.linear[i] / body.inertia.mass;
    if (body.options.rotation == Rotation::free) body.state.momentum = body.state.momentum + p.angular;
    if (body.options.rotation == Rotation::hinge) body.rate += dot(p.angular, body.options.axis) / body.axial_inertia;
    const Vec3 dv = body.state.velocity - velocity, dw = spin(body) - turn;
    const Vec3 mean = 0.5 * (body.velocity_before + body.state.velocity), rate = 0.5 * (body.spin_before + spin(body));
    work += dot(p.linear, mean) + dot(p.angular, rate);
    work += 0.5 * (dot(body.pushed.linear, dv) + dot(body.pushed.angular, dw));
    body.damped += 0.5 * (dot(body.lost, dv) + dot(body.lost_spin, dw));
    for (std::size_t i = 0; i < 3; ++i)
      if (body.options.prescribed_velocity[i]) body.work -= p.linear[i] * mean[i];
    if (body.options.rotation == Rotation::prescribed) body.work -= dot(p.angular, rate);
    body.pushed = {body.pushed.linear + p.linear, body.pushed.angular + p.angular};
  }
  return work;
}

double RigidBodies::kinetic_energy() const {
  double sum = 0;
  for (const Body& body : bodies_) {
    const Vec3 v = body.state.velocity;
    sum += 0.5 * body.inertia.mass * (body.options.joint ? 0 : dot(v, v));
    if (body.options.rotation == Rotation::free)
      sum += 0.5 * dot(angular_velocity(body.inertia, body.state), body.state.momentum);
    if (has_axis(body.options)) sum += 0.5 * body.axial_inertia * body.rate * body.rate;
  }
  return sum;
}

double RigidBodies::work() const {
  double sum = 0;
  for (const Body& body : bodies_) sum += body.work;
  return sum;
}

double RigidBodies::damped() const {
  double sum = 0;
  for (const Body& body : bodies_) sum += body.damped;
  return sum;
}

bool RigidBodies::has_prescribed() const {
  return std::ranges::any_of(bodies_, [](const Body& body) {
    return body.options.rotation == Rotation::prescribed ||
           std::ranges::any_of(body.options.prescribed_velocity, [](const auto& f) { return f.has_value(); });
  });
}

std::vector<double*> RigidBodies::numbers(Body& body) {
  RigidState& s = body.state;
  std::vector<double*> all{&s.angle, &body.rate, &body.work, &body.damped};
  for (Vec3* v : {&s.pivot, &s.velocity, &s.momentum})
    for (double& x : *v) all.push_back(&x);
  for (double& x : s.orientation) all.push_back(&x);
  return all;
}

void RigidBodies::save(CheckpointWriter& file, const std::string& prefix) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body copy = bodies_[b];
    const std::vector<double*> values = numbers(copy);
    for (std::size_t i = 0; i < values.size(); ++i) file.scalar(fmt::format("{}.{}.{}", prefix, b, i), *values[i]);
  }
}

void RigidBodies::load(const CheckpointReader& file, const std::string& prefix) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const std::vector<double*> values = numbers(bodies_[b]);
    for (std::size_t i = 0; i < values.size(); ++i) *values[i] = file.scalar(fmt::format("{}.{}.{}", prefix, b, i));
  }
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Nodes, mass properties and initial motion of rigid bodies.
#include <fmt/core.h>

#include <algorithm>

#include "components/mechanics/nodal_damping.hpp"
#include "components/mechanics/rigid_bodies.hpp"
#include "components/mechanics/rigid_inertia.hpp"

namespace tenon {

namespace {

/// m (r.r 1 - r r), term by term into six sums.
void add_inertia(std::span<ExactSum> sums, double mass, const Vec3& r) {
  const double xx = mass * r[0] * r[0], yy = mass * r[1] * r[1], zz = mass * r[2] * r[2];
  for (const auto& [at, value] : {std::pair(0u, yy), {0u, zz}, {1u, zz}, {1u, xx}, {2u, xx}, {2u, yy}})
    sums[at].add(value);
  sums[3].add(-mass * r[0] * r[1]), sums[4].add(-mass * r[1] * r[2]), sums[5].add(-mass * r[2] * r[0]);
}

SymmetricTensor<double> as_tensor(std::span<const double> v) {
  return {v[0], v[1], v[2], v[3], v[4], v[5]};
}

}  // namespace

RigidBodies::RigidBodies(const Mesh& mesh, const std::vector<RigidBody>& bodies, const ElementGroups& groups,
                         NodalState& nodes, double damping)
    : mesh_(mesh),
      damping_(damping),
      body_of_(bodies.empty() ? 0 : nodes.size(), -1),
      sums_(6 * bodies.size()),
      totals_(6 * bodies.size()) {
  for (const RigidBody& options : bodies) {
    Body body;
    body.options = options;
    body.options.axis = (1 / norm(options.axis)) * options.axis;
    bodies_.push_back(std::move(body));
  }
  if (bodies_.empty()) return;
  find_nodes(groups);
  find_inertia(groups, nodes);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (body_of_[n] < 0) continue;
    nodes.mass[n] = nodes.inverse_mass[n] = 0;
    if (nodes.has_rotations()) nodes.inertia[n] = nodes.inverse_inertia[n] = 0;
  }
  rates_before_.resize(held_.size()), force_.resize(held_.size());
  if (nodes.has_rotations()) moment_.resize(held_.size());
}

void RigidBodies::find_nodes(const ElementGroups& groups) {
  std::optional<Error> error;
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    for (const std::string& name : bodies_[b].options.blocks) {
      const auto group = std::ranges::find(groups, name, [](const auto& g) { return g->elements().name; });
      if (group == groups.end())
        throw Error(ExitCode::usage, fmt::format("{}: the mesh has no block '{}'", bodies_[b].options.label, name));
      for (const LocalIndex node : (*group)->elements().connectivity) {
        std::int32_t& body = body_of_[static_cast<std::size_t>(node)];
        if (body >= 0 && body != static_cast<std::int32_t>(b) && !error)
          error = Error(ExitCode::usage,
                        fmt::format("{} and {} share node {}; make one body of both, or separate their meshes",
                                    bodies_[static_cast<std::size_t>(body)].options.label, bodies_[b].options.label,
                                    mesh_.node_labels[static_cast<std::size_t>(node)]));
        body = static_cast<std::int32_t>(b);
      }
    }
  mesh_.comm.throw_if_any(error);
  for (const LocalIndex n : mesh_.owned_nodes)
    if (holds(n)) held_.push_back({n, body_of_[static_cast<std::size_t>(n)]});
}

/// visit(body, mass, place, moment of inertia of the point itself): the elements of the bodies, and the masses that
/// deformable neighbours bring to their nodes.
template <typename Visit>
void RigidBodies::for_points(const ElementGroups& groups, const NodalState& nodes, Visit visit) const {
  for (const auto& group : groups) {
    if (!group->rigid || group->size() == 0) continue;
    for (LocalIndex e = 0; e < group->size(); ++e) {
      if (group->elements().owners[static_cast<std::size_t>(e)] != mesh_.comm.rank()) continue;
      const auto body = static_cast<std::size_t>(body_of_[static_cast<std::size_t>(group->elements().nodes(e)[0])]);
      for_mass_points(*group, e, mesh_.coordinates,
                      [&](double mass, const Vec3& place, std::span<const double>) { visit(body, mass, place, 0.0); });
    }
  }
  for (const Held& held : held_) {
    const auto n = static_cast<std::size_t>(held.node);
    visit(static_cast<std::size_t>(held.body), nodes.mass[n], mesh_.coordinates[n],
          nodes.has_rotations() ? nodes.inertia[n] : 0.0);
  }
}

void RigidBodies::find_inertia(const ElementGroups& groups, NodalState& nodes) {
  std::vector<ExactSum> sums(4 * bodies_.size());
  for_points(groups, nodes, [&](std::size_t b, double mass, const Vec3& place, double) {
    sums[4 * b].add(mass);
    for (std::size_t c = 0; c < 3; ++c) sums[4 * b + 1 + c].add(mass * place[c]);
  });
  std::vector<double> total(sums.size());
  mesh_.comm.sum(sums, total);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const double* t = total.data() + 4 * b;
    Body& body = bodies_[b];
    if (!(t[0] > 0)) throw Error(ExitCode::usage, body.options.label + ": has no mass; expected blocks with elements");
    body.inertia.mass = t[0];
    body.reference_pivot = body.options.joint.value_or((1 / t[0]) * Vec3{t[1], t[2], t[3]});
    body.state.pivot = body.reference_pivot;
  }
  std::vector<ExactSum> second(6 * bodies_.size());
  for_points(groups, nodes, [&](std::size_t b, double mass, const Vec3& place, double own) {
    const std::span<ExactSum> six = std::span(second).subspan(6 * b, 6);
    add_inertia(six, mass, place - bodies_[b].reference_pivot);
    for (std::size_t c = 0; c < 3; ++c) six[c].add(own);
  });
  total.resize(second.size());
  mesh_.comm.sum(second, total);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& body = bodies_[b];
    body.inertia.inertia = as_tensor(std::span<const double>(total).subspan(6 * b, 6));
    body.inertia.inverse = inverted(body.inertia.inertia, body.options.label);
    body.axial_inertia = dot(body.options.axis, times(body.inertia.inertia, body.options.axis));
  }
}

// The rigid motion that has the same momentum and moment of momentum as the nodes, each with unit mass: exact if their
// velocities are those of a rigid motion.
void RigidBodies::start(NodalState& nodes, double time) {
  std::vector<ExactSum> sums(7 * bodies_.size()), second(9 * bodies_.size());
  std::vector<double> total(sums.size()), moments(second.size());
  const auto each = [&](const auto& visit) {
    for (const Held& held : held_)
      visit(static_cast<std::size_t>(held.body), nodes.position()[static_cast<std::size_t>(held.node)],
            nodes.velocity()[static_cast<std::size_t>(held.node)]);
  };
  each([&](std::size_t b, const Vec3& x, const Vec3& v) {
    sums[7 * b].add(1);
    for (std::size_t c = 0; c < 3; ++c) sums[7 * b + 1 + c].add(x[c]), sums[7 * b + 4 + c].add(v[c]);
  });
  mesh_.comm.sum(sums, total);
  const auto mean = [&](std::size_t b, std::size_t first) {
    const double* t = total.data() + 7 * b;
    return (1 / t[0]) * Vec3{t[first], t[first + 1], t[first + 2]};
  };
  each([&](std::size_t b, const Vec3& x, const Vec3& v) {
    const Vec3 arm = x - mean(b, 1), moment = cross(arm, v - mean(b, 4));
    for (std::size_t c = 0; c < 3; ++c) second[9 * b + c].add(moment[c]);
    add_inertia(std::span(second).subspan(9 * b + 3, 6), 1, arm);
  });
  mesh_.comm.sum(second, moments);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& body = bodies_[b];
    const double* m = moments.data() + 9 * b;
    const SymmetricTensor<double> inertia = as_tensor(std::span<const double>(moments).subspan(9 * b + 3, 6));
    const Vec3 found = times(inverted(inertia, body.options.label), {m[0], m[1], m[2]});
    const Vec3 spin = body.options.spin.value_or(found);
    const Vec3 moved = mean(b, 4) + cross(found, body.state.pivot - mean(b, 1));
    body.state.velocity = body.options.joint ? Vec3{} : body.options.velocity.value_or(moved);
    for (std::size_t c = 0; c < 3; ++c)
      if (const auto& given = body.options.prescribed_velocity[c]) body.state.velocity[c] = (*given)(time);
    body.rate = dot(spin, body.options.axis);
    body.state.momentum = angular_momentum(body.inertia, body.state, spin);
  }
  set_rates(nodes);
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/rotation_conditions.hpp"

#include <cmath>

namespace tenon {

namespace {

using Kind = PrescribedMotion::Kind;

Vec3 axis(std::size_t c) {
  Vec3 e{};
  e[c] = 1;
  return e;
}

/// Directions in which a motion holds spins.
std::vector<Vec3> held(const PrescribedMotion& m) {
  std::vector<Vec3> directions;
  const Vec3 n = (1 / norm(m.normal)) * m.normal;
  // In a plane of symmetry the axis that is least along the normal, first.
  std::size_t least = 0;
  for (std::size_t c = 1; c < 3; ++c)
    if (std::abs(n[c]) < std::abs(n[least])) least = c;
  if (m.kind == Kind::symmetry) {
    const Vec3 across = cross(n, axis(least));
    directions = {(1 / norm(across)) * across, cross(n, (1 / norm(across)) * across)};
  }
  for (std::size_t c = 0; c < 3; ++c)
    if (m.kind == Kind::rotation || (m.kind == Kind::fixed && m.rotations[c])) directions.push_back(axis(c));
  return directions;
}

}  // namespace

RotationConditions::RotationConditions(const Mesh& mesh, const std::vector<PrescribedMotion>& motions)
    : motions_(motions), target_(motions.size()) {
  std::vector<std::int32_t> index(static_cast<std::size_t>(mesh.nodes()), -1);
  for (std::size_t m = 0; m < motions_.size(); ++m) {
    const std::vector<Vec3> directions = held(motions_[m]);
    if (directions.empty()) continue;
    for (const std::string& name : motions_[m].node_sets) {
      const NodeSet* set = mesh.find_node_set(name);
      if (!set) continue;  // NodalConditions has told
      for (const LocalIndex n : set->nodes) {
        if (!mesh.owns_node(n)) continue;
        std::int32_t& i = index[static_cast<std::size_t>(n)];
        if (i < 0) {
          i = static_cast<std::int32_t>(entries_.size());
          entries_.push_back({n, 0, {}, {}});
        }
        for (const Vec3& d : directions) hold(entries_[static_cast<std::size_t>(i)], d, static_cast<std::int32_t>(m));
      }
    }
  }
}

// Contradictions show in the motion of the node as well, where NodalConditions refuses them.
void RotationConditions::hold(Entry& entry, const Vec3& direction, std::int32_t motion) const {
  Vec3 rest = direction;
  for (int k = 0; k < entry.rows; ++k) rest = rest - dot(entry.direction[k], direction) * entry.direction[k];
  const double left = norm(rest);
  if (entry.rows == 3 || left < 1e-6) return;
  entry.direction[entry.rows] = (1 / left) * rest;
  entry.motion[entry.rows++] = motion;
}

void RotationConditions::start(std::span<Vec3> spin) const {
  for (const Entry& entry : entries_) {
    Vec3& w = spin[static_cast<std::size_t>(entry.node)];
    for (int k = 0; k < entry.rows; ++k) {
      if (motions_[static_cast<std::size_t>(entry.motion[k])].kind == Kind::rotation) continue;
      w = w - dot(entry.direction[k], w) * entry.direction[k];
    }
  }
}

void RotationConditions::apply(NodalState& nodes, double time, double kick, double dt, std::vector<double>& work) {
  for (std::size_t m = 0; m < motions_.size(); ++m) {
    if (motions_[m].kind != Kind::rotation) continue;
    const double angle = motions_[m].factor(time + dt) - motions_[m].factor(time);
    target_[m] = (2 * std::tan(0.5 * angle) / dt / norm(motions_[m].axis)) * motions_[m].axis;
  }
  for (const Entry& entry : entries_) {
    const auto n = static_cast<std::size_t>(entry.node);
    if (nodes.inertia[n] == 0) continue;
    Vec3& w = nodes.spin()[n];
    const double* f = nodes.moment[n].v;
    for (int k = 0; k < entry.rows; ++k) {
      const Vec3& d = entry.direction[k];
      const double target = dot(d, target_[static_cast<std::size_t>(entry.motion[k])]), kicked = dot(d, w);
      const double moment = d[0] * f[0] + d[1] * f[1] + d[2] * f[2];
      const double before = kicked + kick * nodes.inverse_inertia[n] * moment;
      nodes.internal_work[n] += 0.5 * kick * moment * (target - kicked);
      w = (w - kicked * d) + target * d;
      work[n] += 0.5 * nodes.inertia[n] * (target - kicked) * (before + target);
    }
  }
}

}  // namespace tenon

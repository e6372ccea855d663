// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/erosion.hpp"

#include <cmath>

namespace tenon {

LooseNodes::LooseNodes(const Mesh& mesh, std::vector<char> bound) : mesh_(mesh), bound_(std::move(bound)) {}

namespace {

/// visit(node, element's group, element) for every node of every local element.
template <typename Visit>
void for_corners(const ElementGroups& groups, Visit visit) {
  groups.in_mesh_order([&](const ElementGroup& group, LocalIndex e) {
    for (const LocalIndex n : group.elements().nodes(e)) visit(static_cast<std::size_t>(n), group, e);
  });
}

/// m^3; the present thickness of a dead shell means nothing.
double undeformed_volume(const ElementGroup& group, LocalIndex e, std::span<const Vec3> coordinates) {
  if (topology(group.elements().kind).dimension == 2) return value_of(group.mass, e) / group.material().density;
  return group.volume(e, coordinates);
}

}  // namespace

// An element that dies at the start of the next step still holds its nodes; in contact they are loose already.
void LooseNodes::particles(const ElementGroups& groups, const NodalState& nodes,
                           std::vector<ContactParticle>& particles) const {
  particles.clear();
  std::vector<char> holds(nodes.size());
  for_corners(groups, [&](std::size_t n, const ElementGroup& group, LocalIndex e) {
    if (group.alive(e)) holds[n] = 1;
  });
  std::vector<double> volume(nodes.size());
  std::vector<std::int32_t> surface(nodes.size(), -1);
  for_corners(groups, [&](std::size_t n, const ElementGroup& group, LocalIndex e) {
    if (holds[n] != 0) return;
    const double share = 1 / static_cast<double>(group.elements().nodes(e).size());
    volume[n] += share * undeformed_volume(group, e, mesh_.coordinates);
    if (surface[n] < 0) surface[n] = static_cast<std::int32_t>(group.block());
  });
  for (const LocalIndex node : mesh_.owned_nodes) {
    const auto n = static_cast<std::size_t>(node);
    if (surface[n] < 0 || nodes.mass[n] == 0 || (!bound_.empty() && bound_[n] != 0)) continue;
    particles.push_back({node, 0.5 * std::cbrt(volume[n]), surface[n]});
  }
}

void LooseNodes::remove(const ElementGroups& groups, NodalState& nodes) {
  std::vector<char> state(nodes.size());  // 1: only dead elements, 2: held
  for_corners(groups, [&](std::size_t n, const ElementGroup& group, LocalIndex e) {
    const bool dead = !group.dead.empty() && value_of(group.dead, e) != 0;
    if (!dead) state[n] = 2;
    if (state[n] == 0) state[n] = 1;
  });
  for (const LocalIndex node : mesh_.owned_nodes) {
    const auto n = static_cast<std::size_t>(node);
    if (state[n] != 1 || nodes.mass[n] == 0 || (!bound_.empty() && bound_[n] != 0)) continue;
    removed_.resize(nodes.size());
    Vec3& v = nodes.velocity()[n];
    double energy = 0.5 * nodes.mass[n] * dot(v, v);
    if (nodes.has_rotations()) energy += 0.5 * nodes.inertia[n] * dot(nodes.spin()[n], nodes.spin()[n]);
    removed_[n] = {nodes.mass[n], nodes.mass[n] * v, energy};
    v = {};
    if (nodes.has_rotations()) nodes.spin()[n] = {};
  }
  restore(nodes);
}

void LooseNodes::restore(NodalState& nodes) const {
  for (std::size_t n = 0; n < removed_.size(); ++n) {
    if (removed_[n].mass == 0) continue;
    nodes.mass[n] = nodes.inverse_mass[n] = 0;
    if (nodes.has_rotations()) nodes.inertia[n] = nodes.inverse_inertia[n] = 0;
  }
}

}  // namespace tenon

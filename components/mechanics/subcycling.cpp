// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/subcycling.hpp"

#include <algorithm>

#include "components/mechanics/nodal_kick.hpp"

namespace tenon {

Subcycling::Subcycling(const Mesh& mesh, const ElementLevels& levels, std::vector<int> group_levels,
                       std::span<const int> busy, NodalState& nodes)
    : group_levels_(std::move(group_levels)),
      node_level_(node_levels(mesh, levels)),
      velocity_(nodes.size() + 1),
      spin_(nodes.has_rotations() ? nodes.size() + 1 : 0),
      force_(nodes.size()),
      moment_(nodes.has_rotations() ? nodes.size() : 0) {
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (busy[n]) node_level_[n] = 0;
  mesh.node_halo.forward<std::int32_t>(node_level_, node_level_);
  std::int64_t greatest = 0;
  for (const auto& block : levels)
    for (const std::int32_t level : block) greatest = std::max(greatest, std::int64_t{level});
  levels_.resize(static_cast<std::size_t>(mesh.comm.max(greatest) + 1));
  for (std::size_t n = 0; n < nodes.size(); ++n)
    levels_[static_cast<std::size_t>(node_level_[n])].own.push_back(static_cast<LocalIndex>(n));
  for (std::size_t b = 0; b < levels.size(); ++b)
    for (LocalIndex e = 0; e < mesh.blocks[b].size(); ++e) {
      Level& level = levels_[static_cast<std::size_t>(levels[b][static_cast<std::size_t>(e)])];
      const std::span<const LocalIndex> corners = mesh.blocks[b].nodes(e);
      level.touched.insert(level.touched.end(), corners.begin(), corners.end());
    }
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    Level& level = levels_[k];
    std::ranges::sort(level.touched);
    level.touched.erase(std::unique(level.touched.begin(), level.touched.end()), level.touched.end());
    for (const LocalIndex n : level.touched)
      if (node_level_[static_cast<std::size_t>(n)] < static_cast<std::int32_t>(k)) level.shared.push_back(n);
    for (const LocalIndex n : level.shared) {
      level.velocity.push_back(nodes.velocity()[static_cast<std::size_t>(n)]);
      if (nodes.has_rotations()) level.spin.push_back(nodes.spin()[static_cast<std::size_t>(n)]);
    }
  }
  restart(nodes);
}

void Subcycling::restart(const NodalState& nodes) {
  for (Level& level : levels_) {
    level.last.clear();
    for (const LocalIndex n : level.shared) level.last.push_back(nodes.position()[static_cast<std::size_t>(n)]);
    level.turn.assign(level.spin.size(), {});
  }
}

void Subcycling::kick(NodalState& nodes, int step, double kick) const {
  for (std::size_t k = 0; k < levels_.size() && is_due(static_cast<int>(k), step); ++k)
    for (const LocalIndex node : levels_[k].own) {
      const auto n = static_cast<std::size_t>(node);
      kick_node(nodes.velocity()[n], nodes.force[n], nodes.inverse_mass[n], kick, nodes.internal_work[n]);
      if (nodes.has_rotations())
        kick_node(nodes.spin()[n], nodes.moment[n], nodes.inverse_inertia[n], kick, nodes.internal_work[n]);
    }
}

void Subcycling::drift(NodalState& nodes, int step, double h) {
  for (std::size_t k = 0; k < levels_.size() && is_due(static_cast<int>(k), step); ++k) {
    const double dt = static_cast<double>(1 << k) * h;
    for (const LocalIndex node : levels_[k].own) {
      const auto n = static_cast<std::size_t>(node);
      nodes.position()[n] = nodes.position()[n] + dt * nodes.velocity()[n];
    }
  }
  for (Level& level : levels_)
    for (std::size_t i = 0; i < level.turn.size(); ++i) {
      const auto n = static_cast<std::size_t>(level.shared[i]);
      const std::int32_t own = node_level_[n];
      if (is_due(own, step)) level.turn[i] = level.turn[i] + static_cast<double>(1 << own) * h * nodes.spin()[n];
    }
}

void Subcycling::clear_forces(NodalState& nodes, int step) const {
  for (std::size_t k = 0; k < levels_.size() && is_due(static_cast<int>(k), step); ++k)
    for (const LocalIndex n : levels_[k].own) {
      nodes.force[static_cast<std::size_t>(n)] = {};
      if (nodes.has_rotations()) nodes.moment[static_cast<std::size_t>(n)] = {};
    }
}

NodeArrays Subcycling::begin(int level, NodalState& nodes, double dt) {
  NodeArrays arrays = nodes.arrays();
  if (level == 0) return arrays;
  Level& l = levels_[static_cast<std::size_t>(level)];
  for (const LocalIndex node : l.touched) {
    const auto n = static_cast<std::size_t>(node);
    velocity_[n] = nodes.velocity()[n];
    force_[n] = {};
    if (!nodes.has_rotations()) continue;
    spin_[n] = nodes.spin()[n];
    moment_[n] = {};
  }
  for (std::size_t i = 0; i < l.shared.size(); ++i) {
    const auto n = static_cast<std::size_t>(l.shared[i]);
    if (dt > 0) l.velocity[i] = (1 / dt) * (nodes.position()[n] - l.last[i]);
    velocity_[n] = l.velocity[i];
    if (l.spin.empty()) continue;
    if (dt > 0) l.spin[i] = (1 / dt) * l.turn[i];
    spin_[n] = l.spin[i];
  }
  arrays.velocity = velocity_.data()->data();
  if (arrays.force) arrays.force = force_.data()->v;
  if (nodes.has_rotations()) arrays.spin = spin_.data()->data();
  if (arrays.moment) arrays.moment = moment_.data()->v;
  return arrays;
}

void Subcycling::end(int level, NodalState& nodes) {
  if (level == 0) return;
  Level& l = levels_[static_cast<std::size_t>(level)];
  const double weight = static_cast<double>(1 << level);
  for (const LocalIndex node : l.touched) {
    const auto n = static_cast<std::size_t>(node);
    for (int c = 0; c < 3; ++c) nodes.force[n].v[c] += weight * force_[n].v[c];
    for (int c = 0; c < 3 && nodes.has_rotations(); ++c) nodes.moment[n].v[c] += weight * moment_[n].v[c];
  }
  for (std::size_t i = 0; i < l.shared.size(); ++i) {
    l.last[i] = nodes.position()[static_cast<std::size_t>(l.shared[i])];
    if (!l.turn.empty()) l.turn[i] = {};
  }
}

std::int64_t Subcycling::memory() const {
  std::size_t bytes =
      (velocity_.size() + spin_.size()) * sizeof(Vec3) + (force_.size() + moment_.size()) * sizeof(ForceRow);
  for (const Level& l : levels_)
    bytes += (l.own.size() + l.touched.size() + l.shared.size()) * sizeof(LocalIndex) +
             (l.last.size() + l.velocity.size() + 2 * l.turn.size()) * sizeof(Vec3);
  return static_cast<std::int64_t>(bytes);
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/nodal_load.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "components/mechanics/rigid_inertia.hpp"

namespace tenon {

std::vector<LocalIndex> nodes_of_sets(const Mesh& mesh, const std::vector<std::string>& sets,
                                      const std::string& label) {
  std::vector<LocalIndex> nodes;
  for (const std::string& name : sets) {
    const NodeSet* set = mesh.find_node_set(name);
    if (!set) throw Error(ExitCode::usage, fmt::format("{}: the mesh has no node set '{}'", label, name));
    nodes.insert(nodes.end(), set->nodes.begin(), set->nodes.end());
  }
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

NodalLoad::NodalLoad(const Mesh& mesh, const NodalForce& force)
    : reference_(mesh.coordinates), value_(force.force), nodes_(nodes_of_sets(mesh, force.node_sets, force.label)) {
  const std::int64_t count =
      mesh.comm.sum(std::ranges::count_if(nodes_, [&](LocalIndex n) { return mesh.owns_node(n); }));
  if (count == 0) throw Error(ExitCode::usage, force.label + ": the node sets are empty; expected at least one node");
  factor_.assign(nodes_.size(), force.shared ? 1 / static_cast<double>(count) : 1.0);
}

NodalLoad::NodalLoad(const Mesh& mesh, const BodyForce& force, const ElementGroups& groups)
    : reference_(mesh.coordinates), value_(force.acceleration) {
  const auto wanted = [&](const ElementBlock& block) {
    return force.blocks.empty() || std::ranges::find(force.blocks, block.name) != force.blocks.end();
  };
  for (const std::string& name : force.blocks)
    if (!mesh.find_block(name))
      throw Error(ExitCode::usage, fmt::format("{}: the mesh has no block '{}'", force.label, name));
  const auto size = static_cast<std::size_t>(mesh.nodes());
  std::vector<double> mass(size), inertia(size);
  for (const auto& group : groups)
    if (wanted(group->elements())) {
      if (group->rigid)
        add_consistent_masses(*group, mesh.coordinates, mass);
      else
        group->add_masses({mass, inertia});
    }
  for (std::size_t n = 0; n < size; ++n) {
    if (!(mass[n] > 0)) continue;
    nodes_.push_back(static_cast<LocalIndex>(n));
    factor_.push_back(mass[n]);
  }
}

void NodalLoad::add_forces(const LoadState& state, std::span<ForceRow> force) const {
  for (std::size_t c = 0; c < 3; ++c) {
    const SpaceTimeFunction& value = value_[c];
    if (value.is_uniform()) {
      const double now = value.in_time()(state.time);
      if (now == 0) continue;
      for (std::size_t i = 0; i < nodes_.size(); ++i)
        force[static_cast<std::size_t>(nodes_[i])].v[c] += factor_[i] * now;
    } else {
      for (std::size_t i = 0; i < nodes_.size(); ++i) {
        const auto n = static_cast<std::size_t>(nodes_[i]);
        force[n].v[c] += factor_[i] * value(state.time, reference_[n]);
      }
    }
  }
}

}  // namespace tenon

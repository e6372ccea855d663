// SPDX-License-Identifier: BSD-3-Clause
// What the component makes from its options before the first step.
#include <fmt/core.h>

#include <algorithm>

#include "components/mechanics/element_kinds.hpp"
#include "components/mechanics/mechanics.hpp"

namespace tenon {

void Mechanics::make_groups() {
  std::optional<Error> error;
  for (std::size_t b = 0; b < mesh_->blocks.size(); ++b) {
    const ElementBlock& block = mesh_->blocks[b];
    const auto found = std::find_if(options_.blocks.begin(), options_.blocks.end(),
                                    [&](const MechanicsOptions::Block& o) { return o.name == block.name; });
    if (found == options_.blocks.end())
      throw Error(ExitCode::usage, fmt::format("{}: block '{}' of the mesh has no material", name(), block.name));
    groups_.push_back(make_element_group(b, *mesh_, *found, options_));
    ElementGroup& group = *groups_.back();
    passes_ = std::max(passes_, group.passes());
    for (LocalIndex e = 0; e < group.size() && !error; ++e)
      if (!(value_of(group.mass, e) > 0))
        error = Error(ExitCode::geometry,
                      fmt::format("{}: {} has no positive volume; check the mesh", name(), describe(group, e)));
    for (const int owner : block.owners) owned_elements_ += owner == mesh_->comm.rank() ? 1 : 0;
    const std::optional<ThermalProperties>& thermal = found->material.thermal;
    if (options_.heat == HeatMode::exported) group.heat_given.resize(group.mass.size());
    if (options_.heat == HeatMode::adiabatic && thermal)
      group.heating = thermal->taylor_quinney / thermal->specific_heat;
    if (options_.heat != HeatMode::none && group.model().plastic() && !thermal)
      throw Error(ExitCode::usage,
                  fmt::format("{}: heat is {}, but material '{}' of block '{}' has no thermal properties", name(),
                              options_.heat == HeatMode::adiabatic ? "adiabatic" : "exported", found->material.name,
                              block.name));
    if (group.has_rotations() && !nodes_.has_rotations()) nodes_.add_rotations();
    if (group.model().needs_deformation_gradient()) nodes_.keep_reference();
  }
  mesh_->comm.throw_if_any(error);
}

void Mechanics::sum_masses() {
  for (const auto& group : groups_) group->add_masses({nodes_.mass, nodes_.inertia});
  const auto invert = [](const std::vector<double>& from, std::vector<double>& to) {
    for (std::size_t n = 0; n < from.size(); ++n) to[n] = from[n] > 0 ? 1 / from[n] : 0;
  };
  invert(nodes_.mass, nodes_.inverse_mass);
  invert(nodes_.inertia, nodes_.inverse_inertia);
}

// The limit of the assembled mesh is sought only where it decides and every element has its part in it.
void Mechanics::follow_limit() {
  const TimeStepOptions& options = options_.time_step;
  if (options.fixed || options.estimate == TimeStepOptions::Estimate::element) return;
  if (!std::ranges::all_of(groups_, [](const auto& group) { return group->has_product(); })) return;
  assembled_ = std::make_unique<AssembledStep>(*mesh_, nodes_);
  for (const auto& group : groups_) group->follow_limit();
}

void Mechanics::set_temperatures() {
  for (const auto& group : groups_) {
    const std::optional<ThermalProperties>& thermal = group->material().thermal;
    const double start = options_.initial_temperature.value_or(thermal ? thermal->reference_temperature
                                                                       : ThermalProperties{}.reference_temperature);
    for (Batch<1>& t : group->temperature) std::fill(t[0], t[0] + lanes, start);
    group->temperature_used = group->temperature;
  }
}

void Mechanics::set_velocities() {
  const std::span<Vec3> velocity = nodes_.velocity();
  for (const InitialVelocity& given : options_.initial_velocities) {
    const auto set = [&](LocalIndex node) {
      const auto n = static_cast<std::size_t>(node);
      if (nodes_.mass[n] == 0) return;
      const Vec3 r = mesh_->coordinates[n] - given.centre;
      for (std::size_t i = 0; i < 3; ++i)
        velocity[n][i] = given.velocity[i] + given.gradient[3 * i] * r[0] + given.gradient[3 * i + 1] * r[1] +
                         given.gradient[3 * i + 2] * r[2];
    };
    if (!given.block.empty()) {
      const ElementBlock* block = mesh_->find_block(given.block);
      if (!block) throw Error(ExitCode::usage, fmt::format("{}: initial_velocity: no block '{}'", name(), given.block));
      std::for_each(block->connectivity.begin(), block->connectivity.end(), set);
    } else if (!given.node_set.empty()) {
      const NodeSet* nodes = mesh_->find_node_set(given.node_set);
      if (!nodes)
        throw Error(ExitCode::usage, fmt::format("{}: initial_velocity: no node set '{}'", name(), given.node_set));
      std::for_each(nodes->nodes.begin(), nodes->nodes.end(), set);
    } else {
      for (LocalIndex n = 0; n < mesh_->nodes(); ++n) set(n);
    }
  }
  for (std::size_t n = 0; n < nodes_.size() && options_.initial_velocity_function; ++n)
    if (nodes_.mass[n] > 0) velocity[n] = velocity[n] + options_.initial_velocity_function(mesh_->coordinates[n]);
  conditions_.start(velocity, time());
  refresh_ghosts();
}

}  // namespace tenon

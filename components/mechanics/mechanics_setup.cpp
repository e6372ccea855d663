// SPDX-License-Identifier: BSD-3-Clause
// What the component makes from its options before the first step.
#include <fmt/core.h>

#include <algorithm>

#include "components/mechanics/mechanics.hpp"

namespace tenon {

void Mechanics::make_blocks() {
  std::optional<Error> error;
  for (const ElementBlock& block : mesh_->blocks) {
    const auto found = std::find_if(options_.blocks.begin(), options_.blocks.end(),
                                    [&](const MechanicsOptions::Block& b) { return b.name == block.name; });
    if (found == options_.blocks.end())
      throw Error(ExitCode::usage, fmt::format("{}: block '{}' of the mesh has no material", name(), block.name));
    if (block.kind != ElementKind::hex8)
      throw Error(ExitCode::usage, fmt::format("{}: block '{}' is of {}; mechanics computes hex8", name(), block.name,
                                               topology(block.kind).name));
    blocks_.push_back(
        make_hex8_block(block, mesh_->coordinates, found->material, options_.hourglass, options_.viscosity));
    for (LocalIndex e = 0; e < block.size() && !error; ++e)
      if (!(value_of(blocks_.back()->mass, e) > 0))
        error = Error(ExitCode::geometry, fmt::format("{}: {} has no positive volume; check the mesh", name(),
                                                      describe(blocks_.size() - 1, e)));
    for (const int owner : block.owners) owned_elements_ += owner == mesh_->comm.rank() ? 1 : 0;
    heat_given_.emplace_back(options_.heat == HeatMode::exported ? blocks_.back()->mass.size() : 0);
    const std::optional<ThermalProperties>& thermal = found->material.thermal;
    if (options_.heat == HeatMode::adiabatic && thermal)
      blocks_.back()->heating = thermal->taylor_quinney / thermal->specific_heat;
    if (options_.heat != HeatMode::none && blocks_.back()->plastic() && !thermal)
      throw Error(ExitCode::usage,
                  fmt::format("{}: heat is {}, but material '{}' of block '{}' has no thermal properties", name(),
                              options_.heat == HeatMode::adiabatic ? "adiabatic" : "exported", found->material.name,
                              block.name));
  }
  mesh_->comm.throw_if_any(error);
}

// An eighth of the mass of each element around a node, in ascending global order of the elements: [HUG87, 7.3.2].
void Mechanics::sum_masses() {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const ElementBlock& block = mesh_->blocks[b];
    for (LocalIndex e = 0; e < block.size(); ++e)
      for (const LocalIndex n : block.nodes(e))
        nodes_.mass[static_cast<std::size_t>(n)] += 0.125 * value_of(blocks_[b]->mass, e);
  }
  for (std::size_t n = 0; n < nodes_.size(); ++n) nodes_.inverse_mass[n] = nodes_.mass[n] > 0 ? 1 / nodes_.mass[n] : 0;
}

void Mechanics::set_temperatures() {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const std::optional<ThermalProperties>& thermal = blocks_[b]->material().thermal;
    const double start = options_.initial_temperature.value_or(thermal ? thermal->reference_temperature
                                                                       : ThermalProperties{}.reference_temperature);
    for (Batch<1>& t : blocks_[b]->temperature) std::fill(t[0], t[0] + lanes, start);
    blocks_[b]->temperature_used = blocks_[b]->temperature;
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

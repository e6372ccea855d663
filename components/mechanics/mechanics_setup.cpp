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
    groups_.push_back(make_element_group(b, mesh_->blocks[b], mesh_->coordinates, *found, options_));
    ElementGroup& group = *groups_.back();
    passes_ = std::max(passes_, group.passes());
    for (LocalIndex e = 0; e < group.size() && !error; ++e)
      if (!(value_of(group.mass, e) > 0))
        error = Error(ExitCode::geometry,
                      fmt::format("{}: {} has no positive volume; check the mesh", name(), describe(group, e)));
    const std::optional<ThermalProperties>& thermal = found->material.thermal;
    for (const RigidBody& body : options_.loads.rigid_bodies)
      group.rigid = group.rigid || std::ranges::find(body.blocks, block.name) != body.blocks.end();
    if (group.rigid && group.has_rotations() && found->shell.reference != ShellSection::Reference::middle)
      throw Error(ExitCode::usage, fmt::format("{}: block '{}' of a rigid body has shells whose nodes are not on their "
                                               "middle surface, where its weight would act; expected reference: middle",
                                               name(), block.name));
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
  owned_elements_.assign(1, std::int64_t{0});
  for (const ElementBlock& block : mesh_->blocks)
    owned_elements_[0] += std::ranges::count(block.owners, mesh_->comm.rank());
}

void Mechanics::sum_masses() {
  for (const auto& group : groups_)
    if (!group->rigid) group->add_masses({nodes_.mass, nodes_.inertia});
  invert_masses();
}

void Mechanics::invert_masses() {
  const auto invert = [](const std::vector<double>& from, std::vector<double>& to) {
    for (std::size_t n = 0; n < from.size(); ++n) to[n] = from[n] > 0 ? 1 / from[n] : 0;
  };
  invert(nodes_.mass, nodes_.inverse_mass);
  invert(nodes_.inertia, nodes_.inverse_inertia);
}

// The limit of the assembled mesh is sought only where it decides and every element has its part in it.
void Mechanics::follow_limit() {
  const TimeStepOptions& options = options_.time_step;
  if (options.subcycling > 1) {  // the assembled mesh has no one step then
    for (const auto& group : groups_) group->steps.resize(group->mass.size());
    return;
  }
  if (options.fixed || options.estimate == TimeStepOptions::Estimate::element) return;
  if (!std::ranges::all_of(groups_, [](const auto& group) { return group->has_product(); })) return;
  if (!ties_->empty() || !rigid_->empty()) return;  // masses that are not their nodes' own
  assembled_ = std::make_unique<AssembledStep>(*mesh_, nodes_);
  for (const auto& group : groups_) group->follow_limit();
}

// Body forces count the true masses; scaled ones only resist.
void Mechanics::set_loads() {
  const LoadOptions& options = options_.loads;
  for (const InitialStress& initial : options.initial_stresses) set_initial_stress(*mesh_, initial, groups_);
  loads_ = std::make_unique<Loads>(*mesh_, options, groups_);
  if (!options.mass_scaling) return;
  if (options_.heat == HeatMode::adiabatic)
    throw Error(ExitCode::usage, name() +
                                     ": mass_scaling changes the heat capacity of elements, which heat: adiabatic "
                                     "needs; use one of them, or heat: exported");
  added_mass_ = scale_masses(*mesh_, *options.mass_scaling, options_.time_step.scale, groups_, nodes_);
  if (added_mass_.elements == 0) return;
  warnings_.push_back(fmt::format("{}: mass scaling added {:.4g} kg, {:.3g} % of the mass of the body, in {} elements",
                                  name(), added_mass_.added, 100 * added_mass_.added / added_mass_.before,
                                  added_mass_.elements));
}

void Mechanics::set_constraints() {
  const LoadOptions& options = options_.loads;
  ties_ = std::make_unique<Ties>(*mesh_, options.ties);
  if (!ties_->empty()) ties_->move_mass(nodes_);
  rigid_ = std::make_unique<RigidBodies>(*mesh_, options.rigid_bodies, groups_, nodes_, options.damping.mass);
  refuse_misfits();
  std::vector<bool> bound(nodes_.size());
  for (LocalIndex n = 0; n < mesh_->nodes() && !rigid_->empty(); ++n)
    bound[static_cast<std::size_t>(n)] = rigid_->holds(n);
  for (const LocalIndex n : ties_->nodes()) bound[static_cast<std::size_t>(n)] = true;
  if (const std::int64_t left_out = conditions_.leave_out_of_walls(bound); left_out > 0)
    warnings_.push_back(
        fmt::format("{}: rigid walls do not stop {} nodes that are tied or belong to rigid bodies", name(), left_out));
  std::vector<double> inverse_mass = nodes_.inverse_mass;
  for (const LocalIndex n : ties_->nodes()) inverse_mass[static_cast<std::size_t>(n)] = -1;  // none of their own
  rigid_->bound_inverse_mass(inverse_mass);
  loads_->finish(*mesh_, nodes_, groups_, inverse_mass);
  for (const LocalIndex n : ties_->face_nodes()) bound[static_cast<std::size_t>(n)] = true;
  if (std::ranges::any_of(groups_, [](const auto& group) { return group->can_die; }))
    loose_ = std::make_unique<LooseNodes>(*mesh_, std::vector<char>(bound.begin(), bound.end()));
  if (options.relaxation) relaxation_ = std::make_unique<KineticRelaxation>(*options.relaxation, *mesh_);
}

void Mechanics::refuse_misfits() const {
  if (options_.time_step.subcycling > 1 && options_.time_step.fixed)
    throw Error(ExitCode::usage,
                name() + ": time_step.fixed is one step for all elements; with subcycling use maximum");
  if (options_.time_step.subcycling > 1 && (options_.loads.relaxation || options_.loads.damping.stiffness > 0))
    throw Error(ExitCode::usage,
                fmt::format("{}: {} needs the forces of all elements in each step; use time_step.subcycling: 1", name(),
                            options_.loads.relaxation ? "dynamic_relaxation" : "damping.stiffness"));
  if (!rigid_->empty() && options_.loads.relaxation)
    throw Error(ExitCode::usage, name() + ": dynamic_relaxation does not know rigid bodies; fix the nodes instead");
  std::optional<Error> error;
  for (const PrescribedMotion& motion : options_.motions)
    for (const LocalIndex n : nodes_of_sets(*mesh_, motion.node_sets, motion.label))
      if (!rigid_->empty() && rigid_->holds(n) && !error)
        error = Error(ExitCode::usage,
                      fmt::format("{}: node {} belongs to a rigid body; prescribe the motion of the body instead",
                                  motion.label, mesh_->node_labels[static_cast<std::size_t>(n)]));
  for (const LocalIndex n : ties_->nodes())
    if (!rigid_->empty() && rigid_->holds(n) && !error)
      error = Error(ExitCode::usage,
                    fmt::format("tied: node {} belongs to a rigid body and cannot follow a face; tie the other part to "
                                "the body",
                                mesh_->node_labels[static_cast<std::size_t>(n)]));
  mesh_->comm.throw_if_any(error);
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

// Nodes of shells turn as the field of velocities around them does.
void Mechanics::set_spins() {
  const std::span<Vec3> spin = nodes_.spin();
  for (const InitialVelocity& given : options_.initial_velocities) {
    const std::array<double, 9>& g = given.gradient;
    const Vec3 turn{0.5 * (g[7] - g[5]), 0.5 * (g[2] - g[6]), 0.5 * (g[3] - g[1])};
    const auto set = [&](LocalIndex n) { spin[static_cast<std::size_t>(n)] = turn; };
    const ElementBlock* block = mesh_->find_block(given.block);
    const NodeSet* nodes = mesh_->find_node_set(given.node_set);
    if (block) std::for_each(block->connectivity.begin(), block->connectivity.end(), set);
    if (nodes) std::for_each(nodes->nodes.begin(), nodes->nodes.end(), set);
    for (LocalIndex n = 0; !block && !nodes && n < mesh_->nodes(); ++n) set(n);
  }
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    if (options_.initial_spin_function) spin[n] = spin[n] + options_.initial_spin_function(mesh_->coordinates[n]);
    if (nodes_.inertia[n] == 0) spin[n] = {};
  }
  conditions_.start_spins(spin);
}

void Mechanics::set_velocities() {
  const std::span<Vec3> velocity = nodes_.velocity();
  for (const InitialVelocity& given : options_.initial_velocities) {
    const auto set = [&](LocalIndex node) {
      const auto n = static_cast<std::size_t>(node);
      if (nodes_.mass[n] == 0 && (rigid_->empty() || !rigid_->holds(node))) return;
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
  if (nodes_.has_rotations()) set_spins();
  conditions_.start(velocity, time());
  if (!rigid_->empty()) rigid_->start(nodes_, time());
  if (!ties_->empty()) ties_->follow(nodes_);
  refresh_ghosts();
}

}  // namespace tenon

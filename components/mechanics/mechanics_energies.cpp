// SPDX-License-Identifier: BSD-3-Clause
// Rows of the energy ledger.
#include <algorithm>

#include "components/mechanics/mechanics.hpp"

namespace tenon {

namespace {

/// Calls visit(group, element) for the elements that this rank owns.
template <typename Visit>
void for_owned(const Mesh& mesh, const ElementGroups& groups, Visit visit) {
  for (const auto& group : groups)
    for (LocalIndex e = 0; e < group->size(); ++e)
      if (group->elements().owners[static_cast<std::size_t>(e)] == mesh.comm.rank()) visit(*group, e);
}

}  // namespace

// The work of the nodes against all element forces (booked less that of the loads) is internal energy, hourglass energy
// and viscosity together; the
// elements know the last two, and what was in those that have failed.
void Mechanics::energies(std::vector<EnergyTerm>& terms) {
  using Role = EnergyTerm::Role;
  EnergyTerm kinetic{"kinetic_energy", Role::stored, {}}, internal{"internal_energy", Role::stored, {}};
  EnergyTerm hourglass{"hourglass_energy", Role::stored, {}}, viscosity{"viscosity_energy", Role::stored, {}};
  EnergyTerm eroded{"eroded_energy", Role::stored, {}};
  EnergyTerm boundary{"boundary_work", Role::supplied, {}}, wall{"wall_work", Role::supplied, {}};
  EnergyTerm debris{"given_to_particles", Role::supplied, {}};
  EnergyTerm plastic{"plastic_work", Role::memo, {}}, generated{"heat_generated", Role::memo, {}};
  for (const LocalIndex n : mesh_->owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    const Vec3& v = nodes_.velocity()[i];
    kinetic.local.add(0.5 * nodes_.mass[i] * dot(v, v));
    if (nodes_.has_rotations()) kinetic.local.add(0.5 * nodes_.inertia[i] * dot(nodes_.spin()[i], nodes_.spin()[i]));
    internal.local.add(nodes_.internal_work[i]);
    if (conditions_.has_motions()) boundary.local.add(conditions_.boundary_work()[i]);
    if (conditions_.has_walls()) wall.local.add(conditions_.wall_work()[i]);
    for (const Loads::Row& row : loads_->rows()) internal.local.add(row.work[i]);
  }
  if (mesh_->comm.rank() == 0) kinetic.local.add(rigid_->kinetic_energy());
  bool has_plasticity = false, can_fail = false;
  for (const auto& group : groups_)
    has_plasticity = has_plasticity || group->model().plastic(), can_fail = can_fail || group->can_die;
  for_owned(*mesh_, groups_, [&](const ElementGroup& group, LocalIndex e) {
    const double h = value_of(group.hourglass_energy, e), v = value_of(group.viscosity_energy, e);
    hourglass.local.add(h), viscosity.local.add(v);
    internal.local.add(-h), internal.local.add(-v);
    if (!group.alive(e)) {
      const bool gone = !given_up_.empty() && given_up_[group.block()].any &&
                        given_up_[group.block()].departed[static_cast<std::size_t>(e)] != 0;
      internal.local.add(-value_of(group.internal_energy, e));
      if (gone)
        debris.local.add(-given_up_[group.block()].energy[static_cast<std::size_t>(e)]);
      else
        eroded.local.add(value_of(group.internal_energy, e));
    }
    if (has_plasticity) plastic.local.add(value_of(group.plastic_work, e)), generated.local.add(heat(group, e));
  });
  for (EnergyTerm* term : {&kinetic, &internal, &hourglass, &viscosity}) terms.push_back(std::move(*term));
  if (loose_)
    for (const LooseNodes::Removed& removed : loose_->removed()) eroded.local.add(removed.energy);
  if (can_fail) terms.push_back(std::move(eroded));
  if (std::ranges::any_of(given_up_, [](const GivenUp& given) { return given.any; }))
    terms.push_back(std::move(debris));
  if (conditions_.has_motions()) terms.push_back(std::move(boundary));
  if (conditions_.has_walls()) terms.push_back(std::move(wall));
  if (rigid_->has_prescribed()) {
    EnergyTerm& term = terms.emplace_back(EnergyTerm{"rigid_body_work", Role::supplied, {}});
    if (mesh_->comm.rank() == 0) term.local.add(rigid_->work());
  }
  if (contact_) terms.push_back({"contact_work", Role::supplied, contact_->contact_work()});
  if (relaxation_) {
    EnergyTerm& term = terms.emplace_back(EnergyTerm{"relaxation_energy", Role::stored, {}});
    for (const LocalIndex n : mesh_->owned_nodes) term.local.add(relaxation_->taken()[static_cast<std::size_t>(n)]);
  }
  for (const Loads::Row& row : loads_->rows()) {
    EnergyTerm& term = terms.emplace_back(EnergyTerm{row.name, row.role, {}});
    for (const LocalIndex n : mesh_->owned_nodes) term.local.add(row.sign * row.work[static_cast<std::size_t>(n)]);
    if (row.name == "damping_energy" && mesh_->comm.rank() == 0) term.local.add(rigid_->damped());
  }
  if (!has_plasticity) return;
  terms.push_back(std::move(plastic));
  if (options_.heat != HeatMode::none) terms.push_back(std::move(generated));
}

}  // namespace tenon

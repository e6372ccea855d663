// SPDX-License-Identifier: BSD-3-Clause
// Rows of the energy ledger.
#include "components/mechanics/mechanics.hpp"

namespace tenon {

template <typename Visit>
void Mechanics::for_owned(Visit visit) const {
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (LocalIndex e = 0; e < blocks_[b]->size(); ++e)
      if (mesh_->blocks[b].owners[static_cast<std::size_t>(e)] == mesh_->comm.rank()) visit(b, e);
}

// The work of the nodes against all element forces is internal energy, hourglass energy and viscosity together; the
// elements know the last two.
void Mechanics::energies(std::vector<EnergyTerm>& terms) {
  using Role = EnergyTerm::Role;
  EnergyTerm kinetic{"kinetic_energy", Role::stored, {}}, internal{"internal_energy", Role::stored, {}};
  EnergyTerm hourglass{"hourglass_energy", Role::stored, {}}, viscosity{"viscosity_energy", Role::stored, {}};
  EnergyTerm boundary{"boundary_work", Role::supplied, {}}, wall{"wall_work", Role::supplied, {}};
  EnergyTerm plastic{"plastic_work", Role::memo, {}}, generated{"heat_generated", Role::memo, {}};
  for (const LocalIndex n : mesh_->owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    const Vec3& v = nodes_.velocity()[i];
    kinetic.local.add(0.5 * nodes_.mass[i] * dot(v, v));
    internal.local.add(nodes_.internal_work[i]);
    if (conditions_.has_motions()) boundary.local.add(conditions_.boundary_work()[i]);
    if (conditions_.has_walls()) wall.local.add(conditions_.wall_work()[i]);
  }
  bool has_plasticity = false;
  for (const auto& block : blocks_) has_plasticity = has_plasticity || block->plastic();
  for_owned([&](std::size_t b, LocalIndex e) {
    const double h = value_of(blocks_[b]->hourglass_energy, e), v = value_of(blocks_[b]->viscosity_energy, e);
    hourglass.local.add(h), viscosity.local.add(v);
    internal.local.add(-h), internal.local.add(-v);
    if (has_plasticity) plastic.local.add(value_of(blocks_[b]->plastic_work, e)), generated.local.add(heat(b, e));
  });
  for (EnergyTerm* term : {&kinetic, &internal, &hourglass, &viscosity}) terms.push_back(std::move(*term));
  if (conditions_.has_motions()) terms.push_back(std::move(boundary));
  if (conditions_.has_walls()) terms.push_back(std::move(wall));
  if (!has_plasticity) return;
  terms.push_back(std::move(plastic));
  if (options_.heat != HeatMode::none) terms.push_back(std::move(generated));
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Particles that a moving wall brings in.
#include "components/sph/sph.hpp"

namespace tenon {

// Collective where something flows in. As copies on other ranks must know what a particle has become, all is put in
// order anew; true if it was.
bool Sph::bring_in() {
  if (!inflow_energy_) return false;
  bool any = false;
  for (std::size_t i = 0; i < particles_.owned(); ++i) {
    const std::optional<SphInflow>& inflow = options_.bodies[static_cast<std::size_t>(particles_.body[i])].inflow;
    if (!inflow || !(dot(particles_.position.vec(i) - inflow->point, inflow->normal) > 0)) continue;
    const Vec3 v = particles_.velocity.vec(i);
    particles_.body[i] = static_cast<std::int32_t>(inflow->into);
    (*inflow_energy_)[i] = 0.5 * particles_.mass[i] * dot(v, v);
    any = true;
  }
  if (!mesh_->comm.any(any)) return false;
  decomposition_->renew();
  if (contact_) contact_->renew();
  return true;
}

}  // namespace tenon

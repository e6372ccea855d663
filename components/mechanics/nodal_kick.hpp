// SPDX-License-Identifier: BSD-3-Clause
// The kick of central differences on one node.
#pragma once

#include "components/mechanics/nodal_state.hpp"

namespace tenon {

/// v* = v- - kick f/m; adds the work of the node against f, which is the change of its kinetic energy, to `work`.
inline void kick_node(Vec3& v, const ForceRow& force, double inverse_mass, double kick, double& work) {
  const double* f = force.v;
  const double scale = kick * inverse_mass;
  const Vec3 kicked{v[0] - scale * f[0], v[1] - scale * f[1], v[2] - scale * f[2]};
  const double power = f[0] * (v[0] + kicked[0]) + f[1] * (v[1] + kicked[1]) + f[2] * (v[2] + kicked[2]);
  work += 0.5 * kick * power;
  v = kicked;
}

}  // namespace tenon

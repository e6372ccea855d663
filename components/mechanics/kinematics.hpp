// SPDX-License-Identifier: BSD-3-Clause
// Kinematics of a step of a hexahedron; strain increment and rotation are those of every material.
#pragma once

#include "components/materials/step_deformation.hpp"
#include "components/mechanics/hex8_mean_gradient.hpp"

namespace tenon {

/// Modes of the geometry half a step back: x - dt/2 v.
template <typename R>
TENON_KERNEL HexModes<R> mid_step(const HexModes<R>& x, const HexModes<R>& v, double dt) {
  const R back = broadcast<R>(0.5 * dt);
  return {x.xi - back * v.xi,
          x.eta - back * v.eta,
          x.zeta - back * v.zeta,
          x.eta_zeta - back * v.eta_zeta,
          x.zeta_xi - back * v.zeta_xi,
          x.xi_eta - back * v.xi_eta,
          x.xi_eta_zeta - back * v.xi_eta_zeta};
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Von Mises plasticity with linear isotropic hardening.
#pragma once

#include <array>
#include <string_view>

#include "components/materials/material_concept.hpp"

namespace tenon {

/// Flow stress sigma_y = yield_stress + hardening_modulus eqps; associated flow, integrated by the radial return
/// (backward Euler), which is closed form here: [SH98] box 3.1; under plane stress by its projection onto the plane,
/// [ST86]. Exact for proportional loading at any step.
/// Plastic work is the trapezium 1/2 (sigma_y,n + sigma_y,n+1) d_eqps: the exact integral of the flow stress over the
/// plastic strain of the step (the end value alone, of first order, would heat too much).
struct J2LinearHardening {
  static constexpr int state_size = 1;
  static constexpr std::array<std::string_view, 1> state_names{"eqps"};

  Elasticity elasticity;
  double yield_stress = 0;       ///< Pa, positive
  double hardening_modulus = 0;  ///< H = d sigma_y / d eqps, Pa, not negative

  void update(const UpdateInput& input, Batch<6>& stress, Batch<1>& state, Batch<1>& plastic_work) const;
  void update_plane_stress(const UpdateInput& input, Batch<6>& stress, Batch<1>& state, Batch<1>& plastic_work,
                           Batch<1>& thickness_increment) const;
};

}  // namespace tenon

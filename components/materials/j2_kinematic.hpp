// SPDX-License-Identifier: BSD-3-Clause
// Von Mises plasticity whose yield surface moves: linear (Prager), mixed, and with recovery (Armstrong-Frederick).
#pragma once

#include <array>
#include <string_view>

#include "components/materials/material_concept.hpp"

namespace tenon {

struct KinematicHardeningParameters {
  double yield_stress = 0;       ///< Pa, positive
  double isotropic_modulus = 0;  ///< growth of the yield surface over eqps, Pa, not negative
  double kinematic_modulus = 0;  ///< C: stress by which it moves per plastic strain, Pa, not negative
  double recovery = 0;           ///< gamma of [AF66], 1: the back stress saturates at C / gamma; 0: Prager, linear
};

/// Yield: sqrt(3/2) |s - a| = yield_stress + isotropic_modulus eqps; back stress a' = 2/3 C plastic strain' - gamma a
/// eqps'. Backward Euler, [SH98] ch. 3.3: in closed form without recovery, else one equation in the plastic increment,
/// which falls steadily as long as the back stress is within C / gamma (it always is). Plastic work is stress times
/// plastic strain, by the trapezium; where the back stress gives stored energy back it counts as zero.
struct J2Kinematic {
  static constexpr int state_size = 7;
  static constexpr std::array<std::string_view, 7> state_names{"eqps",           "back_stress_xx", "back_stress_yy",
                                                               "back_stress_zz", "back_stress_xy", "back_stress_yz",
                                                               "back_stress_zx"};
  static constexpr std::array<int, 1> rotating_tensors{1};

  Elasticity elasticity;
  KinematicHardeningParameters flow;

  void update(const UpdateInput& input, Batch<6>& stress, Batch<7>& state, Batch<1>& plastic_work) const;
};

}  // namespace tenon

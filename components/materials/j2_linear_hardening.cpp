// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/j2_linear_hardening.hpp"

#include "components/materials/trial_stress.hpp"

namespace tenon {

void J2LinearHardening::update(const UpdateInput& input, Batch<6>& stress, Batch<1>& state,
                               Batch<1>& plastic_work) const {
  elastic_trial(elasticity, input, stress);
  Batch<1> q, scale;
  von_mises(stress, q);

  const double stiffness = 3 * elasticity.shear_modulus() + hardening_modulus;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double eqps = state.v[0][l];
    const double before = yield_stress + hardening_modulus * eqps;
    const double excess = q.v[0][l] - before;
    const bool yields = excess > 0;
    const double increment = yields ? excess / stiffness : 0.0;
    const double after = before + hardening_modulus * increment;
    scale.v[0][l] = yields ? after / q.v[0][l] : 1.0;
    state.v[0][l] = eqps + increment;
    plastic_work.v[0][l] = 0.5 * (before + after) * increment;
  }
  scale_deviator(scale, stress);
}

}  // namespace tenon

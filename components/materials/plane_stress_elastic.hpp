// SPDX-License-Identifier: BSD-3-Clause
// The elastic predictor under plane stress, in closed form.
#pragma once

#include "components/materials/material_concept.hpp"

namespace tenon {

/// As elastic_trial, but the strain increment zz is the one that brings the stress zz to zero; it is given too.
inline void elastic_trial_plane_stress(const Elasticity& elasticity, const UpdateInput& input, Batch<6>& stress,
                                       Batch<1>& thickness_increment) {
  const double two_g = 2 * elasticity.shear_modulus(), alpha = elasticity.expansion;
  // lambda / (lambda + 2 mu) and what is left of lambda once the thickness gives way.
  const double ratio = elasticity.lame_lambda() / elasticity.p_wave_modulus();
  const double coupling = two_g * ratio, compliance = 1 / elasticity.p_wave_modulus();
  const auto& e = input.strain_increment.v;
  const auto& dt = input.temperature_increment.v;
  auto& s = stress.v;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double thermal = alpha * dt[0][l], normal = s[2][l];
    const double exx = e[0][l] - thermal, eyy = e[1][l] - thermal, sum = exx + eyy;
    const double common = coupling * sum - ratio * normal;
    s[0][l] += common + two_g * exx;
    s[1][l] += common + two_g * eyy;
    s[2][l] = 0;
    s[3][l] += two_g * e[3][l];
    s[4][l] += two_g * e[4][l];
    s[5][l] += two_g * e[5][l];
    thickness_increment.v[0][l] = thermal - ratio * sum - compliance * normal;
  }
}

}  // namespace tenon

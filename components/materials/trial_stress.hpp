// SPDX-License-Identifier: BSD-3-Clause
// The elastic predictor and the von Mises measure that all materials share.
#pragma once

#include <cmath>

#include "components/materials/material_concept.hpp"

namespace tenon {

/// stress += C : (strain increment - alpha dT I).
inline void elastic_trial(const Elasticity& elasticity, const UpdateInput& input, Batch<6>& stress) {
  const double lambda = elasticity.lame_lambda(), two_g = 2 * elasticity.shear_modulus();
  const double alpha = elasticity.expansion;
  const auto& e = input.strain_increment.v;
  const auto& dt = input.temperature_increment.v;
  auto& s = stress.v;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double thermal = alpha * dt[0][l];
    const double exx = e[0][l] - thermal, eyy = e[1][l] - thermal, ezz = e[2][l] - thermal;
    const double volumetric = lambda * (exx + eyy + ezz);
    s[0][l] += volumetric + two_g * exx;
    s[1][l] += volumetric + two_g * eyy;
    s[2][l] += volumetric + two_g * ezz;
    s[3][l] += two_g * e[3][l];
    s[4][l] += two_g * e[4][l];
    s[5][l] += two_g * e[5][l];
  }
}

/// q = sqrt(3/2 s:s) of each point, Pa.
inline void von_mises(const Batch<6>& stress, Batch<1>& q) {
  const auto& s = stress.v;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double p = (s[0][l] + s[1][l] + s[2][l]) / 3;
    const double x = s[0][l] - p, y = s[1][l] - p, z = s[2][l] - p;
    const double shear = s[3][l] * s[3][l] + s[4][l] * s[4][l] + s[5][l] * s[5][l];
    q.v[0][l] = std::sqrt(1.5 * (x * x + y * y + z * z + 2 * shear));
  }
}

/// Shrinks the deviator of each point by `scale`; a scale of exactly 1 leaves the stress as it is, bit for bit.
inline void scale_deviator(const Batch<1>& scale, Batch<6>& stress) {
  auto& s = stress.v;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double f = scale.v[0][l];
    const double p = (s[0][l] + s[1][l] + s[2][l]) / 3;
    const bool as_it_is = f == 1;
    s[0][l] = as_it_is ? s[0][l] : p + f * (s[0][l] - p);
    s[1][l] = as_it_is ? s[1][l] : p + f * (s[1][l] - p);
    s[2][l] = as_it_is ? s[2][l] : p + f * (s[2][l] - p);
    s[3][l] = f * s[3][l];
    s[4][l] = f * s[4][l];
    s[5][l] = f * s[5][l];
  }
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// What an update of the material did, seen from outside it: work of the stress, and how far flow relaxed it.
#pragma once

#include <cmath>

#include "components/materials/batch.hpp"

namespace tenon {

/// Adds the work of the stress over a step, J, to the internal energy of elements that are not dead: volume (as mass
/// over density) times the mean of the stresses before (turned) and after, times the strain increment.
inline void add_stress_power(const Batch<6>& before, const Batch<6>& after, const Batch<6>& strain_increment,
                             const Batch<1>& volume, const Batch<1>& dead, Batch<1>& energy) {
  for (int l = 0; l < lanes; ++l) {
    double power = 0;
    for (int i = 0; i < 3; ++i) power += (before[i][l] + after[i][l]) * strain_increment[i][l];
    for (int i = 3; i < 6; ++i) power += 2 * (before[i][l] + after[i][l]) * strain_increment[i][l];
    energy[0][l] += dead[0][l] == 0 ? 0.5 * volume[0][l] * power : 0.0;
  }
}

/// The same of the deviators alone.
inline void add_deviatoric_power(const Batch<6>& before, const Batch<6>& after, const Batch<6>& strain_increment,
                                 const Batch<1>& volume, const Batch<1>& dead, Batch<1>& energy) {
  const auto mean = [](const Batch<6>& s, int l) { return (s[0][l] + s[1][l] + s[2][l]) / 3; };
  for (int l = 0; l < lanes; ++l) {
    const double both = mean(before, l) + mean(after, l);
    double power = 0;
    for (int i = 0; i < 3; ++i) power += (before[i][l] + after[i][l] - both) * strain_increment[i][l];
    for (int i = 3; i < 6; ++i) power += 2 * (before[i][l] + after[i][l]) * strain_increment[i][l];
    energy[0][l] += dead[0][l] == 0 ? 0.5 * volume[0][l] * power : 0.0;
  }
}

/// |deviator after| / |deviator of the elastic trial|, at most 1, where the trial is before + 2 mu strain increment; 1
/// where nothing flowed to round-off. `shear`: mu, Pa. Only for materials that flow, and of which this is the trial.
inline void relaxation_of(const Batch<6>& before, const Batch<6>& strain_increment, const Batch<6>& after,
                          const double (&shear)[lanes], Batch<1>& result) {
  const auto deviator = [](double x, double y, double z, double xy, double yz, double zx) {
    const double p = (x + y + z) / 3, a = x - p, b = y - p, c = z - p;
    return std::sqrt(a * a + b * b + c * c + 2 * (xy * xy + yz * yz + zx * zx));
  };
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double g = 2 * shear[l];
    const auto trial = [&](int i) { return before[i][l] + g * strain_increment[i][l]; };
    const double elastic = deviator(trial(0), trial(1), trial(2), trial(3), trial(4), trial(5));
    const double now = deviator(after[0][l], after[1][l], after[2][l], after[3][l], after[4][l], after[5][l]);
    result[0][l] = now < elastic * (1 - 1e-10) ? now / elastic : 1.0;
  }
}
/// The same with the shear moduli in row 1.
inline void relaxation_of(const Batch<6>& before, const Batch<6>& strain_increment, const Batch<6>& after,
                          const Batch<2>& moduli, Batch<1>& result) {
  relaxation_of(before, strain_increment, after, moduli.v[1], result);
}

}  // namespace tenon

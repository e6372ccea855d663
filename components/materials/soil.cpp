// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/soil.hpp"

#include <algorithm>
#include <cmath>

#include "components/materials/lane_math.hpp"
#include "components/materials/trial_stress.hpp"

namespace tenon {

void Soil::update(const UpdateInput& input, Batch<6>& stress, Batch<2>& state, Batch<1>& plastic_work) const {
  const double K = elasticity.bulk_modulus(), three_g = 3 * elasticity.shear_modulus();
  elastic_trial(elasticity, input, stress);
  Batch<1> trial;
  von_mises(stress, trial);
  LaneValues before, after, end, slope, p_before, p_after;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    before[l] = state.v[1][l];
    end[l] = -log_of((*input.volume_ratio).v[0][l]);
    after[l] = std::max(before[l], end[l]);
  }
  pressure.evaluate(before, p_before, slope);
  pressure.evaluate(after, p_after, slope);
  auto& s = stress.v;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double p = std::max(p_after[l] - K * (after[l] - end[l]), -tension_cutoff);
    const double strength = std::sqrt(3 * std::max(a0 + p * (a1 + p * a2), 0.0));
    const double q = trial.v[0][l], excess = q > strength ? q - strength : 0.0;
    const double scale = q > strength ? strength / q : 1.0, mean = (s[0][l] + s[1][l] + s[2][l]) / 3;
    for (int c = 0; c < 3; ++c) s[c][l] = scale * (s[c][l] - mean) - p;
    for (int c = 3; c < 6; ++c) s[c][l] *= scale;
    const double crushed = (after[l] - before[l]) - (p_after[l] - p_before[l]) / K;
    const double volume_work = 0.5 * (p_before[l] + p_after[l]) * std::max(crushed, 0.0);
    plastic_work.v[0][l] = strength * (excess / three_g) + volume_work;
    state.v[0][l] += excess / three_g;
    state.v[1][l] = after[l];
  }
}

}  // namespace tenon

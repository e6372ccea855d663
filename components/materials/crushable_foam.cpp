// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/crushable_foam.hpp"

#include <algorithm>

#include "components/materials/lane_principal.hpp"

namespace tenon {
namespace {

/// Modulus over the uncrushed one, at the compaction of each point.
void stiffening(const CrushableFoam& foam, const LaneValues& compaction, LaneValues& factor) {
  LaneValues value;
  foam.yield_stress.evaluate(compaction, value, factor);
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double slope = factor[l] * (1 - compaction[l]);  // over the logarithmic strain
    const double wanted = CrushableFoam::lead * slope / foam.elasticity.youngs_modulus;
    factor[l] = wanted > 1 ? wanted : 1.0;
  }
}

void trial_stress(const Elasticity& elasticity, const LaneValues& factor, const UpdateInput& input, Batch<6>& stress) {
  const double lambda = elasticity.lame_lambda(), two_g = 2 * elasticity.shear_modulus();
  const auto& e = input.strain_increment.v;
  auto& s = stress.v;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double thermal = elasticity.expansion * input.temperature_increment.v[0][l];
    const double volumetric = lambda * (e[0][l] + e[1][l] + e[2][l] - 3 * thermal);
    for (int c = 0; c < 3; ++c) s[c][l] += factor[l] * (volumetric + two_g * (e[c][l] - thermal));
    for (int c = 3; c < 6; ++c) s[c][l] += factor[l] * (two_g * e[c][l]);
  }
}

}  // namespace

void CrushableFoam::update(const UpdateInput& input, Batch<6>& stress, Batch<1>& state, Batch<1>& plastic_work) const {
  LaneValues compaction, factor, strength, slope;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    compaction[l] = 1 - (*input.volume_ratio).v[0][l];
    state.v[0][l] = std::max(state.v[0][l], compaction[l]);
  }
  stiffening(*this, compaction, factor);
  yield_stress.evaluate(state.v[0], strength, slope);
  trial_stress(elasticity, factor, input, stress);

  const PrincipalLanes p = principal(stress);
  const double E = elasticity.youngs_modulus, nu = elasticity.poissons_ratio;
  auto& s = stress.v;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    double end[3], beyond[3];
    for (int i = 0; i < 3; ++i) {
      end[i] = std::clamp(p.value[i][l], -strength[l], tension_cutoff);
      beyond[i] = p.value[i][l] - end[i];
    }
    const double sum = beyond[0] + beyond[1] + beyond[2];
    double work = 0;
    for (int i = 0; i < 3; ++i) {
      const double x = p.axis[i][0][l], y = p.axis[i][1][l], z = p.axis[i][2][l];
      s[0][l] -= beyond[i] * x * x, s[1][l] -= beyond[i] * y * y, s[2][l] -= beyond[i] * z * z;
      s[3][l] -= beyond[i] * x * y, s[4][l] -= beyond[i] * y * z, s[5][l] -= beyond[i] * z * x;
      work += end[i] * ((1 + nu) * beyond[i] - nu * sum) / (E * factor[l]);
    }
    plastic_work.v[0][l] = std::max(work, 0.0);
  }
}

void CrushableFoam::trial_shear(const UpdateInput& input, Batch<1>& shear) const {
  LaneValues compaction, factor;
  for (int l = 0; l < lanes; ++l) compaction[l] = 1 - (*input.volume_ratio).v[0][l];
  stiffening(*this, compaction, factor);
  for (int l = 0; l < lanes; ++l) shear.v[0][l] = factor[l] * elasticity.shear_modulus();
}

/// Looks ahead by what a step may crush, so that the step is short enough when the foam locks.
void CrushableFoam::stiffness(const UpdateInput& input, const Batch<6>&, const Batch<1>&, Batch<2>& moduli) const {
  constexpr double ahead = 0.05;
  LaneValues now, later, factor, factor_later;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    now[l] = 1 - (*input.volume_ratio).v[0][l];
    later[l] = std::min(now[l] + ahead, 0.99);
  }
  stiffening(*this, now, factor);
  stiffening(*this, later, factor_later);
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double greater = std::max(factor[l], factor_later[l]);
    moduli.v[0][l] = greater * elasticity.lame_lambda();
    moduli.v[1][l] = greater * elasticity.shear_modulus();
  }
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Any material under plane stress: the strain through the thickness is sought at which the normal stress vanishes.
#pragma once

#include <algorithm>
#include <cmath>

#include "components/materials/material_concept.hpp"

namespace tenon {

/// Secant iteration on the strain increment zz, point by point: a point that is done stands still, so what it gets does
/// not depend on its neighbours. The slope is held between a twentieth and the whole of lambda + 2 mu.
template <Material M>
void iterate_plane_stress(const M& material, const UpdateInput& input, Batch<6>& stress, StateBatch<M>& state,
                          Batch<1>& plastic_work, Batch<1>& thickness_increment) {
  constexpr int budget = 40;
  constexpr double tolerance = 1e-10;
  const Elasticity elasticity = material.elasticity;
  const double modulus = elasticity.p_wave_modulus(), ratio = elasticity.lame_lambda() / modulus;
  const double expansion = elasticity.expansion * (1 + 2 * ratio);
  const Batch<6> stress_before = stress;
  const StateBatch<M> state_before = state;
  Batch<6> strain = input.strain_increment;
  UpdateInput trial{
      strain, input.temperature, input.temperature_increment, input.dt, nullptr, input.volume_ratio, input.added_heat};
  Batch<1> slope, last_strain, last_stress, searching;
  for (int l = 0; l < lanes; ++l) {
    strain[2][l] = expansion * input.temperature_increment[0][l] - ratio * (strain[0][l] + strain[1][l]) -
                   stress_before[2][l] / modulus;
    slope[0][l] = modulus, searching[0][l] = 1;
    last_strain[0][l] = last_stress[0][l] = 0;
  }
  for (int i = 0; i < budget; ++i) {
    stress = stress_before, state = state_before;
    material.update(trial, stress, state, plastic_work);
    double left = 0;
    for (int l = 0; l < lanes; ++l) {
      const double residual = stress[2][l];
      const double size = std::abs(stress[0][l]) + std::abs(stress[1][l]) + std::abs(stress[3][l]);
      if (searching[0][l] == 0) continue;
      if (!(std::abs(residual) > tolerance * size)) {
        searching[0][l] = 0;
        continue;
      }
      const double run = strain[2][l] - last_strain[0][l], rise = residual - last_stress[0][l];
      if (i > 0 && run != 0) slope[0][l] = std::clamp(rise / run, 0.05 * modulus, modulus);
      last_strain[0][l] = strain[2][l], last_stress[0][l] = residual;
      strain[2][l] -= residual / slope[0][l];
      left += 1;
    }
    if (left == 0) break;
  }
  for (int l = 0; l < lanes; ++l) thickness_increment[0][l] = strain[2][l];
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Any material under plane stress: the strain through the thickness is sought at which the normal stress vanishes.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/materials/material_concept.hpp"

namespace tenon {

/// The search of one point for the strain increment zz. The normal stress rises with it, so that a bracket closes in on
/// the root; secants within it, which both elastic and plastic laws make almost exact, and halving where they stray.
class ThicknessSearch {
 public:
  void start(double strain, double modulus) { strain_ = strain, modulus_ = slope_ = modulus; }
  double strain() const { return strain_; }
  bool searching() const { return searching_; }

  /// Takes note of the normal stress at strain(); moves on unless it is as good as zero.
  void take(double stress, double tolerance) {
    if (!searching_) return;
    searching_ = std::abs(stress) > tolerance && high_ - low_ > 4e-16 * std::max(std::abs(low_), std::abs(high_));
    if (!searching_) return;
    const double run = strain_ - last_strain_, rise = stress - last_stress_;
    // The slope is that of lambda + 2 mu at most; where the material flows it is less, but seldom by much.
    if (known_ && run != 0) slope_ = std::clamp(rise / run, 1e-3 * modulus_, modulus_);
    known_ = true, last_strain_ = strain_, last_stress_ = stress;
    (stress > 0 ? high_ : low_) = strain_;
    double next = strain_ - stress / slope_;
    if (!(next > low_ && next < high_)) next = 0.5 * (low_ + high_);
    strain_ = next;
  }

 private:
  static constexpr double infinite = std::numeric_limits<double>::max() / 4;
  double strain_ = 0, modulus_ = 1, slope_ = 1, last_strain_ = 0, last_stress_ = 0;
  double low_ = -infinite, high_ = infinite;
  bool known_ = false, searching_ = true;
};

/// Point by point: one that is done stands still, so that what it gets does not depend on its neighbours. State, stress
/// and strain belong together even where the budget is spent before the normal stress is gone.
template <Material M>
void iterate_plane_stress(const M& material, const UpdateInput& input, Batch<6>& stress, StateBatch<M>& state,
                          Batch<1>& plastic_work, Batch<1>& thickness_increment) {
  constexpr int budget = 60;
  constexpr double tolerance = 1e-10, round_off = 1e-15;
  const Elasticity elasticity = material.elasticity;
  const double modulus = elasticity.p_wave_modulus(), ratio = elasticity.lame_lambda() / modulus;
  const double expansion = elasticity.expansion * (1 + 2 * ratio);
  const Batch<6> stress_before = stress;
  const StateBatch<M> state_before = state;
  Batch<6> strain = input.strain_increment;
  const UpdateInput trial{strain, input.temperature, input.temperature_increment, input.dt};
  ThicknessSearch search[lanes];
  double floor[lanes];
  for (int l = 0; l < lanes; ++l) {
    const double size = std::abs(strain[0][l]) + std::abs(strain[1][l]) + std::abs(strain[3][l]);
    floor[l] = round_off * (modulus * size + std::abs(stress[0][l]) + std::abs(stress[1][l]) + std::abs(stress[2][l]));
    search[l].start(expansion * input.temperature_increment[0][l] - ratio * (strain[0][l] + strain[1][l]) -
                        stress_before[2][l] / modulus,
                    modulus);
  }
  for (int i = 0; i < budget; ++i) {
    stress = stress_before, state = state_before;
    for (int l = 0; l < lanes; ++l) strain[2][l] = search[l].strain();
    material.update(trial, stress, state, plastic_work);
    bool left = false;
    for (int l = 0; l < lanes; ++l) {
      const double size = std::abs(stress[0][l]) + std::abs(stress[1][l]) + std::abs(stress[3][l]);
      search[l].take(stress[2][l], std::max(tolerance * size, floor[l]));
      left |= search[l].searching();
    }
    if (!left) break;
  }
  for (int l = 0; l < lanes; ++l) thickness_increment[0][l] = strain[2][l];
}

}  // namespace tenon

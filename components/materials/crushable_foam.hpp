// SPDX-License-Identifier: BSD-3-Clause
// Foam that is crushed without spreading sideways, until it locks.
#pragma once

#include <array>
#include <string_view>

#include "components/materials/material_concept.hpp"
#include "components/materials/piecewise_linear.hpp"

namespace tenon {

/// Each principal stress is elastic and held between -yield_stress(crush) and tension_cutoff, independently of the
/// others: plastic Poisson's ratio zero ([Hal06] material 63). `crush` is the greatest compaction 1 - V/V0 so far: what
/// was crushed once stays as strong. Where the table is steeper than the material is stiff (locking), the compacted
/// material is stiffer: its modulus is at least `lead` times the slope of the table over the logarithmic strain, so
/// that the stress keeps up with the table. Beyond its end the table goes on with its last slope.
struct CrushableFoam {
  static constexpr int state_size = 1;
  static constexpr std::array<std::string_view, 1> state_names{"crush"};
  static constexpr bool needs_volume_ratio = true;
  static constexpr bool flows = true;
  static constexpr double lead = 1.25;

  Elasticity elasticity;         ///< uncrushed
  PiecewiseLinear yield_stress;  ///< Pa, positive, over 1 - V/V0 from 0
  double tension_cutoff = 0;     ///< Pa, not negative

  void update(const UpdateInput& input, Batch<6>& stress, Batch<1>& state, Batch<1>& plastic_work) const;
  void stiffness(const UpdateInput& input, const Batch<6>& stress, const Batch<1>& state, Batch<2>& moduli) const;
  /// Of the elastic trial of the last update, without looking ahead.
  void trial_shear(const UpdateInput& input, Batch<1>& shear) const;
};

}  // namespace tenon

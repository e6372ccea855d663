// SPDX-License-Identifier: BSD-3-Clause
// Soil that is compacted for good, and whose shear strength depends on the pressure.
#pragma once

#include <array>
#include <string_view>

#include "components/materials/material_concept.hpp"
#include "components/materials/piecewise_linear.hpp"

namespace tenon {

/// [Kri72]. Pressure (positive in compression): first loading follows `pressure` over the compaction -ln(V/V0); below
/// the greatest compaction so far it unloads and reloads with the bulk modulus, down to -tension_cutoff. Deviator: q^2
/// <= 3 (a0 + a1 p + a2 p^2), returned radially at the pressure of the step's end. `eqps` is that of shear alone.
/// Beyond its end the table goes on with its last slope, which is nowhere more than the bulk modulus.
struct Soil {
  static constexpr int state_size = 2;
  static constexpr std::array<std::string_view, 2> state_names{"eqps", "compaction"};
  static constexpr bool needs_volume_ratio = true;

  Elasticity elasticity;      ///< shear, and unloading of volume
  PiecewiseLinear pressure;   ///< Pa over -ln(V/V0), from 0 at 0
  double a0 = 0;              ///< Pa^2
  double a1 = 0;              ///< Pa
  double a2 = 0;              ///< 1
  double tension_cutoff = 0;  ///< Pa, not negative

  void update(const UpdateInput& input, Batch<6>& stress, Batch<2>& state, Batch<1>& plastic_work) const;
};

}  // namespace tenon

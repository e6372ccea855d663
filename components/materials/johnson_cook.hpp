// SPDX-License-Identifier: BSD-3-Clause
// Von Mises plasticity with the Johnson-Cook flow stress: strain hardening, rate hardening, thermal softening.
#pragma once

#include <array>
#include <string_view>

#include "components/materials/material_concept.hpp"

namespace tenon {

/// Constants of [JC83]: sigma_y = (A + B eqps^n) (1 + C ln max(1, rate / reference_strain_rate)) (1 - T*^m),
/// T* = (T - reference_temperature) / (melting_temperature - reference_temperature), held within 0 and 1.
struct JohnsonCookParameters {
  double A = 0;  ///< Pa
  double B = 0;  ///< Pa
  double n = 1;
  double C = 0;
  double m = 1;
  double reference_strain_rate = 1;  ///< 1/s
  double reference_temperature = 0;  ///< K
  double melting_temperature = 0;    ///< K
};

/// Radial return with the flow stress of the step's end (plastic strain, its rate d_eqps/dt, temperature), solved at
/// each point by a bracketed Newton iteration to round-off. Plastic work is the trapezium over the plastic strain of
/// the step at the rate and temperature of its end. Above melting the strength is zero: the deviator vanishes.
struct JohnsonCook {
  static constexpr int state_size = 2;
  /// The rate (1/s) of the last step is also the first guess for the next.
  static constexpr std::array<std::string_view, 2> state_names{"eqps", "eqps_rate"};

  Elasticity elasticity;
  JohnsonCookParameters flow;

  void update(const UpdateInput& input, Batch<6>& stress, Batch<2>& state, Batch<1>& plastic_work) const;
};

}  // namespace tenon

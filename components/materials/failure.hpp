// SPDX-License-Identifier: BSD-3-Clause
// When a point of a material fails: the criterion by which elements are eroded.
#pragma once

#include <optional>

#include "components/materials/batch.hpp"

namespace tenon {

/// What a criterion may look at, after the update of a batch.
struct FailureInput {
  const Batch<6>& stress;            ///< Cauchy, Pa
  const Batch<1>& eqps_before;       ///< equivalent plastic strain at the step's start; 0 if the material has none
  const Batch<1>& eqps;              ///< and at its end
  const Batch<1>& temperature;       ///< K
  const Batch<6>& strain_increment;  ///< over the step
  double dt;                         ///< s
};

/// Plastic strain at fracture [JC85]: (D1 + D2 exp(D3 m / q)) (1 + D4 ln max(1, rate / reference_strain_rate))
/// (1 + D5 T*), m the mean stress (tension positive), q von Mises; T* as in the Johnson-Cook flow stress.
struct JohnsonCookDamage {
  double D1 = 0, D2 = 0, D3 = 0, D4 = 0, D5 = 0;
  double reference_strain_rate = 1;      ///< 1/s
  double reference_temperature = 0;      ///< K
  double melting_temperature = 0;        ///< K
  static constexpr double least = 1e-6;  ///< what the plastic strain at fracture never falls below
};

/// Damage grows from 0; a point has failed where it reaches 1. Limits that are not given do not count. An increment of
/// plastic strain adds its share of the plastic strain at fracture (the smaller one, if there are two).
struct FailureCriterion {
  std::optional<double> plastic_strain;    ///< eqps at failure
  std::optional<double> tensile_stress;    ///< greatest principal stress, Pa
  std::optional<double> spall_pressure{};  ///< mean tensile stress, Pa
  std::optional<JohnsonCookDamage> johnson_cook{};

  bool needs_plastic_strain() const { return plastic_strain || johnson_cook; }
  /// Raises `damage`, never lowers it. Lane by lane; the same bits wherever a point stands.
  void accumulate(const FailureInput& input, Batch<1>& damage) const;
};

}  // namespace tenon

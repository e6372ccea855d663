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

/// Damage grows from 0; a point has failed where it reaches 1. Limits that are not given do not count.
struct FailureCriterion {
  std::optional<double> plastic_strain;  ///< eqps at failure
  std::optional<double> tensile_stress;  ///< greatest principal stress, Pa

  /// Raises `damage`, never lowers it. Lane by lane; the same bits wherever a point stands.
  void accumulate(const FailureInput& input, Batch<1>& damage) const;
};

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Hypoelastic isotropic material with thermal expansion.
#pragma once

#include <array>
#include <string_view>

#include "components/materials/material_concept.hpp"

namespace tenon {

/// Stress increment = C : (strain increment - alpha dT I); no history.
struct LinearElastic {
  static constexpr int state_size = 0;
  static constexpr std::array<std::string_view, 0> state_names{};

  Elasticity elasticity;

  void update(const UpdateInput& input, Batch<6>& stress, Batch<1>& state, Batch<1>& plastic_work) const;
  void update_plane_stress(const UpdateInput& input, Batch<6>& stress, Batch<1>& state, Batch<1>& plastic_work,
                           Batch<1>& thickness_increment) const;
};

}  // namespace tenon

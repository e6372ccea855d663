// SPDX-License-Identifier: BSD-3-Clause
// Linear elasticity with three planes of symmetry, which turn with the material.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "components/materials/material_concept.hpp"

namespace tenon {

/// Strain ij of a stress along i: -nu_ij / E_i; nu_ji = nu_ij E_j / E_i.
struct OrthotropicParameters {
  double E1 = 0, E2 = 0, E3 = 0;        ///< Pa
  double nu12 = 0, nu23 = 0, nu31 = 0;  ///< 1
  double G12 = 0, G23 = 0, G31 = 0;     ///< Pa
  double axis_1[3] = {1, 0, 0};         ///< unit vectors, orthogonal
  double axis_2[3] = {0, 1, 0};
};

/// Stress increment = C : (strain increment - alpha dT I) in the axes of the material, [Jon99] ch. 2.
struct OrthotropicElastic {
  static constexpr int state_size = 6;
  static constexpr std::array<std::string_view, 6> state_names{"axis_1_x", "axis_1_y", "axis_1_z",
                                                               "axis_2_x", "axis_2_y", "axis_2_z"};
  static constexpr std::array<int, 2> rotating_vectors{0, 3};

  Elasticity elasticity;  ///< isotropic, nowhere softer: bounds wave speeds and element stiffness from above
  double normal[3][3];    ///< C of the normal components, Pa
  double shear[3];        ///< 2 G12, 2 G23, 2 G31
  double start[6];        ///< axes of the undeformed body

  /// The law of these constants.
  OrthotropicElastic(const OrthotropicParameters& p, double expansion);
  /// Why no stable material has these constants (its energy would be negative), or nothing.
  static std::optional<std::string> objection(const OrthotropicParameters& p);

  double initial_state(int i) const { return start[i]; }
  void update(const UpdateInput& input, Batch<6>& stress, Batch<6>& state, Batch<1>& plastic_work) const;
};

}  // namespace tenon

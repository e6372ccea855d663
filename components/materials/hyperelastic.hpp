// SPDX-License-Identifier: BSD-3-Clause
// Rubber: compressible neo-Hookean and Mooney-Rivlin elasticity.
#pragma once

#include <array>
#include <string_view>

#include "components/materials/material_concept.hpp"

namespace tenon {

struct MooneyRivlinParameters {
  double C10 = 0;           ///< Pa, positive; the shear modulus is 2 (C10 + C01)
  double C01 = 0;           ///< Pa, not negative; 0: neo-Hookean
  double bulk_modulus = 0;  ///< Pa, positive
};

/// Energy per undeformed volume, J/m^3: C10 (I1 - 3) + C01 (I2 - 3) + K/2 ((Je^2 - 1)/2 - ln Je), [Hol00] ch. 6.4; I1
/// and I2 of the volume-free B = J^(-2/3) F F^T, and Je = J exp(-3 thermal strain). The stress follows from F alone, so
/// that neither steps nor turns leave an error behind; the state only sums the thermal strain up.
struct MooneyRivlin {
  static constexpr int state_size = 1;
  static constexpr std::array<std::string_view, 1> state_names{"thermal_strain"};
  static constexpr bool needs_deformation_gradient = true;

  Elasticity elasticity;
  MooneyRivlinParameters rubber;

  /// Moduli of small strains, with the given expansion.
  static Elasticity small_strain(const MooneyRivlinParameters& rubber, double expansion);

  void update(const UpdateInput& input, Batch<6>& stress, Batch<1>& state, Batch<1>& plastic_work) const;
  /// Row 0 + 2 row 1 is no less than rho c^2 of any wave that the strained material carries in any direction, row 1 no
  /// less than that of any pure shear wave; exact without strain.
  void stiffness(const UpdateInput& input, const Batch<6>& stress, const Batch<1>& state, Batch<2>& moduli) const;
  /// J/m^3 of undeformed volume.
  double energy(const double (&F)[9], double thermal_strain = 0) const;
};

}  // namespace tenon

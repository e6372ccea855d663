// SPDX-License-Identifier: BSD-3-Clause
// Isotropic linear elasticity with thermal expansion, shared by all materials.
#pragma once

namespace tenon {

/// Isotropic constants of the stress rate: sigma' = lambda tr(D - alpha T' I) I + 2 G (D - alpha T' I).
struct Elasticity {
  double youngs_modulus = 0;  ///< Pa
  double poissons_ratio = 0;
  double expansion = 0;  ///< linear coefficient alpha, 1/K

  double shear_modulus() const { return youngs_modulus / (2 * (1 + poissons_ratio)); }
  double bulk_modulus() const { return youngs_modulus / (3 * (1 - 2 * poissons_ratio)); }
  double lame_lambda() const {
    return youngs_modulus * poissons_ratio / ((1 + poissons_ratio) * (1 - 2 * poissons_ratio));
  }
  /// rho c_L^2, Pa: modulus of the fastest wave.
  double p_wave_modulus() const { return lame_lambda() + 2 * shear_modulus(); }
};

}  // namespace tenon

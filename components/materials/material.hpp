// SPDX-License-Identifier: BSD-3-Clause
// All materials: their description, and the choice that is made once per block.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>

#include "components/materials/elasticity.hpp"
#include "components/materials/failure.hpp"
#include "components/materials/j2_linear_hardening.hpp"
#include "components/materials/johnson_cook.hpp"
#include "components/materials/linear_elastic.hpp"
#include "components/materials/temperature_table.hpp"
#include "framework/base/types.hpp"

namespace tenon {

struct LinearHardeningParameters {
  double yield_stress = 0;       ///< Pa
  double hardening_modulus = 0;  ///< Pa
};

struct ThermalProperties {
  double conductivity = 0;                ///< W/(m K)
  double specific_heat = 0;               ///< J/(kg K)
  double reference_temperature = 293.15;  ///< K: start temperature where no other is given, zero of the thermal energy
  double taylor_quinney = 0.9;            ///< share of plastic work that becomes heat
  /// Over temperature, for conduction; then the two numbers above are the values at the reference temperature.
  std::optional<TemperatureTable> conductivity_over_temperature = {}, specific_heat_over_temperature = {};
  std::optional<std::array<Vec3, 3>> conductivity_tensor = {};  ///< W/(m K); takes the place of the number
  double latent_heat = 0, solidus = 0, liquidus = 0;            ///< J/kg, K, K; no change of phase without latent heat
};

/// A material as a scene states it. Mechanics needs `elastic`; conduction and plastic heat need `thermal`.
struct MaterialDescription {
  std::string name;
  double density = 0;                 ///< kg/m^3, of the reference configuration
  std::optional<Elasticity> elastic;  ///< its `expansion` comes from the thermal block
  std::variant<std::monostate, LinearHardeningParameters, JohnsonCookParameters> plasticity;
  std::optional<ThermalProperties> thermal;
  std::optional<FailureCriterion> failure;
};

/// Chosen once per block or batch by std::visit, never per point.
using AnyMaterial = std::variant<LinearElastic, J2LinearHardening, JohnsonCook>;

/// Throws Error(usage) if the description has no elastic constants.
AnyMaterial make_material(const MaterialDescription& description);

/// History values per point, and the name of each.
int state_size(const AnyMaterial& material);
std::string state_name(const AnyMaterial& material, int i);

}  // namespace tenon

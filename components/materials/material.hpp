// SPDX-License-Identifier: BSD-3-Clause
// A material as a scene describes it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>

#include "components/materials/elasticity.hpp"
#include "components/materials/equation_of_state.hpp"
#include "components/materials/failure.hpp"
#include "components/materials/mechanical_law.hpp"
#include "components/materials/temperature_table.hpp"
#include "framework/base/types.hpp"

namespace tenon {

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

/// A material as a scene states it. Mechanics needs `elastic` or `whole_law`; conduction and plastic heat need
/// `thermal`.
struct MaterialDescription {
  std::string name;
  double density = 0;                 ///< kg/m^3, of the reference configuration
  std::optional<Elasticity> elastic;  ///< its `expansion` comes from the thermal block; moduli of small strains if the
                                      ///< law is another one
  PlasticityParameters plasticity;
  std::optional<ThermalProperties> thermal;
  std::optional<FailureCriterion> failure;
  WholeLawParameters whole_law{};                      ///< rubber, orthotropic, foam, soil
  std::optional<EquationOfState> equation_of_state{};  ///< pressure in place of the elastic one
  std::optional<double> viscosity{};                   ///< of fluids, Pa s
};

}  // namespace tenon

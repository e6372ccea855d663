// SPDX-License-Identifier: BSD-3-Clause
// The constants of every mechanical law, as a scene states them.
#pragma once

#include <utility>
#include <variant>
#include <vector>

#include "components/materials/flow_curves.hpp"
#include "components/materials/hyperelastic.hpp"
#include "components/materials/j2_kinematic.hpp"
#include "components/materials/johnson_cook.hpp"
#include "components/materials/orthotropic_elastic.hpp"

namespace tenon {

struct LinearHardeningParameters {
  double yield_stress = 0;       ///< Pa
  double hardening_modulus = 0;  ///< Pa
  CowperSymonds rate{};
};

struct VoceHardeningParameters {
  VoceFlow flow;
  CowperSymonds rate{};
};

struct TableHardeningParameters {
  std::vector<std::pair<double, double>> flow_stress;  ///< Pa over eqps, from 0
  CowperSymonds rate{};
};

/// What flows, on top of isotropic elasticity.
using PlasticityParameters =
    std::variant<std::monostate, LinearHardeningParameters, JohnsonCookParameters, VoceHardeningParameters,
                 TableHardeningParameters, KinematicHardeningParameters>;

struct FoamParameters {
  std::vector<std::pair<double, double>> yield_stress;  ///< Pa over 1 - V/V0, from 0
  double tension_cutoff = 0;                            ///< Pa
};

struct SoilParameters {
  std::vector<std::pair<double, double>> pressure;  ///< Pa over -ln(V/V0), from 0 at 0
  double a0 = 0, a1 = 0, a2 = 0;                    ///< Pa^2, Pa, 1
  double tension_cutoff = 0;                        ///< Pa
};

/// Laws that are whole by themselves. Foam and soil are elastic within their yield surface; the others need no
/// isotropic constants.
using WholeLawParameters =
    std::variant<std::monostate, MooneyRivlinParameters, OrthotropicParameters, FoamParameters, SoilParameters>;

}  // namespace tenon

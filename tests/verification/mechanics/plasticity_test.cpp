// SPDX-License-Identifier: BSD-3-Clause
// One element pulled far beyond yield: stress (case A08 a) and adiabatic heat (F01).
#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

constexpr double youngs_modulus = 200e9, yield_stress = 400e6, hardening_modulus = 1e9;

/// Pulls a cube with free sides to the logarithmic strain `strain`, slowly.
std::unique_ptr<Mechanics> pulled(double strain) {
  MaterialDescription material = elastic_material(youngs_modulus, 0.3, 7850);
  material.plasticity = LinearHardeningParameters{yield_stress, hardening_modulus};
  material.thermal = ThermalProperties{50, 460, 300, 0.9};
  MechanicsOptions options;
  options.heat = HeatMode::adiabatic;
  PrescribedMotion pull = motion(Kind::displacement, {"x_max"});
  pull.components = {true, false, false};
  const double end = 0.5;  // hundreds of periods
  pull.value[0] = TimeFunction::smooth_step(0, std::exp(strain) - 1, 0, end);
  options.motions = {symmetry("x_min", {1, 0, 0}), symmetry("y_min", {0, 1, 0}), symmetry("z_min", {0, 0, 1}), pull};
  auto m = body(shared_mesh(on_root(BoxShape{})), material, options);
  m->initialize();
  run_to(*m, end);
  return m;
}

TEST(OneElement, UniaxialPlasticStressAndStrain) {
  for (const double strain : {0.05, 0.3}) {
    const auto m = pulled(strain);
    const double slope = youngs_modulus * hardening_modulus / (youngs_modulus + hardening_modulus);
    const double expected = yield_stress + slope * (strain - yield_stress / youngs_modulus);
    const std::vector<double> stress = field(*m, "stress"), eqps = field(*m, "eqps");
    if (stress.empty()) continue;
    EXPECT_NEAR(stress[0], expected, 1e-3 * expected);
    EXPECT_NEAR(eqps[0], strain - expected / youngs_modulus, 1e-3 * strain);
    EXPECT_NEAR(stress[1], 0, 1e-3 * expected);
  }
}

TEST(OneElement, AdiabaticHeatingIsF01) {
  const auto m = pulled(0.5);
  const std::vector<double> temperature = field(*m, "temperature");
  if (!temperature.empty()) {
    EXPECT_NEAR(temperature[0] - 300, 80.0006, 0.002 * 80);
  }
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// The energy balance closes to round-off in every step, whatever the loads, the motion and the solver's tolerance.
#include <gtest/gtest.h>

#include "thermal_case.hpp"

namespace tenon::testing {
namespace {

class Balanced : public ::testing::TestWithParam<std::tuple<ThermalStepper, bool, double>> {};

TEST_P(Balanced, InEveryStep) {
  const auto [stepper, tetrahedra, tolerance] = GetParam();
  ThermalOptions options = all_loads(stepper);
  options.tolerance = tolerance;
  Thermal thermal("heat", distributed(cube(4, tetrahedra, 0.15)), options);
  thermal.initialize();
  for (int step = 0; step < 8; ++step) {
    if (step % 3 == 1) disturb(thermal, 0.01 * step / 8);
    thermal.advance(std::min(thermal.time_step(), 40.0));
    EXPECT_LT(balance(thermal).error(), 1e-13) << step;
  }
  for (const char* row : {"transferred_heat", "flux_heat", "convection_heat", "source_heat", "prescribed_heat"})
    EXPECT_GT(std::abs(energy(thermal, row)), 1e-3) << row;
}

INSTANTIATE_TEST_SUITE_P(Steppers, Balanced,
                         ::testing::Combine(::testing::Values(ThermalStepper::explicit_euler,
                                                              ThermalStepper::backward_euler,
                                                              ThermalStepper::crank_nicolson, ThermalStepper::tr_bdf2,
                                                              ThermalStepper::steady),
                                            ::testing::Bool(), ::testing::Values(1e-12, 1e-3)));

class BalancedNonlinear : public ::testing::TestWithParam<ThermalStepper> {};

TEST_P(BalancedNonlinear, InEveryStep) {
  Thermal thermal("heat", distributed(cube(4, true, 0.15)), all_loads_warm(GetParam()));
  thermal.initialize();
  for (int step = 0; step < 6; ++step) {
    if (step % 3 == 1) disturb(thermal, 0.01 * step / 8);
    thermal.advance(std::min(thermal.time_step(), 40.0));
    EXPECT_LT(balance(thermal).error(), 1e-12) << step;
  }
  EXPECT_GT(std::abs(energy(thermal, "radiation_heat")), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Steppers, BalancedNonlinear,
                         ::testing::Values(ThermalStepper::backward_euler, ThermalStepper::crank_nicolson,
                                           ThermalStepper::tr_bdf2, ThermalStepper::steady));

TEST(Thermal, TransferredHeatIsStoredAtOnceAndWarmsInTheNextStep) {
  ThermalOptions options;
  options.blocks = {{"box", 1000, 500, 10, 300}};
  Thermal thermal("heat", distributed(cube(2)), options);
  thermal.initialize();
  std::vector<double> heat(static_cast<std::size_t>(thermal.mesh().nodes()), 1000.0);
  import_port(thermal, "heat").write(heat);
  import_port(thermal, "heat").write(heat);
  EXPECT_EQ(energy(thermal, "transferred_heat"), 54000);
  EXPECT_EQ(energy(thermal, "thermal_energy"), 54000);
  EXPECT_EQ(temperature_at(thermal, {0, 0, 0}), 300);
  thermal.advance(thermal.time_step());
  EXPECT_NEAR(energy(thermal, "thermal_energy"), 54000, 1e-9);
  EXPECT_GT(temperature_at(thermal, {0, 0, 0}), 300);
}

TEST(Thermal, UniformTemperatureStaysBitForBit) {
  for (const ThermalStepper stepper : {ThermalStepper::explicit_euler, ThermalStepper::crank_nicolson}) {
    ThermalOptions options;
    options.blocks = {{"box", 8960, 383, 386, 293.15}};
    options.stepper = stepper;
    if (stepper != ThermalStepper::explicit_euler) options.fixed_step = 1;
    Thermal thermal("heat", distributed(cube(3, true, 0.2)), options);
    thermal.initialize();
    for (int i = 0; i < 5; ++i) thermal.advance(thermal.time_step());
    for (const double t : thermal.temperature()) EXPECT_EQ(t, 293.15);
  }
}

TEST(Thermal, LinearFieldBetweenPrescribedEndsIsSteady) {
  ThermalOptions options;
  options.blocks = {{"box", 1, 1, 2, 0}};
  options.stepper = ThermalStepper::backward_euler;
  options.fixed_step = 10;
  options.initial = {{"", "", 300, {50, 0, 0}}};
  options.prescribed = {{"x_min", TimeFunction::constant(300)}, {"x_max", TimeFunction::constant(350)}};
  Thermal thermal("heat", distributed(cube(4, false, 0.2)), options);
  thermal.initialize();
  for (int i = 0; i < 10; ++i) thermal.advance(10);
  const Mesh& mesh = thermal.mesh();
  for (std::size_t n = 0; n < mesh.coordinates.size(); ++n)
    EXPECT_NEAR(thermal.temperature()[n], 300 + 50 * mesh.coordinates[n][0], 1e-10);
  std::vector<double> flux(3 * static_cast<std::size_t>(mesh.elements()));
  thermal.exports()[1].read(flux);
  for (std::size_t i = 0; i < flux.size(); ++i) EXPECT_NEAR(flux[i], i % 3 == 0 ? -100 : 0, 1e-9);
}

}  // namespace
}  // namespace tenon::testing

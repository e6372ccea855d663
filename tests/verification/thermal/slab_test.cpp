// SPDX-License-Identifier: BSD-3-Clause
// Cases D04 (semi-infinite body: step of temperature, constant flux) and D07 (slab with convection) [CJ59].
#include <gtest/gtest.h>

#include "thermal_case.hpp"

namespace tenon::testing {
namespace {

constexpr double conductivity = 40, diffusivity = 1e-5;

ThermalOptions slab(ThermalStepper stepper, double dt) {
  ThermalOptions options;
  options.blocks = {material(conductivity, diffusivity)};
  options.stepper = stepper;
  if (stepper != ThermalStepper::explicit_euler) options.fixed_step = dt;
  return options;
}

class Slabs : public ::testing::TestWithParam<ThermalStepper> {};

TEST_P(Slabs, StepOfTemperatureAtTheSurface) {
  ThermalOptions options = slab(GetParam(), 0.1);
  options.step_scale = 0.2;  // what the sudden step asks of the explicit stepper
  options.prescribed = {{"x_min", TimeFunction::constant(1)}};
  Thermal thermal("heat", distributed(bar(0.3, 60)), options);
  thermal.initialize();
  for (const double t : {10.0, 20.0, 40.0}) {
    run_until(thermal, t);
    for (int i = 0; i <= 20; ++i) {
      const double x = 0.005 * i, exact = std::erfc(x / (2 * std::sqrt(diffusivity * t)));
      EXPECT_NEAR(temperature_at(thermal, {x, 0, 0}), exact, 0.01) << x << " m, " << t << " s";
    }
  }
  EXPECT_NEAR(temperature_at(thermal, {0.02, 0, 0}), 0.4795, 0.01);
}

// The step that a scene gets without a word: a sudden change is followed less closely, but the temperature stays within
// the bounds of the exact solution and close to it.
TEST(Slab, StepOfTemperatureAtTheDefaultExplicitStep) {
  ThermalOptions options = slab(ThermalStepper::explicit_euler, 0);
  options.prescribed = {{"x_min", TimeFunction::constant(1)}};
  Thermal thermal("heat", distributed(bar(0.3, 60)), options);
  thermal.initialize();
  EXPECT_NEAR(thermal.time_step(), 0.9 * thermal.stable_limit(), 1e-15);
  for (const double t : {10.0, 20.0, 40.0}) {
    run_until(thermal, t);
    double worst = 0;
    for (int i = 0; i <= 20; ++i) {
      const double x = 0.005 * i, exact = std::erfc(x / (2 * std::sqrt(diffusivity * t)));
      worst = std::max(worst, std::abs(temperature_at(thermal, {x, 0, 0}) - exact));
    }
    std::printf("explicit, default step, %g s: error %.4f of the step\n", t, worst);
    EXPECT_LT(worst, t < 20 ? 0.015 : 0.01);
  }
  for (const double temperature : thermal.temperature()) EXPECT_TRUE(temperature >= 0 && temperature <= 1);
}

TEST_P(Slabs, ConstantFlux) {
  ThermalOptions options = slab(GetParam(), 0.1);
  options.fluxes = {{"x_min", TimeFunction::constant(1e5)}};
  Thermal thermal("heat", distributed(bar(0.3, 60)), options);
  thermal.initialize();
  run_until(thermal, 20);
  for (const auto& [x, rise] : {std::pair{0.0, 39.8942280401},
                                {0.01, 19.7796557401},
                                {0.02, 8.33154705877},
                                {0.04, 0.849070261683},
                                {0.1, 5.54616553383e-6}})
    EXPECT_NEAR(temperature_at(thermal, {x, 0, 0}), rise, 0.01 * 39.9) << x;
  EXPECT_NEAR(energy(thermal, "flux_heat"), 1e5 * 0.005 * 0.005 * 20, 1e-10);
  EXPECT_LT(balance(thermal).error(), 1e-13);
}

TEST_P(Slabs, Convection) {
  ThermalOptions options = slab(GetParam(), 0.5);
  options.initial = {{"", "", 1, {}}};
  options.convection = {{"x_max", 800, TimeFunction::constant(0)}};
  Thermal thermal("heat", distributed(bar(0.05, 20)), options);
  thermal.initialize();
  const double table[][3] = {{25, 0.993108254805, 0.723577238669},
                             {50, 0.950641778505, 0.643390784477},
                             {100, 0.83095036268, 0.544170776335},
                             {200, 0.619027095983, 0.403740430133},
                             {400, 0.342417397418, 0.22331936327}};
  for (const auto& [t, centre, surface] : table) {
    run_until(thermal, t);
    EXPECT_NEAR(temperature_at(thermal, {0, 0, 0}), centre, 0.005) << t;
    EXPECT_NEAR(temperature_at(thermal, {0.05, 0, 0}), surface, 0.005) << t;
    EXPECT_LT(balance(thermal).error(), 1e-13);
  }
}

INSTANTIATE_TEST_SUITE_P(Steppers, Slabs,
                         ::testing::Values(ThermalStepper::explicit_euler, ThermalStepper::backward_euler,
                                           ThermalStepper::crank_nicolson));

}  // namespace
}  // namespace tenon::testing

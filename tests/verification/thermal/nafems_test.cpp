// SPDX-License-Identifier: BSD-3-Clause
// Cases D02 (NAFEMS T3, transient) and D03 (NAFEMS T4, steady with convection) [NAF90].
#include <gtest/gtest.h>

#include <numbers>

#include "thermal_case.hpp"

namespace tenon::testing {
namespace {

constexpr double zero_celsius = 273.15;

/// T(0.08 m, 32 s) of a bar, 0 at one end, 100 sin(pi t / 40) at the other, degC.
double transient_bar(int n, double dt) {
  ThermalOptions options;
  options.blocks = {{"box", 7200, 440.5, 35, zero_celsius}};
  options.stepper = ThermalStepper::crank_nicolson;
  options.fixed_step = dt;
  options.prescribed = {{"x_min", TimeFunction::constant(zero_celsius)},
                        {"x_max", TimeFunction::sine(100, 80, 0, zero_celsius)}};
  Thermal thermal("heat", distributed(bar(0.1, n)), options);
  thermal.initialize();
  run_until(thermal, 32);
  EXPECT_LT(balance(thermal).error(), 1e-13);
  return temperature_at(thermal, {0.08, 0, 0}) - zero_celsius;
}

TEST(NafemsT3, TransientBar) {
  const double exact = 36.60311595, expected[] = {-0.68, -0.19, -0.048};
  double error[3];
  for (int i = 0; i < 3; ++i) {
    error[i] = transient_bar(10 << i, 1.0 / (1 << i)) - exact;
    EXPECT_NEAR(error[i], expected[i], 0.03 * std::abs(expected[i]) + 0.005) << (10 << i);
  }
  EXPECT_NEAR(std::log2(error[1] / error[2]), 2, 0.1);
}

struct Plate {
  double corner, inside;  // T at (0.6, 0.2) and (0.2, 0.4), degC
};

/// Steady plate, 0.6 m x 1 m, in one step.
Plate steady_plate(int n) {
  BoxShape shape;
  shape.high = {0.6, 1.0, 0.1};
  shape.elements = {6 * n, 10 * n, 1};
  ThermalOptions options;
  options.blocks = {{"box", 1000, 1, 52, zero_celsius}};
  options.stepper = ThermalStepper::steady;
  options.prescribed = {{"y_min", TimeFunction::constant(zero_celsius + 100)}};
  options.convection = {{"x_max", 750, TimeFunction::constant(zero_celsius)},
                        {"y_max", 750, TimeFunction::constant(zero_celsius)}};
  Thermal thermal("heat", distributed(shape), options);
  thermal.initialize();
  thermal.advance(1);
  EXPECT_LT(balance(thermal).error(), 1e-12);
  return {temperature_at(thermal, {0.6, 0.2, 0}) - zero_celsius, temperature_at(thermal, {0.2, 0.4, 0}) - zero_celsius};
}

TEST(NafemsT4, SteadyPlateWithConvection) {
  const double bound[] = {0.1, 0.01, 0.005};
  double error[3];
  for (int i = 0; i < 3; ++i) {
    const Plate plate = steady_plate(1 << i);
    error[i] = plate.corner - 18.2537565371;
    EXPECT_LT(std::abs(error[i]), bound[i]) << error[i];
    EXPECT_NEAR(plate.inside, 41.8071440977, 0.5 / (1 << (2 * i)));
  }
}

}  // namespace
}  // namespace tenon::testing

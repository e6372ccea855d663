// SPDX-License-Identifier: BSD-3-Clause
// Case D01: decay of a cosine in an insulated cube, orders in space and time, limit of the explicit step.
#include <gtest/gtest.h>

#include <numbers>

#include "thermal_case.hpp"

namespace tenon::testing {
namespace {

constexpr double pi = std::numbers::pi;

double cosine(const Vec3& x) {
  return std::cos(pi * x[0]) * std::cos(pi * x[1]) * std::cos(pi * x[2]);
}

/// sum T cos / sum cos^2 over the nodes.
double amplitude(const Thermal& thermal) {
  ExactSum above, below;
  for (const LocalIndex owned : thermal.mesh().owned_nodes) {
    const auto n = static_cast<std::size_t>(owned);
    const double mode = cosine(thermal.mesh().coordinates[n]);
    above.add(mode * thermal.temperature()[n]);
    below.add(mode * mode);
  }
  return thermal.mesh().comm.sum(above) / thermal.mesh().comm.sum(below);
}

std::unique_ptr<Thermal> cosine_cube(const BoxShape& shape, ThermalStepper stepper, double dt) {
  ThermalOptions options;
  options.blocks = {material(1, 1)};
  options.stepper = stepper;
  if (dt > 0) options.fixed_step = dt;
  options.initial_function = cosine;
  auto thermal = std::make_unique<Thermal>("heat", distributed(shape), options);
  thermal->initialize();
  return thermal;
}

/// Relative error of the decay rate 3 pi^2 over `time`.
double rate_error(const BoxShape& shape, double time, int steps) {
  const auto thermal = cosine_cube(shape, ThermalStepper::crank_nicolson, time / steps);
  const double start = amplitude(*thermal);
  run_until(*thermal, time);
  return -std::log(amplitude(*thermal) / start) / time / (3 * pi * pi) - 1;
}

TEST(CosineDecay, HexErrorIsThatOfLumpedTrilinearElements) {
  const double expected[] = {-0.227, -0.062, -0.016};
  double error[3];
  for (int i = 0; i < 3; ++i) {
    error[i] = rate_error(cube(4 << i), 0.02, 40);
    EXPECT_NEAR(error[i], expected[i], 0.002) << (4 << i);
  }
  EXPECT_NEAR(std::log2(error[1] / error[2]), 2, 0.1);
}

/// Relative error of the nodal temperatures, root mean square, at t = 0.05.
double field_error(const BoxShape& shape) {
  const double time = 0.05, decay = std::exp(-3 * pi * pi * time);
  const auto thermal = cosine_cube(shape, ThermalStepper::crank_nicolson, time / 50);
  run_until(*thermal, time);
  ExactSum error, size;
  for (const LocalIndex owned : thermal->mesh().owned_nodes) {
    const auto n = static_cast<std::size_t>(owned);
    const double exact = decay * cosine(thermal->mesh().coordinates[n]), d = thermal->temperature()[n] - exact;
    error.add(d * d), size.add(exact * exact);
  }
  return std::sqrt(thermal->mesh().comm.sum(error) / thermal->mesh().comm.sum(size));
}

TEST(CosineDecay, TetErrorIsOfSecondOrder) {
  double error[3];
  for (int i = 0; i < 3; ++i) error[i] = field_error(cube(4 << i, true));
  EXPECT_LT(error[2], 0.03);
  EXPECT_NEAR(std::log2(error[1] / error[2]), 2, 0.15) << error[0] << " " << error[1] << " " << error[2];
}

TEST(CosineDecay, DistortedMeshesConverge) {
  for (const bool tetrahedra : {false, true}) {
    const double coarse = std::abs(rate_error(cube(8, tetrahedra, 0.2), 0.02, 20));
    const double fine = std::abs(rate_error(cube(16, tetrahedra, 0.2), 0.02, 20));
    EXPECT_LT(fine, 0.03);
    EXPECT_GT(std::log2(coarse / fine), 1.6) << tetrahedra;
  }
}

/// The cosine is a mode of the regular mesh, with the rate 6 (1 - c)/h^2 ((2 + c)/3)^2, c = cos(pi h).
double discrete_rate(int n) {
  const double h = 1.0 / n, c = std::cos(pi * h);
  return 6 * (1 - c) / (h * h) * std::pow((2 + c) / 3, 2);
}

TEST(CosineDecay, OrdersInTime) {
  const auto error = [](ThermalStepper stepper, int steps) {
    const double time = 0.1;
    const auto thermal = cosine_cube(cube(6), stepper, time / steps);
    run_until(*thermal, time);
    return std::abs(amplitude(*thermal) - std::exp(-discrete_rate(6) * time));
  };
  const auto order = [&](ThermalStepper stepper, int steps) {
    return std::log2(error(stepper, steps) / error(stepper, 2 * steps));
  };
  EXPECT_NEAR(order(ThermalStepper::explicit_euler, 40), 1, 0.1);
  EXPECT_NEAR(order(ThermalStepper::backward_euler, 40), 1, 0.1);
  EXPECT_NEAR(order(ThermalStepper::crank_nicolson, 20), 2, 0.05);
}

/// Growth of the stiffest mode, which alternates along x, in 200 explicit steps of a share of h^2 / (2 alpha).
double growth(double share) {
  ThermalOptions options;
  options.blocks = {material(1, 1)};
  options.initial_function = [](const Vec3& x) { return std::cos(8 * pi * x[0]); };
  Thermal thermal("heat", distributed(cube(8)), options);
  thermal.initialize();
  for (int i = 0; i < 200; ++i) thermal.advance(share / 128);
  double greatest = 0;
  for (const double t : thermal.temperature()) greatest = std::max(greatest, std::abs(t));
  return thermal.mesh().comm.max(greatest);
}

TEST(CosineDecay, ExplicitStepIsStableUpToItsLimitAndNotBeyond) {
  EXPECT_LT(growth(0.99), 0.1);
  EXPECT_GT(growth(1.02), 1e3);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// TR-BDF2: order two, L-stability, the step that it chooses; and restart with another stepper.
#include <gtest/gtest.h>

#include <numbers>

#include "thermal_case.hpp"

namespace tenon::testing {
namespace {

constexpr double pi = std::numbers::pi;

ThermalOptions plain(ThermalStepper stepper) {
  ThermalOptions options;
  options.blocks = {material(1, 1)};
  options.stepper = stepper;
  return options;
}

/// Error of a cosine mode of a bar of 8 cubes against its own discrete rate, at t = 0.2 s.
double mode_error(ThermalStepper stepper, int steps) {
  const double end = 0.2, h = 1.0 / 8, rate = 2 * (1 - std::cos(pi * h)) / (h * h);
  ThermalOptions options = plain(stepper);
  options.fixed_step = end / steps;
  options.initial_function = [](const Vec3& x) { return std::cos(pi * x[0]); };
  Thermal thermal("heat", distributed(bar(1, 8)), options);
  thermal.initialize();
  run_until(thermal, end);
  return std::abs(temperature_at(thermal, {0, 0, 0}) - std::exp(-rate * end));
}

TEST(TrBdf2, IsOfSecondOrder) {
  const double coarse = mode_error(ThermalStepper::tr_bdf2, 4), fine = mode_error(ThermalStepper::tr_bdf2, 8);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.15) << coarse << " " << fine;
  EXPECT_LT(fine, mode_error(ThermalStepper::crank_nicolson, 8));
}

/// Greatest temperature that is left of a mode that alternates from node to node, after a step of 1e6 times the
/// explicit limit.
double left_after_long_step(ThermalStepper stepper) {
  ThermalOptions options = plain(stepper);
  options.fixed_step = 1e6 / 128;
  options.initial_function = [](const Vec3& x) { return std::cos(8 * pi * x[0]); };
  Thermal thermal("heat", distributed(cube(8)), options);
  thermal.initialize();
  thermal.advance(*options.fixed_step);
  double greatest = 0;
  for (const double t : thermal.temperature()) greatest = std::max(greatest, std::abs(t));
  return thermal.mesh().comm.max(greatest);
}

TEST(TrBdf2, IsLStable) {
  EXPECT_GT(left_after_long_step(ThermalStepper::crank_nicolson), 0.99);  // rings
  EXPECT_LT(left_after_long_step(ThermalStepper::tr_bdf2), 1e-5);
}

struct Outcome {
  double error;
  std::int64_t steps, repeated;
};

/// A bar whose end is heated suddenly: error at (0.25, 20 s), in K of 100.
Outcome heated_bar(double tolerance) {
  ThermalOptions options;
  options.blocks = {material(40, 1e-5)};
  options.stepper = ThermalStepper::tr_bdf2;
  options.control.tolerance = tolerance;
  options.prescribed = {{"x_min", TimeFunction::smooth_step(0, 100, 0, 5)}};
  const auto mesh = distributed(bar(0.3, 30));
  const auto run = [&](ThermalOptions& o) {
    auto thermal = std::make_unique<Thermal>("heat", mesh, o);
    thermal->initialize();
    run_until(*thermal, 40);
    EXPECT_LT(balance(*thermal).error(), 1e-12);
    return thermal;
  };
  const auto adaptive = run(options);
  options.fixed_step = 0.02;
  const auto fine = run(options);
  double error = 0;
  for (std::size_t n = 0; n < fine->temperature().size(); ++n)
    error = std::max(error, std::abs(fine->temperature()[n] - adaptive->temperature()[n]));
  return {mesh->comm.max(error), adaptive->steps_taken(), adaptive->steps_repeated()};
}

TEST(TrBdf2, ErrorFollowsTheTolerance) {
  const Outcome coarse = heated_bar(0.5), fine = heated_bar(0.005);
  EXPECT_LT(coarse.error, 5);
  EXPECT_LT(fine.error, 0.05) << fine.steps;
  EXPECT_GT(fine.steps, 2 * coarse.steps);
  EXPECT_LT(fine.steps, 300);
  EXPECT_LT(fine.repeated, fine.steps / 3);
}

TEST(TrBdf2, StepsGrowAsTheTemperatureSettles) {
  ThermalOptions options;
  options.blocks = {material(40, 1e-5)};
  options.stepper = ThermalStepper::tr_bdf2;
  options.control = {0.1, 0.01, 1000.0};
  options.prescribed = {{"x_min", TimeFunction::constant(100)}, {"x_max", TimeFunction::constant(0)}};
  Thermal thermal("heat", distributed(bar(0.1, 10)), options);
  thermal.initialize();
  EXPECT_EQ(thermal.time_step(), 0.01);
  run_until(thermal, 20000);
  EXPECT_EQ(thermal.time_step(), 1000);
  EXPECT_LT(thermal.steps_taken(), 120);
  EXPECT_NEAR(temperature_at(thermal, {0.05, 0, 0}), 50, 1e-3);
}

/// Heat that is even drives nothing: the right-hand side falls to nothing, the last increment has not.
TEST(Steppers, RestFollowsHeating) {
  for (const ThermalStepper stepper : {ThermalStepper::backward_euler, ThermalStepper::crank_nicolson}) {
    BoxShape strip;
    strip.low = {0, 0, -2e-3}, strip.high = {0.1, 5e-3, 2e-3};
    strip.elements = {10, 1, 2};
    ThermalOptions options;
    options.blocks = {{"box", 7850, 460, 50, 300}};
    options.stepper = stepper;
    options.fixed_step = 1e-5;
    const double power = 50 * 7850.0 * 460 / 1e-3;
    options.sources = {{"box", TimeFunction::table({{0, 0}, {1e-3, power}, {2e-3, 0}})}};
    Thermal thermal("heat", distributed(strip), options);
    thermal.initialize();
    for (int s = 0; s < 1000; ++s) thermal.advance(s % 3 == 0 ? 0.7e-5 : 1e-5);
    for (const double t : thermal.temperature()) EXPECT_NEAR(t, 350, 0.01);
  }
}

TEST(Steppers, RestartWithAnotherOneGoesOn) {
  const auto mesh = distributed(cube(3, true));
  const std::string path = "thermal_stepper_np" + std::to_string(communicator().size()) + ".h5";
  Thermal first("heat", mesh, all_loads(ThermalStepper::backward_euler));
  first.initialize();
  for (int i = 0; i < 3; ++i) first.advance(40);
  CheckpointWriter writer(communicator(), path);
  first.save(writer);
  writer.finish();
  for (const ThermalStepper stepper : {ThermalStepper::explicit_euler, ThermalStepper::crank_nicolson,
                                       ThermalStepper::tr_bdf2, ThermalStepper::steady}) {
    Thermal next("heat", mesh, all_loads(stepper));
    const CheckpointReader reader(communicator(), path);
    next.set_clock(120);
    next.load(reader);
    next.initialize();
    for (std::size_t n = 0; n < first.temperature().size(); ++n)
      ASSERT_EQ(next.temperature()[n], first.temperature()[n]);
    for (int i = 0; i < 3; ++i) next.advance(std::min(next.time_step(), 40.0));
    EXPECT_LT(balance(next).error(), 1e-12) << static_cast<int>(stepper);
  }
}

}  // namespace
}  // namespace tenon::testing

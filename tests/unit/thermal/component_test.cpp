// SPDX-License-Identifier: BSD-3-Clause
// Steps, motion of the body, refusals and failures.
#include <gtest/gtest.h>

#include "thermal_case.hpp"

namespace tenon::testing {
namespace {

ThermalOptions plain() {
  ThermalOptions options;
  options.blocks = {material(1, 1)};
  return options;
}

ExitCode code_of(const std::function<void()>& work, std::string& message) {
  try {
    work();
  } catch (const Error& e) {
    message = e.what();
    return e.code();
  }
  return ExitCode::done;
}

TEST(Thermal, StableLimitOfCubesIsTheExactOne) {
  Thermal thermal("heat", distributed(cube(4)), plain());
  thermal.initialize();
  const double exact = 1.0 / 32;  // h^2 / (2 alpha)
  EXPECT_LE(thermal.stable_limit(), exact);
  EXPECT_GE(thermal.stable_limit(), 0.985 * exact);
  EXPECT_EQ(thermal.time_step(), 0.9 * thermal.stable_limit());
  EXPECT_NE(thermal.limiter().reason.find("of block box at"), std::string::npos) << thermal.limiter().reason;
}

TEST(Thermal, ConvectionLowersTheStableLimit) {
  ThermalOptions options = plain();
  options.convection = {{"x_min", 1000, TimeFunction::constant(1)}};
  Thermal film("heat", distributed(cube(4)), options), bare("heat", distributed(cube(4)), plain());
  film.initialize(), bare.initialize();
  EXPECT_NEAR(2 / film.stable_limit() - 2 / bare.stable_limit(), 1000 / (1.0 / 8), 1e-6);  // h / (rho c h_x / 2)
}

TEST(Thermal, StretchingTheBodyChangesConductionButNotItsCapacity) {
  Thermal thermal("heat", distributed(cube(3)), plain());
  thermal.initialize();
  const double limit = thermal.stable_limit();
  std::vector<double> u;
  for (const Vec3& x : thermal.mesh().coordinates) u.insert(u.end(), {x[0], x[1], x[2]});  // twice as large
  import_port(thermal, "displacement").write(u);
  EXPECT_NEAR(thermal.stable_limit(), limit / 2, 1e-12 * limit);  // K doubles with the length, C stays
  for (std::size_t n = 0; n < u.size() / 3; ++n)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(thermal.current_coordinates()[n][c], 2 * thermal.mesh().coordinates[n][c]);
}

TEST(Thermal, RigidMotionChangesNothing) {
  ThermalOptions options = all_loads(ThermalStepper::backward_euler);
  const auto mesh = distributed(cube(3, true));
  Thermal still("heat", mesh, options), moving("heat", mesh, options);
  still.initialize(), moving.initialize();
  for (int step = 0; step < 5; ++step) {
    std::vector<double> u;
    for (const Vec3& x : moving.mesh().coordinates) {
      const double a = 0.3 * step, c = std::cos(a), s = std::sin(a);
      u.insert(u.end(), {c * x[0] - s * x[1] - x[0] + step, s * x[0] + c * x[1] - x[1], -2.0 * step});
    }
    import_port(moving, "displacement").write(u);
    still.advance(40), moving.advance(40);
  }
  for (std::size_t n = 0; n < still.temperature().size(); ++n)
    EXPECT_NEAR(moving.temperature()[n], still.temperature()[n], 1e-9);
}

TEST(Thermal, SameDisplacementIsSkippedAndCounted) {
  Thermal thermal("heat", distributed(cube(2)), plain());
  thermal.initialize();
  const std::vector<double> u(3 * static_cast<std::size_t>(thermal.mesh().nodes()), 0.0);
  thermal.advance(1e-3);  // assembled by initialize
  for (int i = 0; i < 3; ++i) {
    import_port(thermal, "displacement").write(u);
    thermal.advance(1e-3);
  }
  EXPECT_EQ(thermal.skips().front().times, 3);
}

TEST(Thermal, InvertedElementStopsAllRanksAndIsNamed) {
  Thermal thermal("heat", distributed(cube(3)), plain());
  thermal.initialize();
  std::vector<double> u;
  for (const Vec3& x : thermal.mesh().coordinates) u.insert(u.end(), {x[0] > 0.9 ? -1.5 : 0.0, 0, 0});
  import_port(thermal, "displacement").write(u);
  std::string message;
  EXPECT_EQ(code_of([&] { thermal.advance(1e-3); }, message), ExitCode::geometry);
  EXPECT_NE(message.find("element 3 of block box at"), std::string::npos) << message;
}

TEST(Thermal, NotANumberStopsAllRanks) {
  Thermal thermal("heat", distributed(cube(3)), plain());
  thermal.initialize();
  std::vector<double> heat(static_cast<std::size_t>(thermal.mesh().nodes()), 0.0);
  for (std::size_t n = 0; n < heat.size(); ++n)
    if (thermal.mesh().node_ids[n] == 5) heat[n] = std::nan("");
  import_port(thermal, "heat").write(heat);
  std::string message;
  EXPECT_EQ(code_of([&] { thermal.advance(1e-3); }, message), ExitCode::unstable);
  EXPECT_NE(message.find("temperature of node"), std::string::npos) << message;
}

TEST(Thermal, SurroundingsThatGetColderThanNothingStopAllRanks) {
  ThermalOptions options = plain();
  options.stepper = ThermalStepper::backward_euler, options.fixed_step = 1;
  options.radiation = {{"x_min", 0.5, TimeFunction::table({{0, 2}, {4, -2}})}};
  Thermal thermal("heat", distributed(cube(2)), options);
  thermal.initialize();
  thermal.advance(1), thermal.advance(1);
  std::string message;
  EXPECT_EQ(code_of([&] { thermal.advance(1); }, message), ExitCode::usage);
  EXPECT_NE(message.find("have -1 K"), std::string::npos) << message;
}

TEST(Thermal, TooFewIterationsAreReported) {
  ThermalOptions options = all_loads(ThermalStepper::backward_euler);
  options.max_iterations = 2;
  Thermal thermal("heat", distributed(cube(4)), options);
  thermal.initialize();
  std::string message;
  EXPECT_EQ(code_of([&] { thermal.advance(40); }, message), ExitCode::unstable);
  EXPECT_NE(message.find("2 iterations"), std::string::npos) << message;
}

TEST(Thermal, RefusesWhatCannotWork) {
  const auto refused = [](const ThermalOptions& options, const std::string& word) {
    std::string message;
    EXPECT_EQ(code_of([&] { Thermal("heat", distributed(cube(2)), options).initialize(); }, message), ExitCode::usage);
    EXPECT_NE(message.find(word), std::string::npos) << message;
  };
  ThermalOptions options;
  refused(options, "'box'");
  options = plain();
  options.stepper = ThermalStepper::crank_nicolson;
  refused(options, "time_step.fixed");
  options = plain();
  options.fixed_step = 1;
  refused(options, "stable only up to");
  options = plain();
  options.fluxes = {{"x_mni", TimeFunction::constant(1)}};
  refused(options, "x_mni");
  options = plain();
  options.prescribed = {{"nowhere", TimeFunction::constant(1)}};
  refused(options, "nowhere");
}

TEST(Thermal, LaterInitialTemperaturesWin) {
  ThermalOptions options = plain();
  options.initial = {{"", "", 10, {1, 2, 3}}, {"box", "", 20, {}}, {"", "x_max", 30, {0, 1, 0}}};
  options.prescribed = {{"z_max", TimeFunction::constant(40)}};
  Thermal thermal("heat", distributed(cube(2)), options);
  thermal.initialize();
  EXPECT_EQ(temperature_at(thermal, {0, 0, 0}), 20);
  EXPECT_EQ(temperature_at(thermal, {1, 1, 0}), 31);
  EXPECT_EQ(temperature_at(thermal, {1, 1, 1}), 40);
  EXPECT_EQ(balance(thermal).stored, 0);
}

TEST(Thermal, OneElementOnAnyRanks) {
  ThermalOptions options = all_loads(ThermalStepper::backward_euler);
  Thermal thermal("heat", distributed(cube(1)), options);
  thermal.initialize();
  for (int i = 0; i < 3; ++i) thermal.advance(40);
  EXPECT_LT(balance(thermal).error(), 1e-13);
}

}  // namespace
}  // namespace tenon::testing

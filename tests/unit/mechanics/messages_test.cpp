// SPDX-License-Identifier: BSD-3-Clause
// What a bad run says, on every rank.
#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

BoxShape cubes() {
  BoxShape box;
  box.elements = {4, 2, 2};
  box.high = {4, 2, 2};
  return box;
}

/// Runs until it fails; the error, which must come on every rank with the same words.
Error failure(Mechanics& m, int steps) {
  try {
    m.initialize();
    for (int s = 0; s < steps; ++s) m.advance(m.time_step());
  } catch (const Error& e) {
    EXPECT_EQ(communicator().sum(std::int64_t{1}), communicator().size());
    return e;
  }
  return Error(ExitCode::done, "nothing happened");
}

TEST(Messages, InvertedElementIsNamed) {
  MechanicsOptions options;
  options.initial_velocities.push_back({"", "", {}, {-1, 0, 0, 0, 0, 0, 0, 0, 0}, {2, 0, 0}});
  options.time_step.fixed = 0.3;  // nothing resists, so only the place counts
  options.viscosity = {0, 0};
  options.hourglass.form = HourglassOptions::Form::none;
  PrescribedMotion hold = motion(Kind::velocity, {"x_min"});
  hold.value[0] = TimeFunction::constant(4);
  options.motions.push_back(hold);
  const auto m = body(shared_mesh(on_root(cubes())), elastic_material(1e-6, 0.3, 1), options);
  const Error e = failure(*m, 50);
  EXPECT_EQ(e.code(), ExitCode::geometry) << e.what();
  const std::string text = e.what();
  EXPECT_NE(text.find("of block box"), std::string::npos) << text;
  EXPECT_NE(text.find("inside out"), std::string::npos) << text;
  EXPECT_NE(text.find("element "), std::string::npos) << text;
}

TEST(Messages, TooLargeAStepIsCalledUnstable) {
  MechanicsOptions options;
  options.initial_velocities.push_back({"", "", {}, {1, 0, 0, 0, -1, 0, 0, 0.5, 0.3}, {}});
  const auto probe = body(shared_mesh(on_root(cubes())), steel(), options);
  probe->initialize();
  options.time_step.fixed = 4 * probe->time_step();
  const auto m = body(shared_mesh(on_root(cubes())), steel(), options);
  const Error e = failure(*m, 2000);
  EXPECT_EQ(e.code(), ExitCode::unstable) << e.what();
  EXPECT_NE(std::string(e.what()).find("time_step.fixed"), std::string::npos) << e.what();
  EXPECT_FALSE(m->warnings().empty());
}

TEST(Messages, ACollapsedStepStopsTheRun) {
  MechanicsOptions options;
  PrescribedMotion press = motion(Kind::displacement, {"z_max"});
  press.components = {false, false, true};
  press.value[2] = TimeFunction::table({{0, 0}, {1, -1.99999}});
  PrescribedMotion hold = motion(Kind::fixed, {"z_min"});
  hold.components = {false, false, true};
  options.motions = {press, hold};
  options.time_step.maximum = 1e-4;
  options.time_step.collapse = 0.2;
  const auto m = body(shared_mesh(on_root(cubes())), elastic_material(1e3, 0.3, 1000), options);
  const Error e = failure(*m, 20000);
  EXPECT_EQ(e.code(), ExitCode::unstable) << e.what();
  EXPECT_NE(std::string(e.what()).find("collapsed"), std::string::npos) << e.what();
}

TEST(Messages, TheLimitingElementIsNamed) {
  BoxShape box = cubes();
  box.grading = {0.5, 1, 1};
  const auto m = body(shared_mesh(on_root(box)), steel(), {});
  m->initialize();
  const StepLimiter limiter = m->limiter();
  EXPECT_EQ(limiter.dt, m->time_step());
  EXPECT_NE(limiter.reason.find("element 4 of block box"), std::string::npos) << limiter.reason;
}

TEST(Messages, ABlockWithoutMaterialIsRefused) {
  EXPECT_THROW(Mechanics("body", shared_mesh(on_root(cubes())), {}), Error);
}

}  // namespace
}  // namespace tenon::testing

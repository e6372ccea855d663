// SPDX-License-Identifier: BSD-3-Clause
// The state is the same file, byte for byte, on any number of ranks, also after a restart from half-way.
// The run on one rank (a test fixture) leaves the files that the others compare with.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "thermal_case.hpp"

namespace tenon::testing {
namespace {

struct Case {
  std::string name;
  ThermalStepper stepper;
  BoxShape shape;
};

std::vector<Case> cases() {
  return {{"explicit_hex", ThermalStepper::explicit_euler, cube(6, false, 0.2)},
          {"explicit_tet", ThermalStepper::explicit_euler, cube(4, true, 0.2)},
          {"backward_hex", ThermalStepper::backward_euler, cube(5, false, 0.2)},
          {"backward_tet", ThermalStepper::backward_euler, cube(6, true, 0.2)},
          {"crank_tet", ThermalStepper::crank_nicolson, cube(4, true, 0.2)},
          {"one_element", ThermalStepper::backward_euler, cube(1)}};
}

constexpr int steps = 16;

std::string file_name(const Case& c, const char* when, int ranks) {
  return "thermal_" + c.name + "_" + when + "_np" + std::to_string(ranks) + ".h5";
}

std::string bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream all;
  all << file.rdbuf();
  return all.str();
}

void save(Thermal& thermal, const std::string& path) {
  CheckpointWriter file(communicator(), path);
  file.scalar("time", thermal.time());
  thermal.save(file);
  file.finish();
}

/// Steps `first` to `last`, moved and heated every third.
void run(Thermal& thermal, int first, int last) {
  for (int step = first; step < last; ++step) {
    if (step % 3 == 1) disturb(thermal, 0.002 * step);
    thermal.advance(thermal.time_step());
  }
}

void expect_same_file(const Case& c, const char* when) {
  if (communicator().rank() != 0) return;
  const std::string reference = bytes(file_name(c, when, 1));
  ASSERT_FALSE(reference.empty()) << "no " << file_name(c, when, 1) << ": run this test on one rank first";
  EXPECT_TRUE(bytes(file_name(c, when, communicator().size())) == reference) << c.name << ", " << when;
}

TEST(ThermalRanks, StateIsTheSameFile) {
  for (const Case& c : cases()) {
    Thermal thermal("heat", distributed(c.shape), all_loads(c.stepper));
    thermal.initialize();
    run(thermal, 0, steps / 2);
    save(thermal, file_name(c, "half", communicator().size()));
    run(thermal, steps / 2, steps);
    save(thermal, file_name(c, "end", communicator().size()));
    expect_same_file(c, "half");
    expect_same_file(c, "end");
  }
}

TEST(ThermalRanks, RestartGoesOnAsIfNothingHadHappened) {
  for (const Case& c : cases()) {
    Thermal thermal("heat", distributed(c.shape), all_loads(c.stepper));
    const CheckpointReader file(communicator(), file_name(c, "half", 1));
    thermal.set_clock(file.scalar("time"));
    thermal.load(file);
    thermal.initialize();
    run(thermal, steps / 2, steps);
    save(thermal, file_name(c, "end", communicator().size()));
    expect_same_file(c, "end");
  }
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// A steady step allocates nothing, with or without motion.
#include <gtest/gtest.h>

#include <array>

#include "allocation_counter.hpp"
#include "thermal_case.hpp"

namespace tenon::testing {
namespace {

/// Allocations of three steps after the first two (in which exchange buffers grow), moved and heated.
std::int64_t allocations_of(const ThermalOptions& options) {
  Thermal thermal("heat", distributed(cube(4, true)), options);
  thermal.initialize();
  const ImportPort displacement = import_port(thermal, "displacement"), heat = import_port(thermal, "heat");
  std::vector<double> u(3 * static_cast<std::size_t>(thermal.mesh().nodes()), 0.0);
  const std::vector<double> q(u.size() / 3, 1.0);
  const auto move = [&] {
    for (double& v : u) v += 1e-6;
    displacement.write(u);
    heat.write(q);
    thermal.advance(std::min(thermal.time_step(), 40.0));
  };
  for (int i = 0; i < 2; ++i) move();
  const std::int64_t before = allocations();
  for (int i = 0; i < 3; ++i) move();
  return allocations() - before;
}

constexpr std::array implicit_steppers{ThermalStepper::backward_euler, ThermalStepper::crank_nicolson,
                                       ThermalStepper::tr_bdf2, ThermalStepper::steady};

TEST(Thermal, SteadyStepsAllocateNothing) {
  EXPECT_EQ(allocations_of(all_loads(ThermalStepper::explicit_euler)), 0);
  for (const ThermalStepper stepper : implicit_steppers)
    EXPECT_EQ(allocations_of(all_loads(stepper)), 0) << static_cast<int>(stepper);
}

TEST(Thermal, StepsWithPropertiesOverTemperatureAllocateNothing) {
  for (const ThermalStepper stepper : implicit_steppers)
    EXPECT_EQ(allocations_of(all_loads_warm(stepper)), 0) << static_cast<int>(stepper);
}

// Its matrices change in every step, and are filled in again.
TEST(Thermal, MultigridAllocatesNothing) {
  for (const ThermalStepper stepper : implicit_steppers)
    for (ThermalOptions options : {all_loads(stepper), all_loads_warm(stepper)}) {
      options.preconditioner = ThermalPreconditioner::multigrid;
      EXPECT_EQ(allocations_of(options), 0) << static_cast<int>(stepper);
    }
}

}  // namespace
}  // namespace tenon::testing

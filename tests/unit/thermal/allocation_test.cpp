// SPDX-License-Identifier: BSD-3-Clause
// A steady step allocates nothing, with or without motion.
#include <gtest/gtest.h>

#include "allocation_counter.hpp"
#include "thermal_case.hpp"

namespace tenon::testing {
namespace {

TEST(Thermal, SteadyStepsAllocateNothing) {
  for (const ThermalStepper stepper : {ThermalStepper::explicit_euler, ThermalStepper::backward_euler,
                                       ThermalStepper::crank_nicolson, ThermalStepper::tr_bdf2}) {
    Thermal thermal("heat", distributed(cube(4, true)), all_loads(stepper));
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
    for (int i = 0; i < 2; ++i) move();  // exchange buffers grow once
    const std::int64_t before = allocations();
    for (int i = 0; i < 3; ++i) move();
    EXPECT_EQ(allocations() - before, 0) << static_cast<int>(stepper);
  }
}

}  // namespace
}  // namespace tenon::testing

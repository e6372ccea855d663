// SPDX-License-Identifier: BSD-3-Clause
// Water in a tank, at rest for long and let go, with small particles.
#include "tank_case.hpp"

namespace tenon::testing {
namespace {

/// Hardly damped, particles go on trembling; nothing drifts.
TEST(HydrostaticsFine, TenSeconds) {
  expect_rest(end_of_rest({0.02, 1, 1, 10}), 5e-3);
}

TEST(HydrostaticsFine, GravityGrows) {
  expect_rest(end_of_rest({0.02, 1, 1, 3, false}));
}

TEST(DamBreakFine, FrontAndEnergy) {
  expect_the_dam_to_break(1.0 / 33);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Static cases of shells that take longer (A09).
#include "shell_statics_case.hpp"

namespace tenon::testing {
namespace {

// [BWS89]: a hundredth of the thickness of [MH85]; warped elements as thin as this lock in the membrane.
TEST(ShellNightly, ThinTwistedBeam) {
  EXPECT_NEAR(twisted_beam(0.0032, 1e-6, 2), 1, 0.02);
  EXPECT_NEAR(twisted_beam(0.0032, 1e-6, 1), 1, 0.02);
}

TEST(ShellNightly, PinchedCylinder) {
  EXPECT_GE(pinched_cylinder(32), 0.98);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Case C02 on a coarse mesh.
#include "hertz_case.hpp"

namespace tenon::testing {
namespace {

TEST(Hertz, CoarseBall) {
  press_ball(0.4e-3, 0.2e-3, 0.14e-3);
}

// The series for a ball tends to Hertz's law as the contact becomes small: 1 + 0.5 a/R, to first order.
TEST(Hertz, TheoryOfABallTendsToThatOfHalfSpaces) {
  for (const double a : {0.02e-3, 0.1e-3, 0.5e-3}) {
    const HertzContact ball = hertz(a);
    EXPECT_GT(ball.force, half_space_force(ball.approach));
    EXPECT_NEAR(ball.force / half_space_force(ball.approach), 1, 0.5 * a / ball_radius);
  }
}

}  // namespace
}  // namespace tenon::testing

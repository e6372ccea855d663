// SPDX-License-Identifier: BSD-3-Clause
// The swinging plate (case B10) at the resolution that the case names, over three periods.
#include <gtest/gtest.h>

#include "oscillating_plate_case.hpp"

namespace tenon::testing {
namespace {

TEST(OscillatingPlate, PeriodAmplitudeAndDecay) {
  const Swing s = swing(20, 0.01, 2.5);
  EXPECT_NEAR(s.period, 0.25503, 0.03 * 0.25503);
  EXPECT_NEAR(s.amplitude, 23.0e-3, 0.03 * 23.0e-3);
  EXPECT_LE(s.decay, 0.03);
}

TEST(OscillatingPlate, PeriodOfASmallSwing) {
  const Swing s = swing(10, 0.001, 1);
  EXPECT_NEAR(s.period, 0.25511, 0.03 * 0.25511);
  EXPECT_NEAR(s.amplitude, 2.304e-3, 0.03 * 2.304e-3);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// The swinging plate (case B10), coarse: its first return.
#include <gtest/gtest.h>

#include "oscillating_plate_case.hpp"

namespace tenon::testing {
namespace {

TEST(OscillatingPlate, Period) {
  const Swing s = swing(5, 0.01, 0.5);
  EXPECT_NEAR(s.period, 0.25503, 0.06 * 0.25503);
  EXPECT_NEAR(s.amplitude, 23.0e-3, 0.05 * 23.0e-3);
}

}  // namespace
}  // namespace tenon::testing

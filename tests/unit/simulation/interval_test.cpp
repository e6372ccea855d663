// SPDX-License-Identifier: BSD-3-Clause
#include "framework/simulation/interval.hpp"

#include <gtest/gtest.h>

namespace tenon {
namespace {

int times_due(IntervalClock clock, double dt, int steps) {
  int n = 0;
  for (int i = 1; i <= steps; ++i) n += clock.due(i * dt, i);
  return n;
}

TEST(Interval, ByTimeIsDueOncePerMultiple) {
  EXPECT_EQ(times_due(IntervalClock({0.1, 0}, 0.0), 0.003, 1000), 30);
  EXPECT_EQ(times_due(IntervalClock({0.1, 0}, 0.0), 0.1, 50), 50);
  EXPECT_EQ(times_due(IntervalClock({0.1, 0}, 0.0), 0.35, 20), 20);
}

TEST(Interval, BySteps) {
  EXPECT_EQ(times_due(IntervalClock({0, 7}, 0.0), 0.1, 70), 10);
  EXPECT_EQ(times_due(IntervalClock({0, 0}, 0.0), 0.1, 70), 0);
}

TEST(Interval, ARestartedClockIsDueAtTheSameSteps) {
  IntervalClock whole({0.1, 0}, 0.0), second({0.1, 0}, 0.0);
  second.reset(0.013 * 500, 500);
  for (int i = 1; i <= 1000; ++i) {
    const bool due = whole.due(0.013 * i, i);
    if (i > 500) {
      EXPECT_EQ(due, second.due(0.013 * i, i)) << i;
    }
  }
}

}  // namespace
}  // namespace tenon

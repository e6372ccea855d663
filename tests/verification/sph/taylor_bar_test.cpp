// SPDX-License-Identifier: BSD-3-Clause
// Taylor bar of particles (case F13), coarse, as far as it is short; finer ones are nightly.
#include <gtest/gtest.h>

#include "taylor_bar_case.hpp"

namespace tenon::testing {
namespace {

TEST(TaylorBar, ShortensAndSpreadsAsItShould) {
  const TaylorBar bar = taylor_bar(SphFormulation::total_lagrangian, 3);
  EXPECT_NEAR(bar.length, 21.47e-3, 0.02 * 21.47e-3);
  EXPECT_NEAR(bar.radius, 7.18e-3, 0.06 * 7.18e-3);
  EXPECT_LE(bar.ledger_error, 1e-11);
}

}  // namespace
}  // namespace tenon::testing

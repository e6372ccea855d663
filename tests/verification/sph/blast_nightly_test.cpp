// SPDX-License-Identifier: BSD-3-Clause
// Sedov's blast [Sed59] at 50^3 particles, by an octant of them.
#include "sedov_case.hpp"

namespace tenon::testing {
namespace {

/// The radius is where the pressure is half way up. The density will not do: the shell of dense gas, which ends 5 % of
/// the radius behind the front, is thinner than a smoothing length, so its peak is a blur whose edge lies outside.
TEST(Sedov, Fifty) {
  const SedovEnd end = run_sedov(sedov(50, true));
  if (communicator().rank() != 0) return;
  EXPECT_NEAR(end.radius, SedovSolution::radius, 0.015 * SedovSolution::radius);
  EXPECT_GE(end.peak, 3.3);
  EXPECT_NEAR(end.kinetic, SedovSolution::kinetic, 0.03 * SedovSolution::kinetic);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Colliding rubber rings (case B04) at the resolution that the case names.
#include <gtest/gtest.h>

#include "rings_case.hpp"

namespace tenon::testing {
namespace {

TEST(Rings, BounceAsFiniteElementsSay) {
  const RingsResult r = collide(rings(SphFormulation::total_lagrangian, 10), 10, 300e-6);
  EXPECT_EQ(r.clusters, 2);
  EXPECT_GT(r.restitution, 0.74);
  EXPECT_LT(r.restitution, 0.85);
  EXPECT_NEAR(r.last_contact - r.first_contact, 262.8e-6, 0.06 * 262.8e-6);
  EXPECT_NEAR(r.least_width, 49.5e-3, 0.04 * 49.5e-3);
  EXPECT_LE(r.energy_loss, 0.05);
  EXPECT_LE(r.momentum, 1e-12);
  EXPECT_LE(r.ledger_error, 1e-11);
}

}  // namespace
}  // namespace tenon::testing

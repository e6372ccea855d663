// SPDX-License-Identifier: BSD-3-Clause
// Decay of Taylor-Green vortices against the exact solution of the incompressible equations.
#include <gtest/gtest.h>

#include "taylor_green_decay.hpp"

namespace tenon::testing {
namespace {

TEST(TaylorGreen, Plain) {
  const Decay found = decay(25, FluidOptions::Shifting::none);
  EXPECT_NEAR(found.rate, TaylorGreen::rate, 0.15 * TaylorGreen::rate);
  EXPECT_LE(found.error, 0.075);
  EXPECT_LE(found.ledger, 1e-11);
}

TEST(TaylorGreen, Shifting) {
  const Decay found = decay(25, FluidOptions::Shifting::shifting);
  EXPECT_NEAR(found.rate, TaylorGreen::rate, 0.05 * TaylorGreen::rate);
  EXPECT_LE(found.error, 0.03);
  EXPECT_LE(found.ledger, 1e-11);
}

TEST(TaylorGreen, TransportVelocity) {
  const Decay found = decay(25, FluidOptions::Shifting::transport_velocity);
  EXPECT_NEAR(found.rate, TaylorGreen::rate, 0.05 * TaylorGreen::rate);
  EXPECT_LE(found.error, 0.03);
  EXPECT_LE(found.ledger, 1e-11);
}

}  // namespace
}  // namespace tenon::testing

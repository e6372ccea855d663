// SPDX-License-Identifier: BSD-3-Clause
// Taylor-Green vortices on 50 x 50 particles, and the order of convergence.
#include <gtest/gtest.h>

#include "taylor_green_decay.hpp"

namespace tenon::testing {
namespace {

using Shifting = FluidOptions::Shifting;

TEST(TaylorGreenFine, Plain) {
  const Decay found = decay(50, Shifting::none);
  EXPECT_NEAR(found.rate, TaylorGreen::rate, 0.15 * TaylorGreen::rate);
  EXPECT_LE(found.error, 0.03);
}

TEST(TaylorGreenFine, Shifting) {
  const Decay found = decay(50, Shifting::shifting);
  EXPECT_NEAR(found.rate, TaylorGreen::rate, 0.05 * TaylorGreen::rate);
  EXPECT_LE(found.error, 0.03);
}

TEST(TaylorGreenFine, TransportVelocityConverges) {
  const Decay coarse = decay(25, Shifting::transport_velocity), fine = decay(50, Shifting::transport_velocity);
  EXPECT_NEAR(fine.rate, TaylorGreen::rate, 0.05 * TaylorGreen::rate);
  EXPECT_LE(fine.error, 0.03);
  const double order = std::log2(coarse.error / fine.error);
  EXPECT_GE(order, 1.4);
  EXPECT_LE(order, 2.2);
}

}  // namespace
}  // namespace tenon::testing

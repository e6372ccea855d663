// SPDX-License-Identifier: BSD-3-Clause
// Ironing by a rigid cylinder: Coulomb's law, an even load, nothing inside the cylinder.
#include "ironing_case.hpp"

namespace tenon::testing {
namespace {

TEST(Ironing, RigidCylinder) {
  EXPECT_LE(iron_rigidly({}).coulomb, 2e-3);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Linear elasticity against Hooke's law and the constrained bar (F02).
#include <gtest/gtest.h>

#include "material_point.hpp"

namespace tenon::testing {
namespace {

using Point = MaterialPoint<LinearElastic>;

TEST(LinearElastic, UniaxialStressGivesYoungsModulusAndPoissonsRatio) {
  Point p{{steel}};
  p.pull(1e-3);
  EXPECT_NEAR(p[0], 200e6, 200e6 * 1e-12);
  EXPECT_NEAR(p[1], 0, 1e-3);
}

TEST(LinearElastic, ShearUsesTensorComponents) {
  Point p{{steel}};
  p.strain({0, 0, 0, 1e-3, 2e-3, 3e-3});
  const double two_g = 200e9 / 1.3;
  EXPECT_NEAR(p[3], two_g * 1e-3, 1);
  EXPECT_NEAR(p[4], two_g * 2e-3, 1);
  EXPECT_NEAR(p[5], two_g * 3e-3, 1);
  EXPECT_EQ(p[0], 0);
}

TEST(LinearElastic, ConstrainedHeatingGivesTheTriaxialStress) {
  Point p{{Elasticity{210e9, 0.3, 12e-6}}};
  for (int i = 0; i < 10; ++i) p.strain({}, 1, 10);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(p[c], -630e6, 1e-3);  // E alpha dT / (1 - 2 nu)
}

TEST(LinearElastic, ConstrainedHeatingOfABarGivesTheUniaxialStress) {
  Point p{{Elasticity{210e9, 0.3, 12e-6}}};
  p.pull(0, 1, 100);
  EXPECT_NEAR(p[0], -252e6, 252e6 * 1e-12);  // E alpha dT
}

TEST(LinearElastic, FreeHeatingLeavesNoStress) {
  Point p{{Elasticity{210e9, 0.3, 12e-6}}};
  const double free = 12e-6 * 100;
  p.strain({free, free, free, 0, 0, 0}, 1, 100);
  for (int c = 0; c < 6; ++c) EXPECT_EQ(p[c], 0);
}

TEST(LinearElastic, ClosedCycleReturnsAllWork) {
  Point p{{steel}};
  p.strain({1e-3, 0, -5e-4, 2e-4, 0, 1e-4});
  const double up = p.stress_work;
  EXPECT_NEAR(up, p.elastic_energy(), 1e-12 * up);
  p.strain({-1e-3, 0, 5e-4, -2e-4, 0, -1e-4});
  EXPECT_NEAR(p.stress_work, 0, 1e-12 * up);
}

TEST(Elasticity, ModuliAgree) {
  const double g = steel.shear_modulus(), k = steel.bulk_modulus();
  EXPECT_NEAR(steel.p_wave_modulus(), k + 4 * g / 3, 1e-4);
  EXPECT_NEAR(9 * k * g / (3 * k + g), 200e9, 1e-3);
}

}  // namespace
}  // namespace tenon::testing

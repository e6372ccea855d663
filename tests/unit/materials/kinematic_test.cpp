// SPDX-License-Identifier: BSD-3-Clause
// Kinematic and mixed hardening: Bauschinger, limit cycles, ratchetting, saturation, turning (A02 b).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "components/materials/j2_kinematic.hpp"
#include "deforming_point.hpp"

namespace tenon::testing {
namespace {

constexpr double E = 200e9, sigma_y = 300e6, H = 5e9;
using Point = MaterialPoint<J2Kinematic>;

TEST(J2Kinematic, MonotonicTensionIsTheSameForAnyShare) {
  for (const double share : {0.0, 0.3, 1.0})
    for (const int steps : {1, 11}) {
      Point p{{steel, {sigma_y, (1 - share) * H, share * H, 0}}};
      for (int i = 0; i < steps; ++i) p.pull(0.05 / steps);
      const double exact = sigma_y + E * H / (E + H) * (0.05 - sigma_y / E);
      EXPECT_NEAR(p[0], exact, 1e-10 * exact) << share;
      EXPECT_NEAR(p.eqps(), 0.05 - exact / E, 1e-11);
      EXPECT_NEAR(p.plastic_work, sigma_y * p.eqps() + 0.5 * H * p.eqps() * p.eqps(), 1e-9 * p.plastic_work);
    }
}

/// Without back stress it is the radial return, on any path.
TEST(J2Kinematic, WithoutKinematicModulusItIsIsotropic) {
  Point p{{steel, {sigma_y, H, 0, 0}}};
  MaterialPoint<J2LinearHardening> j2{{steel, sigma_y, H}};
  for (int i = 0; i < 40; ++i) {
    const Tensor e{1e-3, -4e-4 * (i % 3), -3e-4, 1e-3 * (i % 5 - 2), 2e-4, 0};
    p.strain(e), j2.strain(e);
    for (int c = 0; c < 6; ++c) ASSERT_NEAR(p[c], j2[c], 1e-12 * sigma_y);
  }
  EXPECT_NEAR(p.plastic_work, j2.plastic_work, 1e-12 * j2.plastic_work);
}

TEST(J2Kinematic, YieldsEarlierBackwards) {  // Bauschinger: the elastic range is 2 sigma_y less what hardening adds
  for (const double share : {0.0, 0.5, 1.0}) {
    Point p{{steel, {sigma_y, (1 - share) * H, share * H, 0}}};
    p.pull(0.02);
    const double radius = sigma_y + (1 - share) * H * p.eqps(), top = p[0], eqps = p.eqps();
    p.pull(-2 * radius / E * (1 - 1e-6));
    EXPECT_EQ(p.eqps(), eqps);
    p.pull(-1e-4);
    EXPECT_GT(p.eqps(), eqps);
    EXPECT_NEAR(p[0], top - 2 * radius, 5e6);  // on the way down from there with the tangent modulus
  }
}

TEST(J2Kinematic, PragerCyclesAreStationary) {
  Point p{{steel, {sigma_y, 0, H, 0}}};
  p.pull(0.01);
  const double top = p[0];
  for (int cycle = 0; cycle < 5; ++cycle) {
    for (int i = 0; i < 10; ++i) p.pull(-0.002);
    for (int i = 0; i < 10; ++i) p.pull(0.002);
    EXPECT_NEAR(p[0], top, 1e-8 * top) << cycle;
  }
}

/// Armstrong-Frederick in tension and back: a = C/g (1 - exp(-g eqps)), from a1: a = -C/g + (C/g + a1) exp(-g d).
TEST(J2Kinematic, ArmstrongFrederickFollowsItsClosedFormInTheFirstOrder) {
  const double C = 40e9, g = 200;
  const auto error = [&](int steps, bool back) {
    MaterialPoint<J2Kinematic> p{{steel, {sigma_y, 0, C, g}}};
    p.strain({1e-3, -5e-4, -5e-4, 0, 0, 0});  // elastic: 2 G 1.5e-3 = 231 MPa
    for (int i = 0; i < steps; ++i) p.strain({0.01 / steps, -0.005 / steps, -0.005 / steps, 0, 0, 0});
    double exact = C / g * (1 - std::exp(-g * p.eqps()));
    if (back) {
      const double a1 = exact, turned = p.eqps();
      for (int i = 0; i < steps; ++i) p.strain({-0.02 / steps, 0.01 / steps, 0.01 / steps, 0, 0, 0});
      exact = -C / g + (C / g + a1) * std::exp(-g * (p.eqps() - turned));
    }
    const double back_stress = 1.5 * p.state[1][0];
    EXPECT_NEAR(1.5 * (p[0] - (p[0] + p[1] + p[2]) / 3), back_stress + (back ? -1 : 1) * sigma_y, 1e-10 * sigma_y);
    return std::abs(back_stress - exact) / (C / g);
  };
  for (const bool back : {false, true}) {
    EXPECT_LT(error(400, back), 2e-2);
    EXPECT_NEAR(std::log2(error(400, back) / error(800, back)), 1, 0.1);
  }
}

TEST(J2Kinematic, BackStressSaturatesEvenInHugeSteps) {
  const double C = 40e9, g = 200;
  for (const double size : {0.01, 1.0, 1e6}) {
    Point p{{steel, {sigma_y, 0, C, g}}};
    for (int i = 0; i < 20; ++i) {
      p.strain({size, -size, 0, 0.3 * size, 0, -size * (i % 3)});
      double a = 0;
      for (int c = 1; c < 7; ++c) a += (c < 4 ? 1 : 2) * p.state[c][0] * p.state[c][0];
      ASSERT_LE(std::sqrt(1.5 * a), C / g * (1 + 1e-12));
      ASSERT_GE(p.plastic_work, 0);
      for (int c = 0; c < 6; ++c) ASSERT_TRUE(std::isfinite(p[c]));
    }
  }
}

/// Cycling between unequal stresses ratchets with recovery and shakes down without it ([AF66]).
TEST(J2Kinematic, RatchetsOnlyWithRecovery) {
  const auto drift = [](double recovery) {
    Point p{{steel, {sigma_y, 0, 40e9, recovery}}};
    double strain = 0, drifts[2] = {};
    const auto go_to = [&](double stress) {
      for (int i = 0; i < 4000 && (p[0] - stress) * (stress > 0 ? 1 : -1) < 0; ++i) {
        const double d = stress > 0 ? 2e-5 : -2e-5;
        p.pull(d), strain += d;
      }
    };
    for (int cycle = 0; cycle < 6; ++cycle) {
      const double before = strain;
      go_to(400e6), go_to(-300e6);
      drifts[cycle > 3] = strain - before;
    }
    return drifts[1];
  };
  EXPECT_LT(std::abs(drift(0)), 4.1e-5);  // a step to either side
  EXPECT_GT(drift(200), 2e-4);
}

/// A02 (b): stress and back stress turn with the body.
TEST(J2Kinematic, BackStressTurnsWithTheBody) {
  DeformingPoint<J2Kinematic> p(J2Kinematic{steel, {sigma_y, 1e9, H, 20}});
  const Matrix start = stretch(1.01, 0.996, 0.995);
  p.deform(start);
  const Matrix stress = p.tensor(), back = p.tensor(1);
  ASSERT_GT(std::abs(back[0][0]), 1e6);
  for (int i = 1; i <= 36; ++i) p.deform(turn(i * std::numbers::pi / 18) * start);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(p.tensor()[i][j], stress[i][j], 1e-10 * sigma_y);
      EXPECT_NEAR(p.tensor(1)[i][j], back[i][j], 1e-10 * sigma_y);
    }
}

}  // namespace
}  // namespace tenon::testing

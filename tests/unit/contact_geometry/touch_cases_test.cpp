// SPDX-License-Identifier: BSD-3-Clause
// Single cases of node and face: sides, rims, depth, degenerate faces.
#include <gtest/gtest.h>

#include <limits>

#include "components/contact_geometry/face_touch.hpp"

namespace tenon::contact {
namespace {

const FaceShape square{4, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}};

struct Case {
  double clearance = 0, depth = 0.1, margin = 0.05;
  bool two_sided = false;
  Touch touch{};
  bool operator()(const Vec3& from, const Vec3& to, const FaceShape& face = square) {
    return touch_face(from, to, face, face, clearance, depth, two_sided, margin, touch);
  }
};

TEST(TouchCases, ANodeThatComesSlowlyIsHeldAtItsFoot) {
  Case solid;
  ASSERT_TRUE(solid({0.3, 0.4, 0.01}, {0.31, 0.4, -0.02}));
  EXPECT_EQ(solid.touch.normal, (Vec3{0, 0, 1}));
  EXPECT_NEAR(solid.touch.gap, 0.01, 1e-15);
  EXPECT_NEAR(solid.touch.end_gap, -0.02, 1e-15);
  EXPECT_TRUE(solid.touch.inside);
  EXPECT_NEAR(solid.touch.weights[1], 0.31 * 0.6, 1e-12);
}

TEST(TouchCases, AFarNodeDoesNotTouch) {
  Case solid;
  EXPECT_FALSE(solid({0.5, 0.5, 0.2}, {0.5, 0.5, 0.1}));
  EXPECT_TRUE(solid({0.5, 0.5, 0.2}, {0.5, 0.5, 0.04}));
  EXPECT_FALSE(solid({1.2, 0.5, 0.01}, {1.1, 0.5, 0.01}));
}

TEST(TouchCases, DepthLimitsWhatBelongsToASolid) {
  Case solid;
  ASSERT_TRUE(solid({0.5, 0.5, -0.09}, {0.5, 0.5, -0.09}));
  EXPECT_NEAR(solid.touch.end_gap, -0.09, 1e-15);
  EXPECT_EQ(solid.touch.normal, (Vec3{0, 0, 1}));
  EXPECT_FALSE(solid({0.5, 0.5, -0.11}, {0.5, 0.5, -0.09}));
  // Beside the block and below its top: the side face's affair.
  EXPECT_FALSE(solid({1.02, 0.5, -0.05}, {1.02, 0.5, -0.05}));
  EXPECT_FALSE(solid({1.02, 0.5, -0.05}, {0.98, 0.5, -0.05}));
  // A fast one that starts just behind.
  ASSERT_TRUE(solid({0.5, 0.5, -1e-9}, {8.0, 0.5, -2.0}));
  EXPECT_NEAR(solid.touch.end_gap, -2.0, 1e-12);
}

TEST(TouchCases, ShellsHaveTwoSides) {
  Case shell;
  shell.two_sided = true;
  shell.clearance = 0.02;
  for (const double side : {1.0, -1.0}) {
    ASSERT_TRUE(shell({0.5, 0.5, side * 0.03}, {0.5, 0.5, side * 0.01}));
    EXPECT_EQ(shell.touch.normal, (Vec3{0, 0, side}));
    EXPECT_NEAR(shell.touch.gap, 0.01, 1e-15);
    EXPECT_NEAR(shell.touch.end_gap, -0.01, 1e-15);
    // Through the mid-surface within a step, slowly and fast.
    ASSERT_TRUE(shell({0.5, 0.5, side * 0.03}, {0.5, 0.5, side * -0.03}));
    EXPECT_EQ(shell.touch.normal, (Vec3{0, 0, side}));
    ASSERT_TRUE(shell({0.5, 0.5, side * 3}, {0.5, 0.5, side * -5}));
    EXPECT_EQ(shell.touch.normal, (Vec3{0, 0, side}));
    EXPECT_NEAR(shell.touch.end_gap, -5.02, 1e-12);
    // On the very mid-surface: against the motion.
    ASSERT_TRUE(shell({0.5, 0.5, 0}, {0.5, 0.5, side * 0.01}));
    EXPECT_EQ(shell.touch.normal, (Vec3{0, 0, -side}));
    ASSERT_TRUE(shell({0.5, 0.5, 0}, {0.5, 0.5, side * 3}));
    EXPECT_EQ(shell.touch.normal, (Vec3{0, 0, -side}));
  }
}

TEST(TouchCases, RoundARimTheNormalTurnsWithTheNode) {
  Case shell;
  shell.two_sided = true;
  shell.clearance = 0.02;
  for (const double angle : {0.0, 0.5, 1.5, 3.0}) {
    const Vec3 at{1 + 0.015 * std::sin(angle), 0.5, 0.015 * std::cos(angle)};
    ASSERT_TRUE(shell(at, at));
    EXPECT_NEAR(shell.touch.normal[0], std::sin(angle), 1e-9);
    EXPECT_NEAR(shell.touch.normal[2], std::cos(angle), 1e-9);
    EXPECT_NEAR(shell.touch.end_gap, -0.005, 1e-12);
  }
  // Over the edge's rounding: held where it came from.
  ASSERT_TRUE(shell({1.01, 0.5, 0.02}, {1.01, 0.5, -0.02}));
  EXPECT_GT(shell.touch.normal[2], 0.5);
  EXPECT_LT(shell.touch.end_gap, 0);
}

TEST(TouchCases, AFastNodeThatPassesTheRimIsNotCaught) {
  Case shell;
  shell.two_sided = true;
  EXPECT_FALSE(shell({2.5, 0.5, 0.05}, {0.5, 0.5, -0.04}));
  Case solid;
  EXPECT_FALSE(solid({2.5, 0.5, 0.05}, {0.5, 0.5, -0.04}));
}

TEST(TouchCases, FacesWithoutAreaAndBadNumbersNeverTouch) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const bool two_sided : {false, true}) {
    Case any;
    any.two_sided = two_sided;
    const FaceShape line{4, {{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 0, 0}}}};
    const FaceShape point{3, {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {}}}};
    EXPECT_FALSE(any({0.5, 0, 1e-3}, {0.5, 0, -1e-3}, line));
    EXPECT_FALSE(any({0.5, 0, 5}, {0.5, 0, -5}, line));
    EXPECT_FALSE(any({0, 0, 1e-3}, {0, 0, -1e-3}, point));
    for (const double bad : {nan, infinity}) {
      EXPECT_FALSE(any({0.5, 0.5, bad}, {0.5, 0.5, -0.01}));
      EXPECT_FALSE(any({0.5, 0.5, 0.01}, {bad, 0.5, -0.01}));
      FaceShape broken = square;
      broken.x[2][1] = bad;
      EXPECT_FALSE(any({0.5, 0.5, 0.01}, {0.5, 0.5, -0.01}, broken));
    }
  }
}

TEST(TouchCases, AQuadrilateralCollapsedToATriangleTouchesAsOne) {
  const FaceShape triangle{3, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {}}}};
  const FaceShape quad{4, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}}}};
  for (const double end : {-0.01, -4.0}) {
    Case a, b;
    ASSERT_TRUE(a({0.25, 0.3, 0.01}, {0.25, 0.3, end}, triangle));
    ASSERT_TRUE(b({0.25, 0.3, 0.01}, {0.25, 0.3, end}, quad));
    EXPECT_NEAR(a.touch.end_gap, b.touch.end_gap, 1e-13);
    EXPECT_NEAR(b.touch.weights[2] + b.touch.weights[3], a.touch.weights[2], 1e-12);
  }
}

TEST(TouchCases, SliversAreNotPassedThrough) {
  for (const double width : {1e-3, 1e-6}) {
    const FaceShape sliver{3, {{{0, 0, 0}, {1, 0, 0}, {0.5, width, 0}, {}}}};
    for (const double length : {1e-4 * width, 0.01, 3.0}) {
      Case solid;
      ASSERT_TRUE(solid({0.5, width / 3, 0.4 * length}, {0.5, width / 3, -0.6 * length}, sliver))
          << width << " " << length;
      EXPECT_NEAR(solid.touch.end_gap, -0.6 * length, 1e-9 * length);
    }
  }
}

}  // namespace
}  // namespace tenon::contact

// SPDX-License-Identifier: BSD-3-Clause
// Edges that touch between their ends.
#include "components/contact_geometry/edge_touch.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/contact_geometry/random_scenes.hpp"

namespace tenon::contact {
namespace {

const double half_edge = std::sqrt(0.5);  // length of half the sum of normals at a right angle

EdgeShape edge(const Vec3& middle, const Vec3& half) {
  return {{middle - half, middle + half}};
}

EdgeShape shifted(EdgeShape e, const Vec3& by) {
  for (Vec3& x : e.x) x = x + by;
  return e;
}

TEST(EdgeTouch, TwoRolledBarsMeetAtAnyRate) {
  const EdgeShape lower = edge({0, 0, 0}, {1, 0, 0}), upper = edge({0.2, 0.3, 0.01}, {0, 1, 0});
  for (const double travel : {0.005, 0.02, 0.5, 20.0}) {
    EdgeTouch touch;
    ASSERT_TRUE(touch_edges(upper, shifted(upper, {0, 0, -travel}), lower, lower, {0, 0, -half_edge}, {0, 0, half_edge},
                            0.0, 0.1, 0.02, touch));
    EXPECT_NEAR(touch.normal[2], 1.0, 1e-14);
    EXPECT_NEAR(touch.gap, 0.01, 1e-12);
    EXPECT_NEAR(touch.end_gap, 0.01 - travel, 1e-12);
    EXPECT_NEAR(touch.first, 0.35, 1e-9);
    EXPECT_NEAR(touch.second, 0.6, 1e-9);
  }
}

TEST(EdgeTouch, PenetrationIsRemovedUpToTheDepth) {
  const EdgeShape lower = edge({0, 0, 0}, {1, 0, 0});
  EdgeTouch touch;
  const Vec3 down{0, 0, -half_edge}, up{0, 0, half_edge};
  const EdgeShape deep = edge({0, 0, -0.05}, {0, 1, 0}), deeper = edge({0, 0, -0.15}, {0, 1, 0});
  ASSERT_TRUE(touch_edges(deep, deep, lower, lower, down, up, 0.0, 0.1, 0.02, touch));
  EXPECT_NEAR(touch.end_gap, -0.05, 1e-14);
  EXPECT_GT(touch.normal[2], 0.0);
  EXPECT_FALSE(touch_edges(deeper, deeper, lower, lower, down, up, 0.0, 0.1, 0.02, touch));
}

TEST(EdgeTouch, OnlySharpEdgesTouchAndOnlyFromOutside) {
  const EdgeShape lower = edge({0, 0, 0}, {1, 0, 0}), upper = edge({0, 0, 0.01}, {0, 1, 0});
  EdgeTouch touch;
  const auto touches = [&](const Vec3& first, const Vec3& second) {
    return touch_edges(upper, shifted(upper, {0, 0, -0.02}), lower, lower, first, second, 0.0, 0.1, 0.02, touch);
  };
  EXPECT_TRUE(touches({0, 0, -half_edge}, {0, 0, half_edge}));
  EXPECT_FALSE(touches({0, 0, -1}, {0, 0, half_edge}));          // faces flat to each other
  EXPECT_FALSE(touches({0, 0, -half_edge}, {0, half_edge, 0}));  // the second's faces look sideways
  EXPECT_TRUE(touches({0, 0, -half_edge}, {0, 0.5, 0.5}));       // at the border of its cone
  EXPECT_TRUE(touches({0, 0, 0}, {0, 0, half_edge}));            // a shell's rim against a solid
}

TEST(EdgeTouch, RimsOfShellsKeepTheirSide) {
  Random random(31);
  int fast = 0;
  for (int i = 0; i < 5000; ++i) {
    // A crossing at known places and a known time.
    const double s = random(0.05, 0.95), u = random(0.05, 0.95), t = random(0.05, 0.95);
    const double travel = 20 * std::pow(1e-4, random(0, 1));
    const Vec3 a = random.direction(), b = random.direction(), n = cross(a, b);
    if (norm(n) < 0.1) continue;
    const Vec3 velocity = travel * random.direction();
    if (std::abs(dot(velocity, n)) < 0.02 * travel) continue;
    const EdgeShape second = edge((0.5 - u) * b, 0.5 * b);
    const EdgeShape first0 = edge((0.5 - s) * a - t * velocity, 0.5 * a), first1 = shifted(first0, velocity);
    EdgeTouch touch;
    const bool found = touch_edges(first0, first1, second, second, {0, 0, 0}, {0, 0, 0}, 0.0, 0.0, 0.1, touch);
    if (travel < 0.11 && !found) continue;  // the foot of the end may have left the edges
    ASSERT_TRUE(found) << i;
    EXPECT_LT(dot(touch.normal, velocity), 0.0);
    EXPECT_GT(touch.gap, 0.0);
    EXPECT_LT(touch.end_gap, 0.0);
    if (travel > 0.2) {
      EXPECT_NEAR(touch.first, s, 1e-6);
      EXPECT_NEAR(touch.second, u, 1e-6);
      ++fast;
    }
  }
  EXPECT_GT(fast, 1000);
}

TEST(EdgeTouch, ParallelEdgesEndsAndBadNumbersAreLeftToOthers) {
  const EdgeShape lower = edge({0, 0, 0}, {1, 0, 0});
  EdgeTouch touch;
  const auto touches = [&](const EdgeShape& first) {
    return touch_edges(first, shifted(first, {0, 0, -0.02}), lower, lower, {0, 0, 0}, {0, 0, 0}, 0.0, 0.1, 0.02, touch);
  };
  EXPECT_TRUE(touches(edge({0, 0, 0.01}, {0, 1, 0})));
  EXPECT_FALSE(touches(edge({0, 0, 0.01}, {1, 0.01, 0})));
  EXPECT_FALSE(touches(edge({1.001, 0, 0.01}, {0, 1, 0})));
  EXPECT_FALSE(touches(edge({0, 0, 0.01}, {0, 0, 0})));
  EXPECT_FALSE(touches(edge({0, 0, std::nan("")}, {0, 1, 0})));
}

}  // namespace
}  // namespace tenon::contact

// SPDX-License-Identifier: BSD-3-Clause
// Fast motions of node and face: no crossing is lost, none is invented, and the side is right.
#include "components/contact_geometry/face_touch.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/contact_geometry/random_scenes.hpp"

namespace tenon::contact {
namespace {

constexpr double huge_margin = 1e3;

struct Motion {
  Vec3 node0, node1;
  FaceShape face0, face1;
  double time;                    // of a crossing that is known
  std::array<double, 4> weights;  // and its place
};

FaceShape between(const FaceShape& a, const FaceShape& b, double t) {
  FaceShape face = a;
  for (int i = 0; i < 4; ++i) face.x[i] = a.x[i] + t * (b.x[i] - a.x[i]);
  return face;
}

/// A face that turns and deforms by up to `turning` of its size and a node that goes through it at a known time.
Motion random_crossing(Random& random, int kind, double travel, double turning, bool glancing) {
  Motion m;
  m.face0 = random_face(random, kind);
  m.face1 = m.face0;
  if (kind == 4) {
    const int shift = random.below(3);
    for (Vec3& x : m.face1.x) x[shift] += turning;
  } else {
    for (Vec3& x : m.face1.x) x = x + random.in_cube(turning);
  }
  const Vec3 drift = random.in_cube(travel);
  for (Vec3& x : m.face1.x) x = x + drift;
  m.time = random(0.02, 0.98);
  m.weights = random_place(random, m.face0);
  const Vec3 meeting = place_on(between(m.face0, m.face1, m.time), m.weights);
  Vec3 direction = random.direction();
  if (glancing) {
    const Vec3 n = face_normal(between(m.face0, m.face1, m.time), m.weights);
    direction = direction - dot(direction, n) * n;
    direction = (1 / norm(direction)) * direction + (random.below(2) ? 0.0175 : -0.0175) * n;  // 89 degrees
  }
  const Vec3 velocity = drift + travel * direction;
  m.node0 = meeting - m.time * velocity;
  m.node1 = meeting + (1 - m.time) * velocity;
  return m;
}

bool touches(const Motion& m, bool two_sided, Touch& touch) {
  return touch_face(m.node0, m.node1, m.face0, m.face1, 0.0, 0.1, two_sided, huge_margin, touch);
}

/// What any crossing that is reported must fulfil.
void expect_true_crossing(const Motion& m, const Touch& touch, double travel) {
  const double t = touch.time;
  const Vec3 node = m.node0 + t * (m.node1 - m.node0);
  const FaceShape face = between(m.face0, m.face1, t);
  EXPECT_LE(norm(node - place_on(face, touch.weights)), 1e-7 * (1 + travel));
  // Just before, the node is on the side to which the normal points.
  const double before = t - 1e-4 / (1 + travel);
  const Vec3 offset =
      m.node0 + before * (m.node1 - m.node0) - place_on(between(m.face0, m.face1, before), touch.weights);
  const Vec3 n = face_normal(face, touch.weights);
  const double side = dot(touch.normal, n) >= 0 ? 1.0 : -1.0;
  if (std::abs(dot(offset, n)) > 1e-3 * norm(offset)) {
    EXPECT_GT(side * dot(offset, n), 0.0);
  }
  EXPECT_NEAR(norm(touch.normal), 1.0, 1e-12);
}

TEST(FaceTouch, NoFastCrossingIsLostOrInvented) {
  Random random(11);
  for (int i = 0; i < 10000; ++i) {
    const double travel = 0.2 * std::pow(100.0, random(0, 1));
    const Motion m = random_crossing(random, i % kinds_of_face, travel, i % 3 == 0 ? 0.0 : 0.1, i % 5 == 0);
    Touch touch;
    ASSERT_TRUE(touches(m, true, touch)) << "motion " << i;
    ASSERT_LE(touch.time, m.time + 1e-7) << "motion " << i;
    expect_true_crossing(m, touch, travel);
    if (HasFailure()) FAIL() << "motion " << i << " of kind " << i % kinds_of_face;
  }
}

TEST(FaceTouch, ACrossingOfThePlaneEndsWithTheGapToBeRemoved) {
  Random random(12);
  for (int i = 0; i < 3000; ++i) {
    const double travel = 0.5 * std::pow(40.0, random(0, 1));
    const Motion m = random_crossing(random, 1, travel, 0.0, i % 5 == 0);
    Touch touch;
    ASSERT_TRUE(touches(m, true, touch));
    EXPECT_NEAR(touch.time, m.time, 1e-8);
    const double through = std::abs(dot(touch.normal, (m.node1 - m.node0) - (m.face1.x[0] - m.face0.x[0])));
    EXPECT_NEAR(touch.gap, m.time * through, 1e-8 * travel);
    EXPECT_NEAR(touch.end_gap, (m.time - 1) * through, 1e-8 * travel);
  }
}

TEST(FaceTouch, SolidsAreEnteredFromOutsideOnly) {
  Random random(13);
  for (int i = 0; i < 3000; ++i) {
    const Motion m = random_crossing(random, i % 2 ? 1 : 6, random(0.5, 20), 0.0, false);
    const Vec3 n = face_normal(m.face0, m.weights);
    const double along = dot(n, (m.node1 - m.node0) - (m.face1.x[0] - m.face0.x[0]));
    Touch touch;
    const bool found = touches(m, false, touch);
    if (along < 0) {
      ASSERT_TRUE(found);
      EXPECT_NEAR(touch.time, m.time, 1e-8);
      EXPECT_NEAR(dot(touch.normal, n), 1.0, 1e-9);
    } else if (found) {
      // It leaves the solid: at most a touch that pulls nothing back.
      EXPECT_GE(touch.end_gap, 0.0);
    }
  }
}

TEST(FaceTouch, SlowMotionsKeepTheSideOfTheStart) {
  Random random(14);
  int touched = 0;
  for (int i = 0; i < 10000; ++i) {
    const double travel = 0.09 * std::pow(1e-4, random(0, 1));
    Motion m = random_crossing(random, i % 2 ? 1 : 6, travel, 0.0, i % 5 == 0);
    const Vec3 n = face_normal(m.face0, m.weights);
    const double height = dot(n, m.node0 - m.face0.x[0]);
    if (std::abs(height) < 1e-9) continue;
    Touch touch;
    ASSERT_TRUE(touches(m, true, touch)) << "motion " << i;
    EXPECT_GT(dot(touch.normal, n) * height, 0.0) << "motion " << i;
    if (touch.inside) {
      EXPECT_LT(touch.end_gap, 0.0) << "motion " << i;
    }
    ++touched;
  }
  EXPECT_GT(touched, 9000);
}

TEST(FaceTouch, ACommonVelocityChangesRoundOffOnly) {
  Random random(15);
  for (int i = 0; i < 5000; ++i) {
    const double travel = 20 * std::pow(1e-4, random(0, 1));
    const Motion m = random_crossing(random, i % 2 ? 1 : 2, travel, 0.0, false);
    const Vec3 by = random.in_cube(100), start = random.in_cube(10);
    Motion fast = m;
    fast.node0 = fast.node0 + start;
    fast.node1 = fast.node1 + start + by;
    fast.face0 = moved(fast.face0, start);
    fast.face1 = moved(fast.face1, start + by);
    Touch a, b;
    const bool found = touches(m, true, a);
    ASSERT_EQ(found, touches(fast, true, b));
    if (!found) continue;
    EXPECT_NEAR(a.gap, b.gap, 1e-9 * (1 + travel));
    EXPECT_NEAR(a.end_gap, b.end_gap, 1e-9 * (1 + travel));
    EXPECT_LE(norm(a.normal - b.normal), 1e-8);
  }
}

TEST(FaceTouch, AMirroredSceneHasTheMirroredAnswer) {
  Random random(16);
  const auto mirror = [](Vec3 x) { return Vec3{x[0], -x[1], x[2]}; };
  for (int i = 0; i < 5000; ++i) {
    const double travel = 20 * std::pow(1e-4, random(0, 1));
    const Motion m = random_crossing(random, i % kinds_of_face, travel, 0.05, false);
    Motion reflected = m;
    reflected.node0 = mirror(m.node0);
    reflected.node1 = mirror(m.node1);
    for (int k = 0; k < 4; ++k) {
      reflected.face0.x[k] = mirror(m.face0.x[k]);
      reflected.face1.x[k] = mirror(m.face1.x[k]);
    }
    Touch a, b;
    const bool found = touches(m, true, a);
    ASSERT_EQ(found, touches(reflected, true, b));
    if (!found) continue;
    EXPECT_EQ(a.weights, b.weights);
    EXPECT_EQ(a.normal, mirror(b.normal));
    EXPECT_EQ(a.gap, b.gap);
    EXPECT_EQ(a.end_gap, b.end_gap);
  }
}

}  // namespace
}  // namespace tenon::contact

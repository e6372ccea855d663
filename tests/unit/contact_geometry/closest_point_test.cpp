// SPDX-License-Identifier: BSD-3-Clause
// Closest points of faces against brute force.
#include "components/contact_geometry/closest_point.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/contact_geometry/random_scenes.hpp"

namespace tenon::contact {
namespace {

using Wide = long double;

Wide squared_distance(const FaceShape& face, const Vec3& x, Wide xi, Wide eta) {
  Wide sum = 0;
  for (int c = 0; c < 3; ++c) {
    const auto at = [&](int i) { return static_cast<Wide>(face.x[i][c]) - x[c]; };
    const Wide p = face.corners == 3 ? (1 - xi) * at(0) + xi * ((1 - eta) * at(1) + eta * at(2))
                                     : (1 - xi) * (1 - eta) * at(0) + xi * (1 - eta) * at(1) + xi * eta * at(2) +
                                           (1 - xi) * eta * at(3);
    sum += p * p;
  }
  return sum;
}

/// The best of a grid of places, then of ever finer grids around it.
Wide brute_force_distance(const FaceShape& face, const Vec3& x) {
  Wide best = std::numeric_limits<Wide>::infinity(), best_xi = 0, best_eta = 0, half = 0.5;
  Wide middle_xi = 0.5, middle_eta = 0.5;
  for (int level = 0; level < 12; ++level) {
    const int n = level == 0 ? 32 : 6;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) {
        const Wide xi = std::clamp<Wide>(middle_xi + half * (2.0L * i / n - 1), 0, 1);
        const Wide eta = std::clamp<Wide>(middle_eta + half * (2.0L * j / n - 1), 0, 1);
        const Wide d = squared_distance(face, x, xi, eta);
        if (d < best) best = d, best_xi = xi, best_eta = eta;
      }
    half *= level == 0 ? 3.0L / 32 : 0.5L;
    middle_xi = best_xi;
    middle_eta = best_eta;
  }
  return std::sqrt(best);
}

void expect_consistent(const FaceShape& face, const Vec3& x, const ClosestPoint& c, double size, bool distinct) {
  double sum = 0;
  for (const double w : c.weights) {
    EXPECT_GE(w, 0.0);
    sum += w;
  }
  EXPECT_NEAR(sum, 1.0, 1e-14);
  EXPECT_LE(norm(c.point - place_on(face, c.weights)), 1e-12 * size + 1e-15 * norm(x));
  EXPECT_NEAR(norm(c.point - x), c.distance, 1e-12 * (size + norm(x)));
  EXPECT_EQ(c.inside, c.feature == -1);
  if (c.feature >= 4) {
    EXPECT_EQ(c.weights[c.feature - 4], 1.0);
  }
  // The place is one of the patch, so the distance is attained: w0 w2 = w1 w3 for (1-xi)(1-eta), xi (1-eta), ...
  const auto& w = c.weights;
  if (face.corners == 4 && distinct) {
    EXPECT_NEAR(w[0] * w[2], w[1] * w[3], 1e-14);
  }
}

TEST(ClosestPoint, NoSampleOfTheFaceIsCloser) {
  Random random(1);
  int inside = 0;
  for (int i = 0; i < 10000; ++i) {
    const FaceShape face = random_face(random, i % kinds_of_face);
    const double away = std::pow(10.0, random(-4, 1));
    const Vec3 x = place_on(face, random_place(random, face)) + away * random.direction();
    const ClosestPoint c = closest_point(face, x);
    const double sampled = static_cast<double>(brute_force_distance(face, x));
    EXPECT_LE(c.distance, sampled + 1e-12) << "face " << i;
    expect_consistent(face, x, c, 1.0, i % kinds_of_face != 4);
    inside += c.inside;
  }
  EXPECT_GT(inside, 3000);
}

TEST(ClosestPoint, TakesTheNearerOfTwoBranchesOfAStronglyWarpedFace) {
  // A saddle z = 4 (x - 1/2)(y - 1/2) seen from above its centre: two places at the same distance on the falling sides.
  const FaceShape saddle{4, {{{0, 0, 1}, {1, 0, -1}, {1, 1, 1}, {0, 1, -1}}}};
  for (const double shift : {-1e-3, 1e-3}) {
    const ClosestPoint c = closest_point(saddle, {0.5 + shift, 0.5 + shift, 2.0});
    EXPECT_NEAR(c.distance, static_cast<double>(brute_force_distance(saddle, {0.5 + shift, 0.5 + shift, 2.0})), 1e-9);
    EXPECT_EQ(c.point[0] > 0.5, shift > 0);
  }
}

TEST(ClosestPoint, FacesWithoutAreaAreLinesOrPoints) {
  const FaceShape point{4, {{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}}};
  EXPECT_DOUBLE_EQ(closest_point(point, {1, 2, 5}).distance, 2.0);
  EXPECT_EQ(face_normal(point, {0.25, 0.25, 0.25, 0.25}), (Vec3{0, 0, 0}));
  const FaceShape line{3, {{{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {}}}};
  const ClosestPoint c = closest_point(line, {2, 1, 0});
  EXPECT_DOUBLE_EQ(c.distance, 1.0);
  EXPECT_FALSE(c.inside);
  EXPECT_EQ(face_normal(line, c.weights), (Vec3{0, 0, 0}));
  const FaceShape doubled{4, {{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}}}};
  EXPECT_DOUBLE_EQ(closest_point(doubled, {0.5, 0, 1}).distance, 1.0);
}

TEST(ClosestPoint, AQuadrilateralCollapsedToATriangleIsThatTriangle) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    FaceShape triangle = random_face(random, 6), quad = triangle;
    quad.corners = 4;
    quad.x[3] = quad.x[2];
    const Vec3 x = random.in_cube(1);
    const ClosestPoint a = closest_point(triangle, x), b = closest_point(quad, x);
    EXPECT_NEAR(a.distance, b.distance, 1e-14);
    EXPECT_LE(norm(a.point - b.point), 1e-12);
    EXPECT_LE(norm(face_normal(triangle, a.weights) - face_normal(quad, b.weights)), 1e-12);
  }
}

TEST(ClosestPoint, ScalesFromMicrometresToKilometres) {
  Random random(3);
  for (int i = 0; i < 700; ++i) {
    const FaceShape face = random_face(random, i % kinds_of_face);
    const Vec3 x = random.in_cube(1);
    const ClosestPoint at_one = closest_point(face, x);
    // Powers of two change no bit of the answer.
    for (const double scale : {0x1p-20, 0x1p10}) {
      const ClosestPoint c = closest_point(moved(face, {0, 0, 0}, scale), scale * x);
      EXPECT_EQ(c.weights, at_one.weights);
      EXPECT_EQ(c.distance, scale * at_one.distance);
      EXPECT_EQ(c.inside, at_one.inside);
    }
  }
}

TEST(ClosestPoint, AMirroredSceneHasTheMirroredAnswer) {
  Random random(4);
  for (int i = 0; i < 700; ++i) {
    FaceShape face = random_face(random, i % kinds_of_face);
    Vec3 x = random.in_cube(1);
    const ClosestPoint a = closest_point(face, x);
    for (Vec3& corner : face.x) corner[1] = -corner[1];
    x[1] = -x[1];
    const ClosestPoint b = closest_point(face, x);
    EXPECT_EQ(a.weights, b.weights);
    EXPECT_EQ(a.point, (Vec3{b.point[0], -b.point[1], b.point[2]}));
  }
}

}  // namespace
}  // namespace tenon::contact

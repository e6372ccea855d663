// SPDX-License-Identifier: BSD-3-Clause
// Nearest points of surface elements and of curved solids against brute force, and their conditions of optimality.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/mesh/sample_elements.hpp"

namespace tenon::testing {
namespace {

/// Least distance over a lattice of a surface element, then over ever finer lattices around each of the best places.
double sampled_distance(ElementKind kind, const std::vector<Vec3>& x, const Vec3& point) {
  constexpr int n = 48, fine = 8;
  const auto inside = [&](Vec3 xi) {
    if (kind == ElementKind::quad4) return Vec3{std::clamp(xi[0], -1.0, 1.0), std::clamp(xi[1], -1.0, 1.0), 0};
    xi[0] = std::clamp(xi[0], 0.0, 1.0);
    return Vec3{xi[0], std::clamp(xi[1], 0.0, 1 - xi[0]), 0};
  };
  const auto distance = [&](const Vec3& xi) { return norm(map_to_space(kind, x, xi) - point); };
  std::vector<std::pair<double, Vec3>> places;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= n; ++k) {
      const Vec3 xi = inside({2.0 * i / n - 1, 2.0 * k / n - 1, 0});
      places.emplace_back(distance(xi), xi);
    }
  std::partial_sort(places.begin(), places.begin() + 12, places.end());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < 12; ++p) {
    auto [best, centre] = places[p];
    for (double width = 2.0 / n; width > 1e-9; width *= 0.4) {
      const Vec3 around = centre;
      for (int i = -fine; i <= fine; ++i)
        for (int k = -fine; k <= fine; ++k) {
          const Vec3 xi = inside(around + (width / fine) * Vec3{1.0 * i, 1.0 * k, 0});
          if (const double d = distance(xi); d < best) best = d, centre = xi;
        }
    }
    least = std::min(least, best);
  }
  return least;
}

/// How far the foot is from being the best place: the derivative of half the squared distance along every direction
/// that stays in the element, over the distance and the element's size.
double residual_slope(ElementKind kind, const std::vector<Vec3>& x, const Vec3& point, const Vec3& xi) {
  std::array<Vec3, max_element_nodes> g;
  shape_gradients(kind, xi, g);
  const Vec3 away = map_to_space(kind, x, xi) - point;
  Vec3 du{}, dv{};
  for (std::size_t a = 0; a < x.size(); ++a) du = du + g[a][0] * x[a], dv = dv + g[a][1] * x[a];
  const double gu = dot(away, du), gv = dot(away, dv),
               scale = (norm(du) + norm(dv)) * (norm(away) + norm(du) + norm(dv));
  double worst = 0;
  const auto along = [&](bool allowed, double slope) {
    if (allowed) worst = std::max(worst, -slope);
  };
  constexpr double tiny = 1e-15;
  if (kind == ElementKind::quad4) {
    along(xi[0] < 1 - tiny, gu), along(xi[0] > -1 + tiny, -gu);
    along(xi[1] < 1 - tiny, gv), along(xi[1] > -1 + tiny, -gv);
  } else {
    const bool room = xi[0] + xi[1] < 1 - tiny;
    along(room, gu), along(room, gv), along(xi[0] > tiny, -gu), along(xi[1] > tiny, -gv);
    along(xi[1] > tiny, gu - gv), along(xi[0] > tiny, gv - gu);
  }
  return worst / scale;
}

TEST(NearestSurfacePoint, IsTheFootOfThePerpendicularOrTheBestOfTheRim) {
  Random random(51);
  for (const ElementKind kind : {ElementKind::quad4, ElementKind::tri3})
    for (const double amount : {0.0, 0.3, 0.7, 1.2})
      for (const double far : {0.05, 1.0, 4.0, 100.0})
        for (int trial = 0; trial < 400; ++trial) {
          const std::vector<Vec3> x = distorted_element(kind, amount, random);
          const Vec3 point = map_to_space(kind, x, local_point(kind, random)) + random.vector(-far, far);
          const NearestPoint found = nearest_point(kind, x, point);
          ASSERT_EQ(overshoot(kind, found.xi), 0) << topology(kind).name << " " << amount << " " << far;
          ASSERT_NEAR(found.distance, norm(map_to_space(kind, x, found.xi) - point), 1e-14 * (5 + far));
          ASSERT_LT(residual_slope(kind, x, point, found.xi), 1e-12)
              << topology(kind).name << " " << amount << " " << far << " trial " << trial;
        }
}

TEST(NearestSurfacePoint, IsAsNearAsBruteForceFinds) {
  Random random(52);
  for (const ElementKind kind : {ElementKind::quad4, ElementKind::tri3})
    for (const double amount : {0.3, 0.7, 1.2})
      for (const double far : {0.5, 3.0})
        for (int trial = 0; trial < 25; ++trial) {
          const std::vector<Vec3> x = distorted_element(kind, amount, random);
          const Vec3 point = map_to_space(kind, x, local_point(kind, random)) + random.vector(-far, far);
          const NearestPoint found = nearest_point(kind, x, point);
          ASSERT_LE(found.distance, sampled_distance(kind, x, point) + 1e-12)
              << topology(kind).name << " " << amount << " " << far << " trial " << trial;
        }
}

TEST(NearestSurfacePoint, OfAPointOnTheElementIsThatPoint) {
  Random random(53);
  for (const ElementKind kind : {ElementKind::quad4, ElementKind::tri3})
    for (const double amount : {0.0, 0.3})
      for (int trial = 0; trial < 500; ++trial) {
        const std::vector<Vec3> x = distorted_element(kind, amount, random);
        const Vec3 xi = local_point(kind, random);
        const NearestPoint found = nearest_point(kind, x, map_to_space(kind, x, xi));
        EXPECT_LT(found.distance, 2e-15);
        EXPECT_LT(norm(found.xi - xi), 1e-13);
      }
}

TEST(NearestSurfacePoint, FollowsTheNormalOfAFlatElement) {
  // Straight above an interior point the foot is that point, however far.
  Random random(54);
  for (const double far : {1e-12, 1e-6, 1.0, 1e3, 1e6}) {
    const std::vector<Vec3> quad{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, tri{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    for (int trial = 0; trial < 100; ++trial) {
      const Vec3 foot{random.between(0.1, 0.9), random.between(0.1, 0.9), 0};
      for (const double side : {-far, far}) {
        const Vec3 point = foot + Vec3{0, 0, side};
        const NearestPoint on_quad = nearest_point(ElementKind::quad4, quad, point);
        EXPECT_LT(norm(on_quad.xi - Vec3{foot[0] - 1, foot[1] - 1, 0}), 1e-14);
        EXPECT_NEAR(on_quad.distance, far, 1e-17 + 1e-15 * far);
        EXPECT_LT(norm(nearest_point(ElementKind::tri3, tri, point).xi - Vec3{foot[0] / 2, foot[1] / 2, 0}), 1e-14);
      }
    }
  }
}

TEST(NearestSurfacePoint, TiesHaveOneAnswer) {
  // A saddle has two valleys equally far from a point on its axis; the square's centre, four equal corners seen from
  // a tilted line. Whatever is chosen, mirrored and repeated calls choose it again, to the bit.
  const std::vector<Vec3> saddle{{-1, -1, 1}, {1, -1, -1}, {1, 1, 1}, {-1, 1, -1}};
  for (const double height : {1.5, 3.0, -3.0}) {
    const NearestPoint first = nearest_point(ElementKind::quad4, saddle, {0, 0, height});
    for (int repeat = 0; repeat < 3; ++repeat) {
      const NearestPoint again = nearest_point(ElementKind::quad4, saddle, {0, 0, height});
      EXPECT_EQ(again.xi, first.xi);
      EXPECT_EQ(again.distance, first.distance);
    }
    EXPECT_NEAR(std::abs(first.xi[0]), std::abs(first.xi[1]), 1e-14);
    EXPECT_NEAR(first.distance, std::sqrt(2 + (std::abs(height) - 1) * (std::abs(height) - 1)),
                std::abs(height) == 3 ? 1e-14 : 1);
  }
}

TEST(NearestCurvedPoint, IsAtABestPlaceOfTheElement) {
  // No step along the reference element brings the point nearer: looked at with differences of the exact distance.
  Random random(55);
  for (const ElementKind kind : {ElementKind::hex20, ElementKind::tet10})
    for (int trial = 0; trial < 300; ++trial) {
      const std::vector<Vec3> x = distorted_element(kind, kind == ElementKind::hex20 ? 0.2 : 0.07, random);
      const Vec3 point = map_to_space(kind, x, element_centre(kind)) + random.vector(-5, 5);
      const NearestPoint found = nearest_point(kind, x, point);
      ASSERT_LE(overshoot(kind, found.xi), 4e-16);
      if (found.distance == 0) continue;
      EXPECT_NEAR(found.distance, norm(map_to_space(kind, x, found.xi) - point), 1e-13);
      double nearer = found.distance;
      for (int k = 0; k < 400; ++k) {
        const double width = std::pow(10.0, -random.between(0, 6));
        const Vec3 xi = found.xi + width * random.vector(-1, 1);
        if (overshoot(kind, xi) == 0) nearer = std::min(nearer, norm(map_to_space(kind, x, xi) - point));
      }
      EXPECT_GE(nearer, found.distance - 1e-13) << topology(kind).name << " trial " << trial;
    }
}

}  // namespace
}  // namespace tenon::testing

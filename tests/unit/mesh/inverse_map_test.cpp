// SPDX-License-Identifier: BSD-3-Clause
// Inverse map and nearest point against their definition, dense sampling and awkward elements.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/mesh/sample_elements.hpp"

namespace tenon::testing {
namespace {

/// Whether the determinant is positive all over an element (looked at on a lattice).
bool is_valid(ElementKind kind, const std::vector<Vec3>& x) {
  constexpr int n = 6;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k) {
        const Vec3 xi{2.0 * i / n - 1, 2.0 * j / n - 1, 2.0 * k / n - 1};
        if (overshoot(kind, xi) == 0 && xi[2] < 1 && jacobian_determinant(kind, x, xi) < 1e-3) return false;
      }
  return true;
}

TEST(InverseMap, ReturnsToTheLocalPointInside) {
  Random random(11);
  for (const ElementKind kind : solid_kinds)
    for (const double amount : {0.0, 0.1, 0.25}) {
      for (int trial = 0; trial < 300; ++trial) {
        const std::vector<Vec3> x = distorted_element(kind, amount, random);
        if (!is_valid(kind, x)) continue;
        const Vec3 xi = local_point(kind, random);
        const InverseMap found = inverse_map(kind, x, map_to_space(kind, x, xi));
        ASSERT_TRUE(found.converged) << topology(kind).name;
        EXPECT_LT(norm(found.xi - xi), 2e-12) << topology(kind).name << " " << amount;
      }
    }
}

TEST(InverseMap, FindsEveryInsidePointOfStronglyDistortedBricks) {
  Random random(12);
  int tried = 0;
  while (tried < 3000) {
    const std::vector<Vec3> x = distorted_element(ElementKind::hex8, 0.6, random);
    if (!is_valid(ElementKind::hex8, x)) continue;
    ++tried;
    const Vec3 xi = local_point(ElementKind::hex8, random);
    const Vec3 point = map_to_space(ElementKind::hex8, x, xi);
    const InverseMap found = inverse_map(ElementKind::hex8, x, point);
    ASSERT_TRUE(found.converged);
    EXPECT_LT(overshoot(ElementKind::hex8, found.xi), 1e-10);
    EXPECT_LT(norm(map_to_space(ElementKind::hex8, x, found.xi) - point), 1e-14);
  }
}

TEST(InverseMap, ExtrapolatesAffineElementsHoweverFar) {
  // Corners without rounding errors, which the trilinear terms would magnify by the square of the distance.
  const auto place = [](const Vec3& xi) {
    return Vec3{3 + xi[0] + 0.25 * xi[1], -2 + xi[1] - 0.125 * xi[2], 0.5 + 1.5 * xi[2] + 0.5 * xi[0]};
  };
  Random random(13);
  for (const ElementKind kind : {ElementKind::hex8, ElementKind::tet4, ElementKind::wedge6})
    for (const double far : {2.0, 1e3, 1e6}) {
      std::vector<Vec3> x = reference_element(kind);
      for (Vec3& p : x) p = place(p);
      const Vec3 xi = random.vector(-far, far);
      const InverseMap found = inverse_map(kind, x, place(xi));
      ASSERT_TRUE(found.converged);
      EXPECT_LT(norm(found.xi - xi), 4e-15 * far) << topology(kind).name << far;
    }
}

TEST(InverseMap, OutsidePointsEitherConvergeToTheirSolutionOrSayNo) {
  Random random(14);
  int converged = 0;
  for (const ElementKind kind : solid_kinds)
    for (int trial = 0; trial < 1000; ++trial) {
      const std::vector<Vec3> x = distorted_element(kind, 0.25, random);
      const Vec3 point = Vec3{3, -2, 0.7} + random.vector(-20, 20);
      const InverseMap found = inverse_map(kind, x, point);
      ASSERT_TRUE(std::isfinite(found.xi[0]) && std::isfinite(found.xi[1]) && std::isfinite(found.xi[2]));
      if (!found.converged) continue;
      ++converged;
      EXPECT_LT(norm(map_to_space(kind, x, found.xi) - point), 1e-11 * (1 + norm(found.xi)));
    }
  EXPECT_GT(converged, 3000);
}

TEST(InverseMap, SurvivesThinTaperedAndFlatElements) {
  std::vector<Vec3> thin = reference_element(ElementKind::hex8);
  for (Vec3& p : thin) p = {p[0], 1e-4 * p[1], 1e4 * p[2]};
  const InverseMap in_thin = inverse_map(ElementKind::hex8, thin, {0.25, 0.5e-4, -0.75e4});
  ASSERT_TRUE(in_thin.converged);
  EXPECT_LT(norm(in_thin.xi - Vec3{0.25, 0.5, -0.75}), 1e-12);

  std::vector<Vec3> tapered = reference_element(ElementKind::hex8);
  for (std::size_t a = 4; a < 8; ++a) tapered[a][0] *= 0.1, tapered[a][1] *= 0.1;
  Random random(15);
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 xi = local_point(ElementKind::hex8, random);
    const InverseMap found = inverse_map(ElementKind::hex8, tapered, map_to_space(ElementKind::hex8, tapered, xi));
    ASSERT_TRUE(found.converged);
    EXPECT_LT(norm(found.xi - xi), 1e-12);
  }

  for (const ElementKind kind : solid_kinds) {
    std::vector<Vec3> flat = reference_element(kind);
    for (Vec3& p : flat) p[2] = 0;
    const InverseMap found = inverse_map(kind, flat, {0.1, 0.1, 0.5});
    EXPECT_FALSE(found.converged) << topology(kind).name;
    EXPECT_TRUE(std::isfinite(found.xi[0]) && std::isfinite(found.xi[1]) && std::isfinite(found.xi[2]));
  }
}

TEST(InverseMap, GivesTheSameBitsWhereverTheElementLies) {
  // The corners are seen from the point, so moving both by a power of two that keeps all digits changes nothing.
  Random random(16);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<Vec3> x = reference_element(ElementKind::hex8);
    for (Vec3& p : x)
      for (double& c : p) c += std::floor(random.between(-64, 64)) / 256;
    Vec3 point = random.vector(-1, 1);
    for (double& c : point) c = std::floor(c * 1024) / 1024;
    const Vec3 here = inverse_map(ElementKind::hex8, x, point).xi;
    for (Vec3& p : x) p = p + Vec3{1024, -512, 256};
    EXPECT_EQ(inverse_map(ElementKind::hex8, x, point + Vec3{1024, -512, 256}).xi, here);
  }
}

TEST(Overshoot, IsZeroInsideAndGrowsOutside) {
  EXPECT_EQ(overshoot(ElementKind::hex8, {1, -1, 0.5}), 0);
  EXPECT_EQ(overshoot(ElementKind::hex8, {1.5, 0, 0}), 0.5);
  EXPECT_EQ(overshoot(ElementKind::tet4, {-0.25, 0.5, 0.5}), 0.5);
  EXPECT_EQ(overshoot(ElementKind::wedge6, {0.25, 0.25, -2}), 1);
  EXPECT_EQ(overshoot(ElementKind::pyramid5, {0, 0, 1}), 0);
  EXPECT_EQ(overshoot(ElementKind::pyramid5, {0.5, 0, 0.75}), 0.25);
  EXPECT_EQ(overshoot(ElementKind::pyramid5, {0, 0, -0.5}), 1);
}

/// Least distance over a lattice of the reference element, then over ever finer lattices around the best place.
double sampled_distance(ElementKind kind, const std::vector<Vec3>& x, const Vec3& point) {
  constexpr int n = 20;
  Vec3 centre{0, 0, 0};
  double width = 1, least = std::numeric_limits<double>::infinity();
  for (int level = 0; level < 12; ++level, width *= 0.3) {
    const Vec3 around = centre;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j)
        for (int k = 0; k <= n; ++k) {
          Vec3 xi = around + width * Vec3{2.0 * i / n - 1, 2.0 * j / n - 1, 2.0 * k / n - 1};
          if (kind == ElementKind::hex8 || kind == ElementKind::hex20)
            for (double& c : xi) c = std::clamp(c, -1.0, 1.0);
          if (overshoot(kind, xi) > 0) continue;
          if (const double d = norm(map_to_space(kind, x, xi) - point); d < least) least = d, centre = xi;
        }
  }
  return least;
}

TEST(NearestPoint, IsAsNearAsDenseSamplingFinds) {
  Random random(17);
  for (const ElementKind kind : solid_kinds)
    for (int trial = 0; trial < 12; ++trial) {
      const std::vector<Vec3> x = distorted_element(kind, 0.3, random);
      if (!is_valid(kind, x)) continue;
      const Vec3 centre = map_to_space(kind, x, element_centre(kind));
      const Vec3 point = centre + random.vector(-4, 4);
      const NearestPoint found = nearest_point(kind, x, point);
      const double sampled = sampled_distance(kind, x, point);
      EXPECT_LE(overshoot(kind, found.xi), 1e-15);
      EXPECT_LE(found.distance, sampled + 1e-12) << topology(kind).name;
      EXPECT_NEAR(found.distance, norm(map_to_space(kind, x, found.xi) - point), 1e-13);
      if (kind == ElementKind::hex8) {
        EXPECT_NEAR(found.distance, sampled, 1e-4);
      }
    }
}

TEST(NearestPoint, IsThePointItselfInside) {
  Random random(18);
  for (const ElementKind kind : solid_kinds)
    for (int trial = 0; trial < 50; ++trial) {
      const std::vector<Vec3> x = distorted_element(kind, 0.1, random);
      const Vec3 xi = local_point(kind, random);
      const NearestPoint found = nearest_point(kind, x, map_to_space(kind, x, xi));
      EXPECT_LT(found.distance, 1e-14);
      EXPECT_LT(norm(found.xi - xi), 1e-12);
    }
}

TEST(NearestPoint, OfACubeIsKnown) {
  const std::vector<Vec3> cube = reference_element(ElementKind::hex8);
  Random random(19);
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 point = random.vector(-3, 3);
    Vec3 expected = point;
    for (double& c : expected) c = std::clamp(c, -1.0, 1.0);
    const NearestPoint found = nearest_point(ElementKind::hex8, cube, point);
    EXPECT_LT(norm(found.xi - expected), 1e-12);
    EXPECT_NEAR(found.distance, norm(point - expected), 1e-13);
  }
}

TEST(NearestPoint, OfSurfaces) {
  const std::vector<Vec3> quad{{0, 0, 1}, {2, 0, 1}, {2, 4, 1}, {0, 4, 1}};
  NearestPoint found = nearest_point(ElementKind::quad4, quad, {1.5, 1, 4});
  EXPECT_LT(norm(found.xi - Vec3{0.5, -0.5, 0}), 1e-14);
  EXPECT_NEAR(found.distance, 3, 1e-14);
  found = nearest_point(ElementKind::quad4, quad, {5, 8, 1});
  EXPECT_LT(norm(found.xi - Vec3{1, 1, 0}), 1e-14);
  EXPECT_NEAR(found.distance, 5, 1e-14);
  const std::vector<Vec3> triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  found = nearest_point(ElementKind::tri3, triangle, {1, 1, -2});
  EXPECT_LT(norm(found.xi - Vec3{0.5, 0.5, 0}), 1e-14);
  EXPECT_NEAR(found.distance, std::sqrt(4.5), 1e-14);
  EXPECT_FALSE(inverse_map(ElementKind::tri3, triangle, {0.1, 0.1, 0}).converged);
}

TEST(NearestPoint, OfDegenerateElementsIsFinite) {
  Random random(20);
  for (const ElementKind kind : all_kinds) {
    const std::vector<Vec3> point(reference_element(kind).size(), Vec3{1, 2, 3});
    EXPECT_NEAR(nearest_point(kind, point, {1, 2, 5}).distance, 2, 1e-15);
    std::vector<Vec3> line = reference_element(kind);
    for (Vec3& p : line) p = {p[0], 0, 0};
    double low = 0;
    for (const Vec3& p : line) low = std::min(low, p[0]);
    for (int trial = 0; trial < 50; ++trial) {
      const Vec3 target = random.vector(-3, 3);
      const Vec3 foot{std::clamp(target[0], low, 1.0), 0, 0};
      EXPECT_NEAR(nearest_point(kind, line, target).distance, norm(target - foot), 1e-12) << topology(kind).name;
    }
  }
}

TEST(NearestPoint, AtCornersAndEdgesOfEveryKind) {
  // Straight out from a corner or the middle of an edge of the reference element, along the mean of the outward
  // normals there, the nearest point is that corner or middle.
  for (const ElementKind kind : solid_kinds) {
    const std::vector<Vec3> x = reference_element(kind);
    const Topology& t = topology(kind);
    const auto outward = [&](const Vec3& place) {
      Vec3 sum{};
      for (std::size_t s = 0; s < static_cast<std::size_t>(t.sides); ++s) {
        const auto p = [&](std::size_t i) { return x[static_cast<std::size_t>(t.side[s][i])]; };
        const Vec3 n = cross(p(1) - p(0), p(2) - p(0));
        if (std::abs(dot(place - p(0), n)) < 1e-14) sum = sum + (1 / norm(n)) * n;
      }
      return sum;
    };
    for (std::size_t a = 0; a < x.size(); ++a) {
      const NearestPoint at_corner = nearest_point(kind, x, x[a] + 0.3 * outward(x[a]));
      EXPECT_LT(norm(at_corner.xi - x[a]), 1e-13) << t.name << a;
    }
    for (std::size_t s = 0; s < static_cast<std::size_t>(t.sides); ++s)
      for (std::size_t i = 0; i < static_cast<std::size_t>(t.side_nodes[s]); ++i) {
        const std::size_t k = (i + 1) % static_cast<std::size_t>(t.side_nodes[s]);
        const Vec3 middle =
            0.5 * (x[static_cast<std::size_t>(t.side[s][i])] + x[static_cast<std::size_t>(t.side[s][k])]);
        const NearestPoint at_edge = nearest_point(kind, x, middle + 0.3 * outward(middle));
        EXPECT_LT(norm(at_edge.xi - middle), 1e-13) << t.name;
      }
  }
}

}  // namespace
}  // namespace tenon::testing

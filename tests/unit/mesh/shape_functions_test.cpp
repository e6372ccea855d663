// SPDX-License-Identifier: BSD-3-Clause
// Shape functions against their defining properties, finite differences and exact integrals.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/mesh/sample_elements.hpp"

namespace tenon::testing {
namespace {

std::size_t nodes_of(ElementKind kind) {
  return static_cast<std::size_t>(topology(kind).nodes);
}

TEST(ShapeFunctions, AreOneAtTheirNodeAndZeroAtOthers) {
  for (const ElementKind kind : all_kinds) {
    const std::vector<Vec3> corner = reference_element(kind);
    for (std::size_t a = 0; a < corner.size(); ++a) {
      std::array<double, max_element_nodes> n;
      shape_values(kind, corner[a], n);
      for (std::size_t b = 0; b < corner.size(); ++b) EXPECT_EQ(n[b], a == b ? 1.0 : 0.0) << topology(kind).name;
    }
  }
}

TEST(ShapeFunctions, SumToOneAndReproduceLocalCoordinates) {
  Random random(2);
  for (const ElementKind kind : all_kinds) {
    const std::vector<Vec3> corner = reference_element(kind);
    for (int trial = 0; trial < 200; ++trial) {
      const Vec3 xi = local_point(kind, random);
      std::array<double, max_element_nodes> n;
      std::array<Vec3, max_element_nodes> g;
      shape_values(kind, xi, n);
      shape_gradients(kind, xi, g);
      double sum = 0;
      Vec3 slope{}, place{};
      for (std::size_t a = 0; a < corner.size(); ++a) {
        if (middle_nodes(kind).empty()) {
          EXPECT_GE(n[a], -1e-15) << topology(kind).name;  // inside, weights are those of a mean
        }
        sum += n[a], slope = slope + g[a], place = place + n[a] * corner[a];
      }
      const bool linear = middle_nodes(kind).empty();
      EXPECT_NEAR(sum, 1, linear ? 4e-16 : 2e-15);
      EXPECT_LT(norm(slope), 1e-14);
      EXPECT_LT(norm(place - xi), linear ? 1e-15 : 2e-15);
    }
  }
}

TEST(ShapeFunctions, GradientsAgreeWithDifferences) {
  Random random(3);
  for (const ElementKind kind : all_kinds)
    for (int trial = 0; trial < 100; ++trial) {
      Vec3 xi = local_point(kind, random);
      xi[2] = std::min(xi[2], 0.9);  // the pyramid's third derivatives grow towards its apex
      std::array<Vec3, max_element_nodes> g;
      shape_gradients(kind, xi, g);
      constexpr double h = 1e-5;
      for (std::size_t c = 0; c < static_cast<std::size_t>(topology(kind).dimension); ++c) {
        Vec3 low = xi, high = xi;
        low[c] -= h, high[c] += h;
        std::array<double, max_element_nodes> before, after;
        shape_values(kind, low, before);
        shape_values(kind, high, after);
        for (std::size_t a = 0; a < nodes_of(kind); ++a)
          EXPECT_NEAR(g[a][c], (after[a] - before[a]) / (2 * h), 1e-6) << topology(kind).name;
      }
    }
}

TEST(ShapeFunctions, PyramidFitsTetAndHexOnItsSides) {
  Random random(4);
  for (int trial = 0; trial < 100; ++trial) {
    const double u = random.between(-1, 1), v = random.between(-1, 1);
    std::array<double, max_element_nodes> pyramid, quad;
    shape_values(ElementKind::pyramid5, {u, v, 0}, pyramid);
    shape_values(ElementKind::quad4, {u, v, 0}, quad);
    for (std::size_t a = 0; a < 4; ++a) EXPECT_NEAR(pyramid[a], quad[a], 1e-15);
    EXPECT_EQ(pyramid[4], 0);
    const double z = random(), x = u * (1 - z);  // on the side y = -(1 - z): linear in its three nodes
    shape_values(ElementKind::pyramid5, {x, -(1 - z), z}, pyramid);
    EXPECT_NEAR(pyramid[0], (1 - z - x) / 2, 1e-15);
    EXPECT_NEAR(pyramid[1], (1 - z + x) / 2, 1e-15);
    EXPECT_NEAR(pyramid[2], 0, 1e-15);
  }
}

TEST(Quadrature, IntegratesTheReferenceMassMatrixExactly) {
  // Row sums and the diagonal of int N_a N_b, from the closed forms (hex: product of 1-D 2/3, 1/3; simplices
  // a! b! d! / (a + b + d)!; pyramid by integrating the collapsed functions).
  const auto mass = [](ElementKind kind, std::size_t a, std::size_t b) {
    double sum = 0;
    for (const QuadraturePoint& q : quadrature(kind)) {
      std::array<double, max_element_nodes> n;
      shape_values(kind, q.xi, n);
      sum += q.weight * n[a] * n[b];
    }
    return sum;
  };
  EXPECT_NEAR(mass(ElementKind::hex8, 0, 0), 8. / 27, 1e-15);
  EXPECT_NEAR(mass(ElementKind::hex8, 0, 6), 1. / 27, 1e-15);
  EXPECT_NEAR(mass(ElementKind::tet4, 0, 0), 1. / 60, 1e-16);
  EXPECT_NEAR(mass(ElementKind::tet4, 0, 3), 1. / 120, 1e-16);
  EXPECT_NEAR(mass(ElementKind::tet4, 2, 2), 1. / 60, 1e-16);
  EXPECT_NEAR(mass(ElementKind::wedge6, 0, 0), 1. / 12 * 2. / 3, 1e-15);
  EXPECT_NEAR(mass(ElementKind::wedge6, 0, 4), 1. / 24 * 1. / 3, 1e-15);
  EXPECT_NEAR(mass(ElementKind::quad4, 0, 0), 4. / 9, 1e-15);
  EXPECT_NEAR(mass(ElementKind::tri3, 0, 0), 1. / 12, 1e-15);
  EXPECT_NEAR(mass(ElementKind::tri3, 0, 1), 1. / 24, 1e-15);
  // Pyramid: int over t in [0, 1] of t^2 times N N, base functions t n_a n_b, apex 1 - t.
  EXPECT_NEAR(mass(ElementKind::pyramid5, 0, 0), 4. / 9 / 5, 1e-15);
  EXPECT_NEAR(mass(ElementKind::pyramid5, 0, 2), 1. / 9 / 5, 1e-15);
  EXPECT_NEAR(mass(ElementKind::pyramid5, 0, 4), 1. / 4 - 1. / 5, 1e-15);
  EXPECT_NEAR(mass(ElementKind::pyramid5, 4, 4), 4 * (1. / 3 - 2. / 4 + 1. / 5), 1e-15);
}

TEST(Quadrature, PointsLieInsideAndWeightsAddUpToTheReferenceVolume) {
  const std::array<double, element_kinds> measure{8, 1. / 6, 1, 4. / 3, 4, 0.5, 8, 1. / 6};
  for (const ElementKind kind : all_kinds) {
    double sum = 0;
    for (const QuadraturePoint& q : quadrature(kind)) {
      EXPECT_EQ(overshoot(kind, q.xi), 0);
      sum += q.weight;
    }
    EXPECT_NEAR(sum, measure[static_cast<std::size_t>(kind)], 1e-14) << topology(kind).name;
  }
}

TEST(ElementMeasure, OfDistortedElementsIsTheIntegralOfTheDeterminant) {
  Random random(5);
  for (const ElementKind kind : solid_kinds)
    for (int trial = 0; trial < 100; ++trial) {
      const std::vector<Vec3> x = distorted_element(kind, 0.2, random);
      double sum = 0;
      for (const QuadraturePoint& q : quadrature(kind)) sum += q.weight * jacobian_determinant(kind, x, q.xi);
      EXPECT_NEAR(element_measure(kind, x), sum, 1e-13 * sum) << topology(kind).name;
    }
}

TEST(ElementMeasure, OfFlatSurfaces) {
  const std::vector<Vec3> trapezium{{0, 0, 1}, {4, 0, 1}, {3, 2, 1}, {1, 2, 1}};
  EXPECT_NEAR(element_measure(ElementKind::quad4, trapezium), 6, 1e-14);
  const std::vector<Vec3> triangle{{0, 0, 0}, {0, 3, 0}, {0, 0, 4}};
  EXPECT_EQ(element_measure(ElementKind::tri3, triangle), 6);
}

TEST(JacobianDeterminant, IsNegativeOfAnInvertedElement) {
  for (const ElementKind kind : solid_kinds) {
    std::vector<Vec3> x = reference_element(kind);
    EXPECT_NEAR(jacobian_determinant(kind, x, element_centre(kind)), 1, 1e-15);
    for (Vec3& p : x) p[0] = -p[0];
    EXPECT_NEAR(jacobian_determinant(kind, x, element_centre(kind)), -1, 1e-15);
  }
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// hex20 and tet10: exact for quadratics, integrals, curved edges, boxes, order of nodes.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/mesh/sample_elements.hpp"

namespace tenon::testing {
namespace {

constexpr std::array curved_kinds{ElementKind::hex20, ElementKind::tet10};

double quadratic(const Vec3& x) {
  return 0.3 + x[0] - 2 * x[1] + 0.5 * x[2] + 1.5 * x[0] * x[0] - x[1] * x[1] + 0.25 * x[2] * x[2] + x[0] * x[1] -
         3 * x[1] * x[2] + 2 * x[2] * x[0];
}

TEST(SecondOrder, QuadraticsAreExactInAffineElements) {
  Random random(31);
  for (const ElementKind kind : curved_kinds)
    for (int trial = 0; trial < 100; ++trial) {
      const std::vector<Vec3> x = distorted_element(kind, 0, random);  // sheared only
      const Vec3 xi = local_point(kind, random);
      std::array<double, max_element_nodes> n;
      shape_values(kind, xi, n);
      double value = 0;
      for (std::size_t a = 0; a < x.size(); ++a) value += n[a] * quadratic(x[a]);
      EXPECT_NEAR(value, quadratic(map_to_space(kind, x, xi)), 2e-13) << topology(kind).name;
    }
}

TEST(SecondOrder, MiddleNodesAreInTheMiddleOfTheirEdges) {
  for (const ElementKind kind : curved_kinds) {
    const std::vector<Vec3> x = reference_element(kind);
    const auto corners = static_cast<std::size_t>(corner_count(kind));
    EXPECT_EQ(corners, kind == ElementKind::hex20 ? 8u : 4u);
    ASSERT_EQ(middle_nodes(kind).size() + corners, x.size());
    for (std::size_t i = 0; i < middle_nodes(kind).size(); ++i) {
      const auto [a, b] = middle_nodes(kind)[i];
      EXPECT_EQ(x[corners + i], 0.5 * (x[static_cast<std::size_t>(a)] + x[static_cast<std::size_t>(b)]));
      EXPECT_EQ(middle_node(kind, b, a), static_cast<int>(corners + i));
    }
    EXPECT_EQ(middle_node(kind, 0, 0), -1);
    for (std::size_t a = 0; a < x.size(); ++a) EXPECT_EQ(local_nodes(kind)[a], x[a]);
  }
  EXPECT_EQ(middle_node(ElementKind::hex8, 0, 1), -1);
  EXPECT_EQ(corner_count(ElementKind::wedge6), 6);
}

TEST(SecondOrder, QuadratureIntegratesTheMassMatrixExactly) {
  const auto mass = [](ElementKind kind, std::size_t a, std::size_t b) {
    double sum = 0;
    for (const QuadraturePoint& q : quadrature(kind)) {
      std::array<double, max_element_nodes> n;
      shape_values(kind, q.xi, n);
      sum += q.weight * n[a] * n[b];
    }
    return sum;
  };
  // tet10 with volume V = 1/6: V/420 times 6 (corner), 1 (two corners), -4 or -6 (corner, middle of an edge of its own
  // or not), 32 (middle), 16 (middles of edges that meet), 8 (of opposite edges).
  const double unit = 1. / 6 / 420;
  EXPECT_NEAR(mass(ElementKind::tet10, 0, 0), 6 * unit, 1e-17);
  EXPECT_NEAR(mass(ElementKind::tet10, 3, 3), 6 * unit, 1e-17);
  EXPECT_NEAR(mass(ElementKind::tet10, 0, 2), 1 * unit, 1e-17);
  EXPECT_NEAR(mass(ElementKind::tet10, 0, 4), -4 * unit, 1e-17);
  EXPECT_NEAR(mass(ElementKind::tet10, 0, 5), -6 * unit, 1e-17);
  EXPECT_NEAR(mass(ElementKind::tet10, 7, 7), 32 * unit, 1e-17);
  EXPECT_NEAR(mass(ElementKind::tet10, 4, 5), 16 * unit, 1e-17);
  EXPECT_NEAR(mass(ElementKind::tet10, 4, 9), 8 * unit, 1e-17);
  // hex20: by products of integrals of 1, s, s^2, s^3, s^4 over [-1, 1].
  // Corner: 1/64 of the integral of (1+x)^2 (1+y)^2 (1+z)^2 (x+y+z-2)^2, with moments m0 = 8/3, m1 = 4/3, m2 = 16/15
  // of (1+s)^2: 3 m2 m0^2 + 6 m1^2 m0 - 12 m1 m0^2 + 4 m0^3, over 64.
  const double m0 = 8. / 3, m1 = 4. / 3, m2 = 16. / 15;
  const double corner = (3 * m2 * m0 * m0 + 6 * m1 * m1 * m0 - 12 * m1 * m0 * m0 + 4 * m0 * m0 * m0) / 64;
  EXPECT_NEAR(mass(ElementKind::hex20, 0, 0), corner, 1e-15);
  EXPECT_NEAR(mass(ElementKind::hex20, 6, 6), corner, 1e-15);
  // Middle: 1/16 times 16/15 times m0^2; two opposite ones have (2/3 * 2)^2 instead of m0^2.
  EXPECT_NEAR(mass(ElementKind::hex20, 8, 8), 16. / 15 * m0 * m0 / 16, 1e-15);
  EXPECT_NEAR(mass(ElementKind::hex20, 8, 14), 16. / 15 * 16. / 9 / 16, 1e-15);
}

TEST(SecondOrder, VolumeOfABulgingElementIsExact) {
  // A cube [-1, 1]^3 whose top has its corners at 1 and the middles of its edges at 1 + h: the top is
  // z = 1 + h (2 - x^2 - y^2) / ... as the serendipity functions have it; its volume grows by the integral of
  // h sum of the middles' quad8 functions over [-1, 1]^2 = h 4 (4/3), halved by the linear variation from z = -1.
  const double h = 0.2;
  std::vector<Vec3> x = reference_element(ElementKind::hex20);
  for (std::size_t a = 12; a < 16; ++a) x[a][2] += h;
  EXPECT_NEAR(element_measure(ElementKind::hex20, x), 8 + h * 16. / 3, 1e-13);
  // A tetrahedron whose edge from node 0 to 1 is a parabola with its middle lowered by h in z: each of the sides beside
  // it moves by 4 h L0 L1; only the side in the plane z = 0 has a normal in z: volume + h times the integral over the
  // triangle of 4 L0 L1 = 4 h / 24.
  std::vector<Vec3> t = reference_element(ElementKind::tet10);
  t[4][2] -= h;
  EXPECT_NEAR(element_measure(ElementKind::tet10, t), 1. / 6 + h / 6, 1e-15);
}

TEST(SecondOrder, BoxesHoldTheElementClosely) {
  Random random(33);
  for (const ElementKind kind : curved_kinds)
    for (int trial = 0; trial < 50; ++trial) {
      const std::vector<Vec3> x = distorted_element(kind, 0.3, random);
      const Box box = element_box(kind, x);
      Box nodes, sampled;
      for (const Vec3& p : x) nodes.add(p);
      for (int k = 0; k < 2000; ++k) {
        const Vec3 p = map_to_space(kind, x, local_point(kind, random));
        sampled.add(p);
        Box wider = box;
        wider.inflate(1e-14);
        ASSERT_TRUE(wider.contains(p)) << topology(kind).name;
      }
      EXPECT_LT(box.diagonal(), 1.6 * nodes.diagonal());
    }
  // A parabola from 0 to 0 with 0.25 in the middle has its control point at 0.5.
  std::vector<Vec3> t = reference_element(ElementKind::tet10);
  t[4][2] -= 0.25;
  EXPECT_EQ(element_box(ElementKind::tet10, t).low[2], -0.5);
  EXPECT_EQ(element_box(ElementKind::hex8, reference_element(ElementKind::hex8)).high, (Vec3{1, 1, 1}));
}

/// A quarter of a ring between the radii 1 and 2 with all edges along it curved, of height 1.
std::vector<Vec3> ring_element() {
  std::vector<Vec3> x = reference_element(ElementKind::hex20);
  for (Vec3& p : x) {
    const double radius = 1.5 + 0.5 * p[0], angle = std::acos(-1.0) / 4 * (1 + p[1]);
    p = {radius * std::cos(angle), radius * std::sin(angle), 0.5 * p[2]};
  }
  return x;
}

TEST(SecondOrder, InverseMapOfAQuarterOfARing) {
  Random random(34);
  const std::vector<Vec3> ring = ring_element();
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 xi = local_point(ElementKind::hex20, random);
    const InverseMap found = inverse_map(ElementKind::hex20, ring, map_to_space(ElementKind::hex20, ring, xi));
    ASSERT_TRUE(found.converged);
    EXPECT_LT(norm(found.xi - xi), 2e-14);
  }
  // The hole of the ring is within the box of the element, but not in the element.
  for (int trial = 0; trial < 500; ++trial) {
    const double radius = random.between(0.1, 0.97), angle = random.between(0.1, 1.4);
    const Vec3 point{radius * std::cos(angle), radius * std::sin(angle), random.between(-0.5, 0.5)};
    const InverseMap found = inverse_map(ElementKind::hex20, ring, point);
    EXPECT_TRUE(!found.converged || overshoot(ElementKind::hex20, found.xi) > 0);
  }
}

TEST(SecondOrder, NearestPointOfAQuarterOfARingIsOnItsArcs) {
  // Serendipity arcs are parabolas, which leave the circle of radius 1 by less than 0.02.
  Random random(35);
  const std::vector<Vec3> ring = ring_element();
  for (int trial = 0; trial < 200; ++trial) {
    const bool outer = trial % 2 == 0;
    const double radius = outer ? random.between(2.2, 5) : random.between(0.5, 0.9), angle = random.between(0.2, 1.3);
    const Vec3 point{radius * std::cos(angle), radius * std::sin(angle), random.between(-0.4, 0.4)};
    const NearestPoint found = nearest_point(ElementKind::hex20, ring, point);
    EXPECT_NEAR(found.distance, outer ? radius - 2 : 1 - radius, outer ? 0.05 : 0.025);
    EXPECT_NEAR(found.xi[0], outer ? 1 : -1, 1e-15);
    // The foot is one: along the two directions of the side the distance does not change.
    std::array<Vec3, 20> g;
    shape_gradients(ElementKind::hex20, found.xi, g);
    Vec3 along_y{}, along_z{};
    for (std::size_t a = 0; a < 20; ++a) along_y = along_y + g[a][1] * ring[a], along_z = along_z + g[a][2] * ring[a];
    const Vec3 away = point - map_to_space(ElementKind::hex20, ring, found.xi);
    EXPECT_NEAR(dot(away, along_y), 0, 1e-12 * radius);
    EXPECT_NEAR(dot(away, along_z), 0, 1e-12 * radius);
  }
}

TEST(SecondOrder, OrdersOfNodesOfTheFileFormatsAreThoseOfTheirManuals) {
  // Edges of the middle nodes as the manuals draw them. Exodus [SY94] figure of HEX20: 9 to 12 below, 13 to 16 upright,
  // 17 to 20 above. Gmsh's manual, "Node ordering", hexahedron20 and tetrahedron10.
  const std::vector<std::array<int, 2>> exodus_hex{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5},
                                                   {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}};
  const std::vector<std::array<int, 2>> gmsh_hex{{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3},
                                                 {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}};
  const std::vector<std::array<int, 2>> gmsh_tet{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {2, 3}, {1, 3}};
  const auto expect = [](ElementKind kind, std::span<const std::int8_t> order,
                         const std::vector<std::array<int, 2>>& edges) {
    const auto corners = static_cast<std::size_t>(corner_count(kind));
    ASSERT_EQ(order.size(), edges.size() + corners);
    for (std::size_t i = 0; i < corners; ++i) EXPECT_EQ(order[i], static_cast<int>(i));
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const auto ours = static_cast<std::size_t>(middle_node(kind, edges[k][0], edges[k][1]));
      EXPECT_EQ(order[ours], static_cast<int>(corners + k)) << topology(kind).name;
    }
  };
  expect(ElementKind::hex20, exodus_node_order(ElementKind::hex20), exodus_hex);
  expect(ElementKind::hex20, gmsh_node_order(ElementKind::hex20), gmsh_hex);
  expect(ElementKind::tet10, gmsh_node_order(ElementKind::tet10), gmsh_tet);
  EXPECT_TRUE(exodus_node_order(ElementKind::tet10).empty());
  EXPECT_TRUE(gmsh_node_order(ElementKind::hex8).empty());
}

}  // namespace
}  // namespace tenon::testing

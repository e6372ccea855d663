// SPDX-License-Identifier: BSD-3-Clause
// Side tables close with outward normals; names map to kinds and back.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/unit/mesh/sample_elements.hpp"

namespace tenon::testing {
namespace {

/// Area vector of a bilinear quadrilateral or a triangle, m^2: half the cross product of the diagonals, or of two
/// edges.
Vec3 area_vector(const std::vector<Vec3>& x, const Topology& t, std::size_t side) {
  const auto p = [&](std::size_t i) { return x[static_cast<std::size_t>(t.side[side][i])]; };
  if (t.side_nodes[side] == 4) return 0.5 * cross(p(2) - p(0), p(3) - p(1));
  return 0.5 * cross(p(1) - p(0), p(2) - p(0));
}

/// Integral of x . n / 3 over a bilinear side; exact by two-point Gauss for quadrilaterals (degree 3 in each variable).
double flux_of_position(const std::vector<Vec3>& x, const Topology& t, std::size_t side) {
  const ElementKind kind = t.side_nodes[side] == 4 ? ElementKind::quad4 : ElementKind::tri3;
  const auto nodes = static_cast<std::size_t>(t.side_nodes[side]);
  double sum = 0;
  for (const QuadraturePoint& q : quadrature(kind)) {
    std::array<double, max_side_nodes> n;
    std::array<Vec3, max_side_nodes> g;
    shape_values(kind, q.xi, n);
    shape_gradients(kind, q.xi, g);
    Vec3 place{}, du{}, dv{};
    for (std::size_t i = 0; i < nodes; ++i) {
      const Vec3& corner = x[static_cast<std::size_t>(t.side[side][i])];
      place = place + n[i] * corner, du = du + g[i][0] * corner, dv = dv + g[i][1] * corner;
    }
    sum += q.weight * dot(place, cross(du, dv)) / 3;
  }
  return sum;
}

TEST(Topology, TablesAreInOrderOfKinds) {
  for (const ElementKind kind : all_kinds) {
    EXPECT_EQ(topology(kind).kind, kind);
    EXPECT_EQ(reference_element(kind).size(), static_cast<std::size_t>(topology(kind).nodes));
    EXPECT_EQ(kind_of_gmsh(topology(kind).gmsh_type), kind);
    EXPECT_EQ(kind_of_vtk(topology(kind).vtk_type), kind);
  }
}

TEST(Topology, SidesOfSolidsCloseAndPointOut) {
  Random random(1);
  for (const ElementKind kind : linear_solid_kinds)
    for (int trial = 0; trial < 50; ++trial) {
      const std::vector<Vec3> x = distorted_element(kind, 0.15, random);
      const Topology& t = topology(kind);
      Vec3 sum{};
      double volume = 0;
      for (std::size_t s = 0; s < static_cast<std::size_t>(t.sides); ++s) {
        sum = sum + area_vector(x, t, s);
        volume += flux_of_position(x, t, s);
        const Vec3 centre = map_to_space(kind, x, element_centre(kind));
        EXPECT_GT(dot(area_vector(x, t, s), x[static_cast<std::size_t>(t.side[s][0])] - centre), 0) << t.name << s;
      }
      EXPECT_LT(norm(sum), 1e-13) << t.name;
      EXPECT_NEAR(volume, element_measure(kind, x), 1e-13 * volume) << t.name;
    }
}

TEST(Topology, EverySolidSideIsDistinctAndEveryEdgeIsSharedByTwo) {
  for (const ElementKind kind : solid_kinds) {
    const Topology& t = topology(kind);
    std::set<std::set<int>> sides;
    std::multiset<std::pair<int, int>> directed;
    for (std::size_t s = 0; s < static_cast<std::size_t>(t.sides); ++s) {
      const auto n = static_cast<std::size_t>(t.side_nodes[s]);
      sides.insert(std::set<int>(t.side[s].begin(), t.side[s].begin() + t.side_nodes[s]));
      for (std::size_t i = 0; i < n; ++i) directed.insert({t.side[s][i], t.side[s][(i + 1) % n]});
    }
    EXPECT_EQ(sides.size(), static_cast<std::size_t>(t.sides));
    for (const auto& [a, b] : directed) {
      EXPECT_EQ(directed.count({a, b}), 1u) << t.name;  // two sides pass an edge in opposite directions
      EXPECT_EQ(directed.count({b, a}), 1u) << t.name;
    }
  }
}

TEST(Topology, ExodusSideNumbersOfHexAreThoseOfTheManual) {
  // [SY94] side 1 of HEX is 1 2 6 5, side 5 is 1 4 3 2, side 6 is 5 6 7 8.
  const Topology& t = topology(ElementKind::hex8);
  EXPECT_EQ(t.side[0], (std::array<std::int8_t, 4>{0, 1, 5, 4}));
  EXPECT_EQ(t.side[4], (std::array<std::int8_t, 4>{0, 3, 2, 1}));
  EXPECT_EQ(t.side[5], (std::array<std::int8_t, 4>{4, 5, 6, 7}));
}

TEST(Topology, ExodusNamesNeedTheNumberOfNodes) {
  EXPECT_EQ(kind_of_exodus("HEX", 8), ElementKind::hex8);
  EXPECT_EQ(kind_of_exodus("Hex8", 8), ElementKind::hex8);
  EXPECT_EQ(kind_of_exodus("TETRA", 4), ElementKind::tet4);
  EXPECT_EQ(kind_of_exodus("SHELL", 4), ElementKind::quad4);
  EXPECT_EQ(kind_of_exodus("SHELL", 3), ElementKind::tri3);
  EXPECT_EQ(kind_of_exodus("wedge", 6), ElementKind::wedge6);
  EXPECT_EQ(kind_of_exodus("PYRAMID5", 5), ElementKind::pyramid5);
  EXPECT_EQ(kind_of_exodus("HEX", 20), ElementKind::hex20);
  EXPECT_EQ(kind_of_exodus("tetra10", 10), ElementKind::tet10);
  EXPECT_EQ(kind_of_exodus("HEX", 27), std::nullopt);
  EXPECT_EQ(kind_of_exodus("SPHERE", 1), ElementKind::particle);
  EXPECT_EQ(kind_of_exodus("SPHERE", 2), std::nullopt);
  EXPECT_EQ(kind_of_exodus("", 8), std::nullopt);
  EXPECT_EQ(kind_of_gmsh(15), ElementKind::particle);
  EXPECT_EQ(kind_of_vtk(1), ElementKind::particle);
}

TEST(Topology, EdgesOfSurfacesFollowTheirNodes) {
  for (const ElementKind kind : {ElementKind::quad4, ElementKind::tri3}) {
    const Topology& t = topology(kind);
    EXPECT_EQ(t.sides, t.nodes + 2);
    for (int i = 0; i < t.nodes; ++i) {
      const auto& edge = t.side[static_cast<std::size_t>(i + 2)];
      EXPECT_EQ(edge[0], i);
      EXPECT_EQ(edge[1], (i + 1) % t.nodes);
    }
  }
}

}  // namespace
}  // namespace tenon::testing

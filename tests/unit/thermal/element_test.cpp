// SPDX-License-Identifier: BSD-3-Clause
// Conductivity, eigenvalue bound, nodal volumes and areas of single elements.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstring>

#include "components/thermal/element_conduction.hpp"
#include "framework/mesh/shape_functions.hpp"

namespace tenon::thermal {
namespace {

constexpr ElementKind solids[] = {ElementKind::hex8, ElementKind::tet4, ElementKind::wedge6, ElementKind::pyramid5};

/// Corners of a distorted element of each kind.
std::vector<Vec3> distorted(ElementKind kind) {
  const std::vector<Vec3> hex{{0, 0, 0},   {1.1, 0.1, 0}, {1, 0.9, 0.1}, {-0.1, 1, 0},
                              {0, 0.1, 1}, {1, 0, 1.2},   {1.1, 1.1, 1}, {0, 1, 0.9}};
  const auto pick = [&](std::initializer_list<std::size_t> which) {
    std::vector<Vec3> corners;
    for (const std::size_t i : which) corners.push_back(hex[i]);
    return corners;
  };
  switch (kind) {
    case ElementKind::tet4:
      return pick({0, 1, 3, 4});
    case ElementKind::wedge6:
      return pick({0, 1, 3, 4, 5, 7});
    case ElementKind::pyramid5:
      return pick({0, 1, 2, 3, 4});
    default:
      return hex;
  }
}

struct One {
  ElementTable table;
  CornerBatch corners{};
  ConductionBatch links;
  One(ElementKind kind, const std::vector<Vec3>& x, double k) : table(kind) {
    for (std::size_t a = 0; a < x.size(); ++a)
      for (std::size_t c = 0; c < 3; ++c)
        for (int l = 0; l < lanes; ++l) corners.x[a][c][l] = x[a][c];
    double conductivity[lanes];
    std::fill_n(conductivity, lanes, k);
    conduction(table, corners, conductivity, links);
  }
  Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(table.nodes, table.nodes);
    for (int i = 0, p = 0; i < table.nodes; ++i)
      for (int j = i + 1; j < table.nodes; ++j, ++p) {
        m(i, j) = m(j, i) = links.link[p][0];
        m(i, i) -= links.link[p][0];
        m(j, j) -= links.link[p][0];
      }
    return m;
  }
};

TEST(ElementConduction, LinearFieldsDissipateExactly) {  // T' K T = k |grad T|^2 V
  for (const ElementKind kind : solids) {
    const std::vector<Vec3> x = distorted(kind);
    const One one(kind, x, 3.0);
    const Vec3 g{0.3, -1.2, 2.0};
    Eigen::VectorXd t(one.table.nodes);
    for (int a = 0; a < one.table.nodes; ++a) t[a] = 300 + dot(g, x[static_cast<std::size_t>(a)]);
    const double expected = 3.0 * dot(g, g) * element_measure(kind, x);
    // The pyramid's gradients are rational, so its rule is not exact for distorted bases.
    EXPECT_NEAR(t.dot(one.matrix() * t), expected, (kind == ElementKind::pyramid5 ? 1e-3 : 1e-11) * expected)
        << topology(kind).name;
  }
}

TEST(ElementConduction, CubeHasTheTrilinearMatrix) {
  const One one(ElementKind::hex8,
                {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}}, 1);
  const Eigen::MatrixXd k = one.matrix();
  EXPECT_NEAR(k(0, 0), 2.0 / 3, 1e-14);  // h/3
  EXPECT_NEAR(k(0, 1), 0, 1e-14);
  EXPECT_NEAR(k(0, 2), -1.0 / 6, 1e-14);  // -h/12
  EXPECT_NEAR(k(0, 6), -1.0 / 6, 1e-14);
}

TEST(ElementConduction, EigenvalueBoundIsAboveAndClose) {
  for (const ElementKind kind : solids) {
    const std::vector<Vec3> x = distorted(kind);
    const One one(kind, x, 7.0);
    std::array<double, max_linear_nodes> volumes{};
    nodal_volumes(kind, x, std::span(volumes).first(x.size()));
    double capacity[max_linear_nodes][lanes] = {}, bound[lanes];
    Eigen::MatrixXd s = one.matrix();
    for (int i = 0; i < one.table.nodes; ++i)
      for (int j = 0; j < one.table.nodes; ++j)
        s(i, j) /= std::sqrt(volumes[static_cast<std::size_t>(i)] * volumes[static_cast<std::size_t>(j)]);
    for (std::size_t a = 0; a < x.size(); ++a) std::fill_n(capacity[a], lanes, volumes[a]);
    eigenvalue_bound(one.table, one.links, capacity, bound);
    const double exact = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(s).eigenvalues().maxCoeff();
    EXPECT_GE(bound[3], exact) << topology(kind).name;
    EXPECT_LE(bound[3], 1.02 * exact) << topology(kind).name;
  }
}

TEST(ElementConduction, LanesDoNotMeet) {
  const std::vector<Vec3> x = distorted(ElementKind::hex8);
  One mixed(ElementKind::hex8, x, 2.0);
  const One alone = mixed;
  for (int l = 0; l < lanes; ++l)
    if (l != 5) std::swap(mixed.corners.x[0][0][l], mixed.corners.x[6][1][l]);
  double conductivity[lanes] = {1, 1e9, 0, 4, 5, 2, 6, 7};
  conduction(mixed.table, mixed.corners, conductivity, mixed.links);
  for (int p = 0; p < 28; ++p) EXPECT_EQ(std::memcmp(&mixed.links.link[p][5], &alone.links.link[p][0], 8), 0);
}

TEST(ElementConduction, SeesInversion) {
  std::vector<Vec3> x = distorted(ElementKind::hex8);
  EXPECT_GT(One(ElementKind::hex8, x, 1).links.least_jacobian[0], 0);
  std::swap(x[0], x[6]);
  EXPECT_LT(One(ElementKind::hex8, x, 1).links.least_jacobian[0], 0);
  x[0][0] = std::nan("");
  EXPECT_FALSE(One(ElementKind::hex8, x, 1).links.least_jacobian[0] > 0);
}

TEST(NodalVolumes, AddUpToTheElement) {
  for (const ElementKind kind : solids) {
    const std::vector<Vec3> x = distorted(kind);
    std::vector<double> volumes(x.size());
    nodal_volumes(kind, x, volumes);
    double sum = 0;
    for (const double v : volumes) {
      EXPECT_GT(v, 0);
      sum += v;
    }
    EXPECT_NEAR(sum, element_measure(kind, x), 1e-13) << topology(kind).name;
  }
}

TEST(NodalAreas, AddUpToTheSide) {
  std::vector<double> areas(4);
  nodal_areas(std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}}, areas);
  for (const double a : areas) EXPECT_NEAR(a, 1.5, 1e-14);
  areas.resize(3);
  nodal_areas(std::vector<Vec3>{{0, 0, 1}, {2, 0, 1}, {0, 3, 1}}, areas);
  for (const double a : areas) EXPECT_NEAR(a, 1, 1e-14);
}

TEST(SideLinks, AreTheConsistentMassOfASide) {
  const SideLinks quad = side_links(std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}});
  EXPECT_NEAR(quad[0][1], 6.0 / 18, 1e-14);  // area/18 along an edge, area/36 across
  EXPECT_NEAR(quad[0][2], 6.0 / 36, 1e-14);
  const SideLinks triangle = side_links(std::vector<Vec3>{{0, 0, 1}, {2, 0, 1}, {0, 3, 1}});
  EXPECT_NEAR(triangle[1][2], 3.0 / 12, 1e-14);
}

TEST(CentreGradient, IsExactForLinearFields) {
  for (const ElementKind kind : solids) {
    const std::vector<Vec3> x = distorted(kind);
    const Vec3 g{-2, 0.5, 7};
    std::vector<double> t;
    for (const Vec3& p : x) t.push_back(dot(g, p) - 4);
    const Vec3 found = centre_gradient(ElementTable(kind), x, t);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], g[c], 1e-12);
  }
}

}  // namespace
}  // namespace tenon::thermal

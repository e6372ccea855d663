// SPDX-License-Identifier: BSD-3-Clause
// Amounts and densities on surfaces: conserved and projected between plates and between shells that do not match.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "projection_testing.hpp"
#include "transfer/element_points.hpp"

namespace tenon::transfer {
namespace {

using testing::distributed;
using testing::Pair;
using testing::ProjectionPair;

constexpr std::array<Location, 2> both{Location::node, Location::element};

MeshData plate(int n, bool triangles, double length = 1) {
  PlateShape shape;
  shape.length_x = length;
  shape.elements_x = n, shape.elements_y = n + 1;
  shape.triangles = triangles;
  return generate(shape);
}

/// A quarter of a cylinder of radius 1: two discretisations of it leave gaps.
MeshData shell(int n, bool triangles) {
  MeshData mesh = plate(n, triangles);
  for (Vec3& x : mesh.coordinates) {
    const double angle = 0.5 * std::numbers::pi * x[0];
    x = {std::cos(angle), x[1], std::sin(angle)};
  }
  return mesh;
}

std::vector<Pair> pairs() {
  const auto other = PartitionMethod::graph;
  return {{distributed(plate(5, false)), distributed(plate(7, true), other)},
          {distributed(plate(9, true)), distributed(plate(4, false), other)},
          {distributed(shell(6, false)), distributed(shell(9, true), other)},
          {distributed(shell(12, true)), distributed(shell(5, false), other)}};
}

double linear(const Vec3& x) {
  return 1 + 2 * x[0] - 3 * x[1];
}
double waves(const Vec3& x) {
  return 1 + std::sin(9 * x[0]) * std::cos(x[1]);
}

TEST(SurfaceConservation, TotalsKeepTheirSumAndTheirSign) {
  for (Pair pair : pairs())
    for (const Location from : both)
      for (const Location to : both) {
        pair.from = from, pair.to = to;
        const auto values = testing::sampled(*pair.source, from, waves);
        const auto result = testing::transferred(pair, FieldKind::total, values);
        const double sum = testing::global_sum(*pair.source, from, values);
        EXPECT_NEAR(testing::global_sum(*pair.target, to, result) / sum, 1.0, 1e-13);
        EXPECT_GE(testing::global_least(*pair.target, result), 0.0);
      }
}

TEST(SurfaceConservation, DensitiesKeepTheirIntegralOverTheArea) {
  for (Pair pair : pairs())
    for (const Location from : both)
      for (const Location to : both) {
        pair.from = from, pair.to = to;
        const auto values = testing::sampled(*pair.source, from, waves);
        const auto result = testing::transferred(pair, FieldKind::density, values);
        EXPECT_NEAR(testing::integral(*pair.target, to, result) / testing::integral(*pair.source, from, values), 1.0,
                    1e-13);
      }
}

TEST(SurfaceConservation, UniformDensitiesStayUniform) {
  for (Pair pair : pairs()) {
    const auto ones = testing::sampled(*pair.source, Location::node, [](const Vec3&) { return 1.0; });
    const auto result = testing::transferred(pair, FieldKind::density, ones);
    EXPECT_LT(testing::greatest_error(*pair.target, Location::node, result, [](const Vec3&) { return 1.0; }), 0.02);
  }
}

TEST(SurfaceProjection, IsExactForLinearFieldsOnPlates) {
  for (const bool triangles : {false, true}) {
    const Pair pair{distributed(plate(6, triangles)), distributed(plate(8, !triangles), PartitionMethod::graph)};
    const auto result = ProjectionPair(pair)(testing::sampled(*pair.source, Location::node, linear));
    EXPECT_LT(testing::greatest_error(*pair.target, Location::node, result, linear), 1e-12);
  }
}

TEST(SurfaceProjection, KeepsTheIntegral) {
  for (Pair pair : pairs())
    for (const Location from : both)
      for (const Location to : both) {
        pair.from = from, pair.to = to;
        const auto values = testing::sampled(*pair.source, from, waves);
        const ProjectionPair project(pair);
        const auto result = project(values);
        EXPECT_NEAR(testing::integral(*pair.target, to, result) / testing::integral(*pair.source, from, values), 1.0,
                    1e-13);
        EXPECT_EQ(project.projection().points_outside(), 0);
      }
}

TEST(SurfaceProjection, IsSecondOrderOnPlatesAndShells) {
  const auto smooth = [](const Vec3& x) { return std::sin(3 * x[0]) * std::exp(x[1]) + x[2]; };
  const auto error = [&](const Pair& pair) {
    const auto result = ProjectionPair(pair)(testing::sampled(*pair.source, Location::node, smooth));
    return testing::relative_l2_error(*pair.target, Location::node, result, smooth);
  };
  const auto flat = [&](int n) { return error({distributed(plate(n, false)), distributed(plate(n + n / 4, true))}); };
  const auto curved = [&](int n) { return error({distributed(shell(n, true)), distributed(shell(n + n / 4, false))}); };
  EXPECT_NEAR(std::log2(flat(8) / flat(16)), 2.0, 0.2);
  EXPECT_NEAR(std::log2(curved(8) / curved(16)), 2.0, 0.2);
}

}  // namespace
}  // namespace tenon::transfer

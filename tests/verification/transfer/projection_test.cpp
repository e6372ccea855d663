// SPDX-License-Identifier: BSD-3-Clause
// VERIFICATION E01 and E03 for L2 projections: exact linear fields, integrals kept to round-off, values within bounds.
#include <gtest/gtest.h>

#include <cmath>

#include "projection_testing.hpp"
#include "transfer/element_points.hpp"

namespace tenon::transfer {
namespace {

using testing::box;
using testing::distributed;
using testing::Pair;
using testing::ProjectionPair;

constexpr std::array<Location, 2> both{Location::node, Location::element};

double linear(const Vec3& x) {
  return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2];
}
double step(const Vec3& x) {
  return x[0] + 0.3 * x[1] < 0.6 ? 1.0 : 0.0;
}

/// Pairs that fill the same box, of all kinds of elements and of very different fineness.
std::vector<Pair> boxes() {
  const auto hex = box(5, {.distortion = 0.2});
  const auto tet = box(4, {.tetrahedra = true, .distortion = 0.2, .seed = 5});
  const auto fine = box(12, {.distortion = 0.15, .seed = 3});
  const auto coarse = box(2, {.distortion = 0.15, .seed = 4});
  const auto other = PartitionMethod::graph;
  return {{distributed(hex), distributed(tet, other)},
          {distributed(tet), distributed(hex, other)},
          {distributed(fine), distributed(testing::mixed_box(4), other)},
          {distributed(testing::mixed_box(3)), distributed(hex, other)},
          {distributed(fine), distributed(coarse, other)},
          {distributed(coarse), distributed(fine, other)}};
}

/// Pairs of which either has places that the other has not.
std::vector<Pair> misfits() {
  MeshData turned = box(6, {.distortion = 0.2, .seed = 2});
  testing::rotate(turned, 30, {0.5, 0.5, 0.5});
  MeshData shifted = box(5, {.tetrahedra = true, .seed = 6});
  testing::shift(shifted, {0.3, 0.1, 0});
  const auto hex = box(5, {.distortion = 0.2});
  const auto other = PartitionMethod::graph;
  return {{distributed(hex), distributed(turned, other)},
          {distributed(hex), distributed(shifted, other)},
          {distributed(hex), distributed(box(4, {.low = {0.2, 0.2, 0.2}, .high = {0.7, 0.8, 0.9}}), other)},
          {distributed(generate(CylinderShape{.core = 2, .shell = 2, .axial = 4})),
           distributed(generate(CylinderShape{.core = 4, .shell = 2, .axial = 4, .tetrahedra = true}), other)}};
}

std::vector<double> random_values(const Mesh& mesh, Location location, int components) {
  const Items items = items_of(mesh, location);
  std::vector<double> values;
  for (const GlobalId id : items.ids)
    for (int c = 0; c < components; ++c)
      values.push_back(testing::random_number(7, static_cast<std::uint64_t>(id * components + c)) - 0.5);
  return values;
}

/// A linear function's mean over each element is its value at the centre of mass.
std::vector<double> means_of_linear(const Mesh& mesh) {
  std::vector<double> means;
  for_each_element(mesh, [&](LocalIndex, const ElementBlock& block, LocalIndex e) {
    const Corners corners = corners_of(block, e, mesh.coordinates);
    double volume = 0, sum = 0;
    for (const TabulatedPoint& q : quadrature_points(block.kind)) {
      const double w = q.weight * measure(q, block.kind, corners);
      volume += w;
      sum += w * linear(position(q, static_cast<int>(block.nodes(e).size()), corners));
    }
    means.push_back(sum / volume);
  });
  return means;
}

void expect_linear(Pair pair, const ProjectionOptions& options) {
  const auto values = testing::sampled(*pair.source, Location::node, linear);
  EXPECT_LT(testing::greatest_error(*pair.target, Location::node, ProjectionPair(pair, options)(values), linear),
            1e-12);
  pair.to = Location::element;
  const auto result = ProjectionPair(pair, options)(values), exact = means_of_linear(*pair.target);
  for (std::size_t i = 0; i < result.size(); ++i) EXPECT_NEAR(result[i], exact[i], 1e-12);
}

void expect_kept(const Pair& pair, const ProjectionOptions& options) {
  constexpr int components = 3;
  const auto values = random_values(*pair.source, pair.from, components);
  const ProjectionPair project(pair, options);
  const auto result = project(values, components);
  for (int c = 0; c < components; ++c) {
    const double before = testing::integral(*pair.source, pair.from, values, components, c),
                 after = testing::integral(*pair.target, pair.to, result, components, c);
    EXPECT_LT(std::abs(after - before),
              1e-13 * testing::integral_of_magnitude(*pair.source, pair.from, values, components, c));
  }
}

TEST(Projection, LinearFieldsAreExact) {
  for (const Pair& pair : boxes()) expect_linear(pair, {});
}

TEST(Projection, LinearFieldsAreExactWherePlacesAreMissing) {
  for (const Pair& pair : misfits()) expect_linear(pair, {.keep_integral = false});
}

TEST(Projection, FromElementsOfSecondOrder) {
  for (const bool tets : {false, true}) {
    const Pair pair{distributed(testing::with_middle_nodes(box(3, {.tetrahedra = tets, .distortion = 0.2}))),
                    distributed(box(5, {.tetrahedra = !tets, .distortion = 0.2, .seed = 4}), PartitionMethod::graph)};
    expect_linear(pair, {});
    expect_kept(pair, {});
    // A quadratic field is known to the source exactly, so that its linear projection is as good as any.
    const auto quadratic = [](const Vec3& x) { return x[0] * x[0] - x[1] * x[2] + 2 * x[2] * x[2]; };
    const auto values = testing::sampled(*pair.source, Location::node, quadratic);
    const double projected =
                     testing::relative_l2_error(*pair.target, Location::node, ProjectionPair(pair)(values), quadratic),
                 interpolated =
                     testing::relative_l2_error(*pair.target, Location::node,
                                                testing::sampled(*pair.target, Location::node, quadratic), quadratic);
    EXPECT_LT(projected, 0.7 * interpolated);
  }
}

TEST(Projection, ConstantsStayConstant) {
  for (const bool bounded : {false, true})
    for (const Location from : both)
      for (const Location to : both) {
        Pair pair = boxes()[2];
        pair.from = from, pair.to = to;
        const auto constant = [](const Vec3&) { return 3.7; };
        const ProjectionPair project(pair, {.bounded = bounded});
        const auto result = project(testing::sampled(*pair.source, from, constant));
        EXPECT_LT(testing::greatest_error(*pair.target, to, result, constant), 1e-12);
        EXPECT_EQ(project.projection().outcome().clipped, 0);
      }
}

TEST(Projection, KeepsTheIntegral) {
  for (const auto& pairs : {boxes(), misfits()})
    for (Pair pair : pairs)
      for (const Location from : both)
        for (const Location to : both) {
          pair.from = from, pair.to = to;
          expect_kept(pair, {});
        }
}

TEST(Projection, BoundedKeepsTheIntegralToo) {
  for (const Pair& pair : boxes()) expect_kept(pair, {.bounded = true});
}

TEST(Projection, StepsOvershootUnlessBounded) {
  for (const Pair& pair : boxes()) {
    const auto values = testing::sampled(*pair.source, Location::node, step);
    const ProjectionPair free(pair), bounded(pair, {.bounded = true});
    const auto wild = free(values), tame = bounded(values);
    EXPECT_LT(testing::global_least(*pair.target, wild), -0.01);
    for (const double v : tame) {
      EXPECT_GE(v, 0.0);
      EXPECT_LE(v, 1.0);
    }
    const ProjectionOutcome& outcome = bounded.projection().outcome();
    EXPECT_GT(outcome.clipped, 0);
    EXPECT_EQ(outcome.unplaced, 0.0);
    EXPECT_LT(outcome.spread, 1e-2);
    const double before = testing::integral(*pair.source, Location::node, values);
    EXPECT_NEAR(testing::integral(*pair.target, Location::node, tame) / before, 1.0, 1e-13);
    // The values stay as good.
    EXPECT_LT(testing::relative_l2_error(*pair.target, Location::node, tame, step),
              1.3 * testing::relative_l2_error(*pair.target, Location::node, wild, step));
  }
}

TEST(Projection, TellsWhatHasNoRoom) {
  // A target of an eighth of the volume cannot hold the whole of a constant within its bounds.
  const Pair pair{distributed(box(4)), distributed(box(3, {.high = {0.5, 0.5, 0.5}}), PartitionMethod::graph)};
  const auto ones = testing::sampled(*pair.source, Location::node, [](const Vec3&) { return 1.0; });
  const ProjectionPair bounded(pair, {.bounded = true}), free(pair);
  for (const double v : bounded(ones)) EXPECT_NEAR(v, 1.0, 1e-12);
  EXPECT_NEAR(bounded.projection().outcome().unplaced, 7.0, 1e-12);
  for (const double v : free(ones)) EXPECT_NEAR(v, 8.0, 1e-11);
  EXPECT_NEAR(free.projection().outcome().spread, 7.0, 1e-11);
  EXPECT_GT(free.projection().points_outside(), free.projection().points() / 2);
}

TEST(Projection, SourceBesideTheTarget) {
  // Nothing of the source lies in the target: values are those of its nearest nodes.
  MeshData away = box(2);
  testing::shift(away, {2, 0, 0});
  const Pair pair{distributed(box(3)), distributed(std::move(away))};
  const auto ones = testing::sampled(*pair.source, Location::node, [](const Vec3&) { return 2.0; });
  const ProjectionPair project(pair);
  for (const double v : project(ones)) EXPECT_NEAR(v, 2.0, 1e-12);
  EXPECT_EQ(project.projection().points_outside(), project.projection().points());
}

TEST(Projection, ZeroStaysZero) {
  const Pair pair = boxes().front();
  const std::vector<double> zero(testing::places(*pair.source, Location::node).size());
  for (const double v : ProjectionPair(pair)(zero)) EXPECT_EQ(v, 0.0);
}

}  // namespace
}  // namespace tenon::transfer

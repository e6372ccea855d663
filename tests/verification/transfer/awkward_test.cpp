// SPDX-License-Identifier: BSD-3-Clause
// VERIFICATION E06: every point is found in a mesh of warped elements, and points outside err by no more than gradient
// times distance.
#include <gtest/gtest.h>

#include <cmath>

#include "transfer/locate.hpp"
#include "transfer_testing.hpp"

namespace tenon::transfer {
namespace {

using testing::box;
using testing::communicator;
using testing::distributed;

std::vector<Vec3> my_random_points(std::uint64_t count) {
  std::vector<Vec3> points;
  const auto size = static_cast<std::uint64_t>(communicator().size());
  for (auto i = static_cast<std::uint64_t>(communicator().rank()); i < count; i += size)
    points.push_back(
        {testing::random_number(9, 3 * i), testing::random_number(9, 3 * i + 1), testing::random_number(9, 3 * i + 2)});
  return points;
}

TEST(Awkward, RandomPointsInWarpedElementsAreAllFound) {
  const auto mesh = distributed(box(12, {.distortion = 0.2}));
  const std::vector<Vec3> points = my_random_points(60000);
  const Containers containers = containers_of(*mesh, mesh->coordinates, {}, 1e-9, "test");
  const std::vector<Placement> placed = Locator(communicator(), {}, false, "test").find(containers, points);
  std::int64_t outside = 0;
  for (const Placement& p : placed) outside += p.is_outside();
  EXPECT_EQ(communicator().sum(outside), 0);
}

TEST(Awkward, FoundWeightsReproduceThePoint) {
  // The coordinates themselves, transferred, are the points: the residual of the inverse map.
  MeshData target = box(9, {.distortion = 0.2, .seed = 8});
  testing::rotate(target, 11, {0.5, 0.5, 0.5});
  const testing::Pair pair{distributed(box(8, {.distortion = 0.2})), distributed(std::move(target))};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto coordinate = [c](const Vec3& x) { return x[c]; };
    const auto values = testing::sampled(*pair.source, Location::node, coordinate);
    const auto result =
        testing::transferred(pair, FieldKind::point_value, values, {.outside = OutsidePolicy::extrapolate});
    EXPECT_LT(testing::greatest_error(*pair.target, Location::node, result, coordinate), 1e-14);
  }
}

TEST(Awkward, NearestErrsByNoMoreThanGradientTimesDistance) {
  const testing::Pair pair{distributed(box(6)),
                           distributed(box(7, {.low = {-0.05, -0.05, -0.05}, .high = {1.05, 1.05, 1.05}}))};
  const auto f = [](const Vec3& x) { return 2 * x[0] + 3 * x[1] - 6 * x[2]; };  // |grad f| = 7
  const auto values = testing::sampled(*pair.source, Location::node, f);
  const GridTransfer map = testing::make_transfer(pair, FieldKind::point_value);
  std::vector<double> result(pair.target->node_ids.size());
  map.apply(values, result, 1);
  const TransferReport report = map.report(values, result, 1);
  EXPECT_EQ(report.outside, 512 - 216);
  EXPECT_NEAR(report.greatest_distance, 0.05 * std::sqrt(3.0), 1e-14);
  EXPECT_LE(testing::greatest_error(*pair.target, Location::node, result, f), 7 * report.greatest_distance);
}

TEST(Awkward, ThinElementsOfAspectTenThousand) {
  MeshData source = box(4, {.distortion = 0.2}), target = box(5, {.tetrahedra = true});
  for (MeshData* mesh : {&source, &target})
    for (Vec3& x : mesh->coordinates) x[2] *= 1e-4;
  const testing::Pair pair{distributed(std::move(source)), distributed(std::move(target))};
  const auto f = [](const Vec3& x) { return x[0] + 1e4 * x[2]; };
  const auto values = testing::sampled(*pair.source, Location::node, f);
  EXPECT_LT(testing::greatest_error(*pair.target, Location::node,
                                    testing::transferred(pair, FieldKind::point_value, values), f),
            1e-12);
}

TEST(Awkward, CylindersOfDifferentFacetsMeetEverywhere) {
  // Nodes on the fine skin lie outside the coarse facets by up to the sagitta R (1 - cos(pi/n)).
  const testing::Pair pair{distributed(generate(CylinderShape{.core = 4, .shell = 3, .axial = 8})),
                           distributed(generate(CylinderShape{.core = 6, .shell = 4, .axial = 9, .tetrahedra = true}),
                                       PartitionMethod::graph)};
  const auto f = [](const Vec3& x) { return x[0] - 2 * x[1] + x[2]; };
  const auto values = testing::sampled(*pair.source, Location::node, f);
  const GridTransfer map =
      testing::make_transfer(pair, FieldKind::point_value, {.outside = OutsidePolicy::extrapolate});
  std::vector<double> result(pair.target->node_ids.size());
  map.apply(values, result, 1);
  const TransferReport report = map.report(values, result, 1);
  EXPECT_GT(report.outside, 0);
  EXPECT_LT(report.greatest_distance, 1 - std::cos(std::acos(-1.0) / 16) + 1e-12);
  EXPECT_LT(testing::greatest_error(*pair.target, Location::node, result, f), 1e-13);
}

}  // namespace
}  // namespace tenon::transfer

// SPDX-License-Identifier: BSD-3-Clause
// Every method through GridTransfer: what it is exact for, and what it says about itself.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "transfer_testing.hpp"

namespace tenon::transfer {
namespace {

using testing::communicator;
using testing::distributed;

double linear(const Vec3& x) {
  return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2];
}

/// Random points in a box, dealt out; the last of several ranks gets none.
struct Cloud {
  PointCloud points{communicator(), {}, "a cloud"};
  std::vector<Vec3> x;
};
Cloud cloud(int count, double low = 0, double high = 1) {
  Cloud result;
  const int ranks = std::max(1, communicator().size() - 1);
  for (int i = 0; i < count; ++i) {
    if (i % ranks != communicator().rank()) continue;
    result.points.ids.push_back(i);
    const auto at = [&](int c) {
      return low + (high - low) * testing::random_number(17, static_cast<std::uint64_t>(3 * i + c));
    };
    result.x.push_back({at(0), at(1), at(2)});
  }
  return result;
}

Grid grid_of(const Cloud& c) {
  return {.coordinates = c.x, .location = Location::particle, .cloud = &c.points};
}
Grid grid_of(const Mesh& mesh, Location location = Location::node) {
  return {.mesh = &mesh, .coordinates = mesh.coordinates, .location = location};
}

std::vector<double> sampled(std::span<const Vec3> x) {
  std::vector<double> values;
  for (const Vec3& p : x) values.push_back(linear(p));
  return values;
}

double greatest_error(std::span<const Vec3> x, std::span<const double> values) {
  double error = 0;
  for (std::size_t i = 0; i < x.size(); ++i) error = std::max(error, std::abs(values[i] - linear(x[i])));
  return communicator().max(error);
}

MeshData with_skin(MeshData mesh) {
  add_derived_sets(mesh);
  return mesh;
}

FieldDescription field(FieldKind kind) {
  FieldDescription f;
  f.kind = kind;
  return f;
}

TEST(Methods, LinearFieldsAreExactByEveryMethodOfValues) {
  const auto source = distributed(testing::box(6, {.distortion = 0.2}));
  const auto target = distributed(testing::box(7, {.distortion = 0.2, .seed = 5}));
  const std::vector<double> values = sampled(source->coordinates);
  for (const Method method : {Method::interpolate, Method::project, Method::moving_least_squares}) {
    TransferOptions options{.method = method, .outside = OutsidePolicy::extrapolate};
    const GridTransfer map(grid_of(*source), grid_of(*target), field(FieldKind::point_value), options, "test");
    EXPECT_EQ(map.method(), method);
    std::vector<double> result(target->coordinates.size());
    map.apply(values, result, 1);
    EXPECT_LT(greatest_error(target->coordinates, result), 1e-12) << static_cast<int>(method);
  }
}

TEST(Methods, PointsAsTargetsAndAsSources) {
  const auto mesh = distributed(testing::box(6, {.distortion = 0.2}));
  const Cloud points = cloud(500);
  std::vector<double> at_points(points.x.size()), at_nodes(mesh->coordinates.size());
  const GridTransfer to(grid_of(*mesh), grid_of(points), field(FieldKind::point_value), {}, "to points");
  EXPECT_EQ(to.method(), Method::interpolate);
  to.apply(sampled(mesh->coordinates), at_points, 1);
  EXPECT_LT(greatest_error(points.x, at_points), 1e-13);
  const GridTransfer from(grid_of(points), grid_of(*mesh), field(FieldKind::point_value),
                          {.outside = OutsidePolicy::extrapolate}, "from points");
  EXPECT_EQ(from.method(), Method::moving_least_squares);
  from.apply(at_points, at_nodes, 1);
  EXPECT_LT(greatest_error(mesh->coordinates, at_nodes), 1e-11);
}

TEST(Methods, TotalsGoToPointsAndBackWithoutLoss) {
  const auto mesh = distributed(testing::box(5, {.distortion = 0.2}));
  const Cloud points = cloud(300);
  for (const Location location : {Location::node, Location::element}) {
    const std::vector<double> amounts = testing::sampled(
        *mesh, location, [](const Vec3& x) { return 1 + std::sin(9 * x[0]) * std::cos(7 * x[1]) + x[2]; });
    const GridTransfer to(grid_of(*mesh, location), grid_of(points), field(FieldKind::total), {}, "to points");
    std::vector<double> arrived(points.x.size());
    to.apply(amounts, arrived, 1);
    const double sent = testing::global_sum(*mesh, location, amounts);
    ExactSum sum;
    for (const double a : arrived) sum.add(a);
    EXPECT_NEAR(communicator().sum(sum), sent, 1e-13 * sent);
    const TransferReport report = to.report(amounts, arrived, 1);
    EXPECT_LT(report.mismatch, 1e-13);
    EXPECT_NEAR(report.source_integral, sent, 1e-13 * sent);
  }
}

TEST(Methods, NearestProjectionOntoSurfaces) {
  // A plate above the source plate: each node's value is that of the foot of its perpendicular.
  const auto source = distributed(generate(PlateShape{.elements_x = 6, .elements_y = 5}));
  MeshData above = generate(PlateShape{.elements_x = 7, .elements_y = 7});
  testing::shift(above, {0, 0, 0.01});
  const auto target = distributed(std::move(above));
  const GridTransfer map(grid_of(*source), grid_of(*target), field(FieldKind::point_value), {}, "test");
  EXPECT_EQ(map.method(), Method::nearest_projection);
  std::vector<double> result(target->coordinates.size());
  const std::vector<double> values = sampled(source->coordinates);
  map.apply(values, result, 1);
  std::vector<Vec3> feet = target->coordinates;
  for (Vec3& x : feet) x[2] -= 0.01;
  EXPECT_LT(greatest_error(feet, result), 1e-13);
  const TransferReport report = map.report(values, result, 1);
  EXPECT_EQ(report.outside, 0);
  EXPECT_NEAR(report.greatest_distance, 0.01, 1e-15);
  std::vector<PointStatus> status(result.size());
  std::vector<double> distance(result.size());
  map.status(status, distance);
  for (const double d : distance) EXPECT_NEAR(d, 0.01, 1e-15);
  EXPECT_THROW(GridTransfer(grid_of(*source), grid_of(*target), field(FieldKind::point_value),
                            {.greatest_distance = 0.005}, "test"),
               Error);
}

TEST(Methods, NearestProjectionOntoTheSkinOfSolids) {
  const auto source = distributed(with_skin(testing::box(5)));
  MeshData larger = testing::box(4, {.low = {-0.01, -0.01, -0.01}, .high = {1.01, 1.01, 1.01}});
  const auto target = distributed(std::move(larger));
  const GridTransfer map(grid_of(*source), grid_of(*target), field(FieldKind::point_value),
                         {.method = Method::nearest_projection}, "test");
  std::vector<double> result(target->coordinates.size());
  map.apply(sampled(source->coordinates), result, 1);
  std::vector<Vec3> feet = target->coordinates;
  for (Vec3& x : feet) {
    bool on_skin = false;
    for (double& c : x) on_skin = on_skin || c <= 0 || c >= 1, c = std::clamp(c, 0.0, 1.0);
    if (!on_skin) x = {1e9, 1e9, 1e9};
  }
  for (std::size_t i = 0; i < feet.size(); ++i)
    if (feet[i][0] < 2) {
      EXPECT_NEAR(result[i], linear(feet[i]), 1e-13);
    }
}

TEST(Methods, MatchingMeshesAreCopiedBitForBit) {
  const auto a = distributed(testing::box(5, {.distortion = 0.2}), PartitionMethod::rcb);
  const auto b = distributed(testing::box(5, {.distortion = 0.2}), PartitionMethod::graph);
  for (const FieldKind kind : {FieldKind::point_value, FieldKind::total, FieldKind::density})
    for (const Location location : {Location::node, Location::element}) {
      const std::vector<double> values =
          testing::sampled(*a, location, [](const Vec3& x) { return -0.0 + std::sin(40 * x[0]) / 3 - x[1]; });
      const GridTransfer map(grid_of(*a, location), grid_of(*b, location), field(kind), {.method = Method::copy},
                             "test");
      std::vector<double> result(testing::places(*b, location).size());
      map.apply(values, result, 1);
      EXPECT_EQ(testing::fingerprint(*a, location, values), testing::fingerprint(*b, location, result));
    }
  const auto other = distributed(testing::box(6));
  EXPECT_THROW(
      GridTransfer(grid_of(*a), grid_of(*other), field(FieldKind::point_value), {.method = Method::copy}, "test"),
      Error);
}

TEST(Methods, SameNodesButOtherElementsKeepTheIntegral) {
  const auto hex = distributed(testing::box(2));
  const auto tet = distributed(testing::box(2, {.tetrahedra = true}));
  const std::vector<double> values =
      testing::sampled(*hex, Location::node, [](const Vec3& x) { return x[0] * x[1] * x[2] == 1 ? 1.0 : 0.0; });
  for (const Method method : {Method::conserve, Method::project}) {
    const GridTransfer map(grid_of(*hex), grid_of(*tet), field(FieldKind::density), {.method = method}, "test");
    std::vector<double> result(tet->coordinates.size());
    map.apply(values, result, 1);
    const TransferReport report = map.report(values, result, 1);
    EXPECT_NEAR(report.source_integral, 1.0 / 64, 1e-15);
    EXPECT_NEAR(report.target_integral, 1.0 / 64, 1e-15);
  }
}

TEST(Methods, MovingMapsRefuseWhatIsNoPlaceAndRecover) {
  const auto source = distributed(testing::box(4)), target = distributed(testing::box(5));
  std::vector<Vec3> y = target->coordinates;
  GridTransfer map(grid_of(*source), {.mesh = target.get(), .coordinates = y}, field(FieldKind::point_value),
                   {.outside = OutsidePolicy::error, .moving = true}, "test");
  const std::vector<double> values = sampled(source->coordinates);
  std::vector<double> result(y.size());
  if (!y.empty()) y[y.size() / 2][1] = std::nan("");
  EXPECT_THROW(map.update(source->coordinates, y), Error);
  y = target->coordinates;
  for (Vec3& x : y) x[0] += 0.3;
  EXPECT_THROW(map.update(source->coordinates, y), Error);  // outside
  EXPECT_THROW(map.apply(values, result, 1), Error);
  y = target->coordinates;
  for (Vec3& x : y) x = 0.9 * x;
  EXPECT_TRUE(map.update(source->coordinates, y));
  map.apply(values, result, 1);
  EXPECT_LT(greatest_error(y, result), 1e-13);
  EXPECT_THROW(map.apply(values, std::span(result).first(result.size() / 2), 1), Error);
}

TEST(Methods, StatusTellsWhatBecameOfPointsOutside) {
  const auto source = distributed(testing::box(4));
  const Cloud points = cloud(400, -0.5, 1.5);
  for (const OutsidePolicy policy : {OutsidePolicy::nearest, OutsidePolicy::extrapolate, OutsidePolicy::value})
    for (const Method method : {Method::interpolate, Method::moving_least_squares}) {
      const GridTransfer map(grid_of(*source), grid_of(points), field(FieldKind::point_value),
                             {.method = method, .outside = policy, .outside_value = -7}, "test");
      std::vector<double> result(points.x.size());
      map.apply(sampled(source->coordinates), result, 1);
      std::vector<PointStatus> status(result.size());
      std::vector<double> distance(result.size());
      map.status(status, distance);
      std::int64_t outside = 0;
      for (std::size_t i = 0; i < result.size(); ++i) {
        Vec3 foot = points.x[i];
        for (double& c : foot) c = std::clamp(c, 0.0, 1.0);
        const double away = norm(foot - points.x[i]);
        outside += status[i] != PointStatus::inside;
        if (method == Method::interpolate) {
          EXPECT_NEAR(distance[i], away, 1e-14);
          EXPECT_EQ(status[i] == PointStatus::inside, away < 1e-9);
        }
        if (status[i] == PointStatus::value) {
          EXPECT_EQ(result[i], -7);
        } else if (status[i] == PointStatus::extrapolated) {
          EXPECT_NEAR(result[i], linear(points.x[i]), 1e-11);
        }
      }
      const std::vector<double> values = sampled(source->coordinates);
      EXPECT_EQ(communicator().sum(outside), map.report(values, result, 1).outside);
      EXPECT_GT(communicator().sum(outside), 20);
    }
}

TEST(Methods, OnlyTheChosenBlocksGiveValues) {
  const auto source = distributed(testing::mixed_box(3));
  const std::string first = source->blocks.front().name;
  const Cloud points = cloud(200);
  Grid from = grid_of(*source);
  from.blocks = {first};
  const GridTransfer map(from, grid_of(points), field(FieldKind::point_value), {}, "test");
  const GridTransfer whole(grid_of(*source), grid_of(points), field(FieldKind::point_value), {}, "test");
  std::vector<double> result(points.x.size());
  const std::vector<double> values = sampled(source->coordinates);
  map.apply(values, result, 1);
  EXPECT_GT(map.report(values, result, 1).outside, 50);
  EXPECT_EQ(whole.report(values, result, 1).outside, 0);
}

TEST(Methods, MovingMapsAreThoseMadeAnewAndRigidMotionCostsNothing) {
  const auto source = distributed(with_skin(testing::box(6, {.distortion = 0.15})));
  const auto target = distributed(testing::box(7, {.distortion = 0.15, .seed = 3}));
  std::vector<Vec3> x = source->coordinates, y = target->coordinates;
  for (const Method method : {Method::interpolate, Method::nearest_projection, Method::project}) {
    const TransferOptions options{.method = method, .moving = true};
    GridTransfer map({.mesh = source.get(), .coordinates = x}, {.mesh = target.get(), .coordinates = y},
                     field(FieldKind::point_value), options, "test");
    EXPECT_FALSE(map.update(x, y));
    const std::vector<double> values = sampled(source->coordinates);
    std::vector<double> before(y.size()), after(y.size()), anew(y.size());
    map.apply(values, before, 1);
    // Both turn and travel.
    const double c = std::cos(0.3), s = std::sin(0.3);
    const auto turned = [&](const Vec3& p) { return Vec3{c * p[0] - s * p[1] + 5, s * p[0] + c * p[1] - 2, p[2] + 1}; };
    std::vector<Vec3> x1, y1;
    for (const Vec3& p : x) x1.push_back(turned(p));
    for (const Vec3& p : y) y1.push_back(turned(p));
    EXPECT_FALSE(map.update(x1, y1));
    EXPECT_EQ(map.rigid_motions(), 1);
    map.apply(values, after, 1);
    EXPECT_EQ(before, after);
    // Now the target slides.
    for (int step = 1; step <= 3; ++step) {
      for (Vec3& p : y1) p = p + Vec3{0.004, -0.003 * step, 0.002};
      EXPECT_TRUE(map.update(x1, y1));
      map.apply(values, after, 1);
      const GridTransfer fresh({.mesh = source.get(), .coordinates = x1}, {.mesh = target.get(), .coordinates = y1},
                               field(FieldKind::point_value), {.method = method}, "fresh");
      fresh.apply(values, anew, 1);
      EXPECT_EQ(testing::fingerprint(*target, Location::node, after),
                testing::fingerprint(*target, Location::node, anew));
    }
  }
}

}  // namespace
}  // namespace tenon::transfer

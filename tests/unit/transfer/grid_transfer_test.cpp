// SPDX-License-Identifier: BSD-3-Clause
// The interface of GridTransfer: what it refuses, its policies, its report and its bookkeeping.
#include "transfer/grid_transfer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "allocation_counter.hpp"
#include "transfer_testing.hpp"

namespace tenon::transfer {
namespace {

using testing::box;
using testing::distributed;
using testing::Function;
using testing::Pair;

double linear(const Vec3& x) {
  return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2];
}

Pair inner_pair() {
  return {distributed(box(3, {.distortion = 0.2})),
          distributed(box(4, {.tetrahedra = true, .low = {0.1, 0.1, 0.1}, .high = {0.9, 0.9, 0.9}}),
                      PartitionMethod::graph)};
}

/// Target nodes up to 0.25 outside of the unit cube.
Pair outer_pair() {
  return {distributed(box(3)), distributed(box(4, {.low = {0, 0, 0}, .high = {1.25, 1, 1}}), PartitionMethod::graph)};
}

void expect_refused(const std::function<void()>& work, ExitCode code, const std::string& text) {
  try {
    work();
    FAIL() << "not refused: " << text;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

TEST(GridTransfer, AutomaticMethodFollowsTheKind) {
  const Pair pair = inner_pair();
  EXPECT_EQ(testing::make_transfer(pair, FieldKind::point_value).method(), Method::interpolate);
  EXPECT_EQ(testing::make_transfer(pair, FieldKind::total).method(), Method::conserve);
  EXPECT_EQ(testing::make_transfer(pair, FieldKind::density).method(), Method::conserve);
  EXPECT_EQ(testing::make_transfer(pair, FieldKind::density, {.method = Method::interpolate}).method(),
            Method::interpolate);
}

TEST(GridTransfer, RefusesPairingsThatMakeNoSense) {
  const Pair pair = inner_pair();
  const auto refused = [&](FieldKind kind, const TransferOptions& options, const std::string& text) {
    expect_refused([&] { testing::make_transfer(pair, kind, options); }, ExitCode::usage, text);
  };
  refused(FieldKind::total, {.method = Method::interpolate}, "is a total");
  refused(FieldKind::point_value, {.method = Method::conserve}, "no amount to conserve");
  refused(FieldKind::flux, {}, "is a flux");
  refused(FieldKind::total, {.outside = OutsidePolicy::value}, "would lose");
  refused(FieldKind::point_value, {.tolerance = -1}, "tolerance");
  refused(FieldKind::point_value, {.greatest_distance = -1}, "greatest distance");
  Pair particles = pair;
  particles.to = Location::particle;
  expect_refused([&] { testing::make_transfer(particles, FieldKind::point_value); }, ExitCode::usage, "particle");
}

TEST(GridTransfer, RefusesCoordinatesThatAreNoPlaces) {
  const Pair pair = inner_pair();
  std::vector<Vec3> x = pair.source->coordinates;
  for (std::size_t n = 0; n < x.size(); ++n)
    if (pair.source->node_labels[n] == 12) x[n][1] = std::nan("");
  FieldDescription field;
  expect_refused(
      [&] {
        GridTransfer({pair.source.get(), x, Location::node},
                     {pair.target.get(), pair.target->coordinates, Location::node}, field, {}, "heat");
      },
      ExitCode::geometry, "transfer 'heat': node 12 of the source");
}

TEST(GridTransfer, PoliciesOutside) {
  const Pair pair = outer_pair();
  const std::vector<double> values = testing::sampled(*pair.source, Location::node, linear);
  const auto with = [&](const TransferOptions& options) {
    return testing::transferred(pair, FieldKind::point_value, values, options);
  };
  const auto at_nearest = [](const Vec3& x) { return linear({std::min(x[0], 1.0), x[1], x[2]}); };
  const auto with_value = [](const Vec3& x) { return x[0] > 1 ? 77.0 : linear(x); };
  const auto error = [&](const std::vector<double>& result, const Function& f) {
    return testing::greatest_error(*pair.target, Location::node, result, f);
  };
  EXPECT_LT(error(with({}), at_nearest), 1e-14);
  EXPECT_LT(error(with({.outside = OutsidePolicy::extrapolate}), linear), 1e-14);
  EXPECT_LT(error(with({.outside = OutsidePolicy::value, .outside_value = 77}), with_value), 1e-14);
  expect_refused([&] { with({.outside = OutsidePolicy::error}); }, ExitCode::geometry,
                 "25 of 125 points lie outside the mesh; the farthest is at (1.25, 0, 0), 0.25 m away");
  expect_refused([&] { with({.greatest_distance = 0.2}); }, ExitCode::geometry, "at most 0.2 m allowed");
  EXPECT_NO_THROW(with({.outside = OutsidePolicy::value, .greatest_distance = 0.2}));
}

TEST(GridTransfer, NearestOutsideKeepsAmountsAndSigns) {
  Pair pair = outer_pair();
  std::swap(pair.source, pair.target);
  pair.from = Location::element;
  const std::vector<double> heat =
      testing::sampled(*pair.source, Location::element, [](const Vec3& x) { return x[0]; });
  const std::vector<double> result = testing::transferred(pair, FieldKind::total, heat);
  const double sum = testing::global_sum(*pair.source, Location::element, heat);
  EXPECT_NEAR(testing::global_sum(*pair.target, Location::node, result) / sum, 1.0, 1e-14);
  EXPECT_GE(testing::global_least(*pair.target, result), 0.0);
}

TEST(GridTransfer, TargetAllOutsideAndFarAway) {
  MeshData away = box(2);
  testing::shift(away, {100, 0, 0});
  const Pair pair{distributed(box(3)), distributed(std::move(away))};
  const std::vector<double> values = testing::sampled(*pair.source, Location::node, linear);
  const GridTransfer map = testing::make_transfer(pair, FieldKind::point_value);
  std::vector<double> result(pair.target->node_ids.size());
  map.apply(values, result, 1);
  EXPECT_LT(testing::greatest_error(*pair.target, Location::node, result,
                                    [](const Vec3& x) {
                                      return linear({1, x[1], x[2]});
                                    }),
            1e-13);
  const TransferReport report = map.report(values, result, 1);
  EXPECT_EQ(report.targets, 27);
  EXPECT_EQ(report.outside, 27);
  EXPECT_EQ(report.greatest_distance, 100);
  EXPECT_EQ(report.farthest, (Vec3{101, 0, 0}));
}

TEST(GridTransfer, ReportOfAnExactTransfer) {
  const Pair pair{distributed(box(3, {.distortion = 0.2})), distributed(box(4, {.tetrahedra = true}))};
  const std::vector<double> values = testing::sampled(*pair.source, Location::node, linear);
  const GridTransfer map = testing::make_transfer(pair, FieldKind::point_value);
  std::vector<double> result(pair.target->node_ids.size());
  map.apply(values, result, 1);
  const TransferReport report = map.report(values, result, 1);
  EXPECT_EQ(report.targets, 125);
  EXPECT_EQ(report.outside, 0);
  EXPECT_EQ(report.greatest_distance, 0.0);
  EXPECT_EQ(report.skipped, 0);
  EXPECT_NEAR(report.source_integral, 0.75, 1e-14);
  EXPECT_NEAR(report.target_integral, 0.75, 1e-14);
  EXPECT_LT(report.mismatch, 1e-14);
  EXPECT_LT(report.error_estimate, 1e-14);
}

TEST(GridTransfer, SeveralFieldsTravelInOneMessage) {
  const Pair pair = inner_pair();
  const GridTransfer map = testing::make_transfer(pair, FieldKind::point_value);
  const std::array<Function, 3> f{linear, [](const Vec3& x) { return x[0] * x[1]; },
                                  [](const Vec3& x) { return std::exp(x[2]); }};
  const std::vector<double> scalar = testing::sampled(*pair.source, Location::node, f[1]);
  const std::vector<double> vector = testing::sampled(*pair.source, Location::node, f);
  const std::size_t n = pair.target->node_ids.size();
  std::vector<double> scalar_alone(n), vector_alone(3 * n), scalar_together(n), vector_together(3 * n);
  map.apply(scalar, scalar_alone, 1);
  map.apply(vector, vector_alone, 3);
  const std::array<TransferItem, 2> both{TransferItem{scalar, scalar_together, 1},
                                         TransferItem{vector, vector_together, 3}};
  const std::int64_t messages = testing::communicator().count("test").messages;
  map.apply(both);
  map.apply(scalar, scalar_alone, 1);
  const std::int64_t of_both_and_one = testing::communicator().count("test").messages - messages;
  EXPECT_EQ(of_both_and_one % 2, 0) << "two fields take as many messages as one";
  EXPECT_EQ(scalar_alone, scalar_together);
  EXPECT_EQ(vector_alone, vector_together);
  for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(scalar_alone[i], vector_alone[3 * i + 1]);
  EXPECT_EQ(map.applied(), 4);
}

TEST(GridTransfer, AnyNumberOfComponentsIsTheSameArithmetic) {
  const Pair pair = inner_pair();
  const GridTransfer map = testing::make_transfer(pair, FieldKind::point_value);
  const std::vector<double> one = testing::sampled(*pair.source, Location::node, linear);
  std::vector<double> single(pair.target->node_ids.size());
  map.apply(one, single, 1);
  for (const int components : {2, 3, 4, 5, 6, 9}) {
    const auto width = static_cast<std::size_t>(components);
    std::vector<double> many(one.size() * width), result(single.size() * width);
    for (std::size_t i = 0; i < many.size(); ++i) many[i] = one[i / width];
    map.apply(many, result, components);
    for (std::size_t i = 0; i < result.size(); ++i) ASSERT_EQ(result[i], single[i / width]) << components;
  }
}

TEST(GridTransfer, ApplyAllocatesNothingOnceItHasGrown) {
  const Pair pair = inner_pair();
  const GridTransfer map = testing::make_transfer(pair, FieldKind::point_value);
  std::vector<double> source(3 * pair.source->node_ids.size(), 1.0), target(3 * pair.target->node_ids.size());
  for (int repeat = 0; repeat < 2; ++repeat) map.apply(source, target, 3);
  const std::int64_t before = tenon::testing::allocations();
  for (int repeat = 0; repeat < 5; ++repeat) map.apply(source, target, 3);
  EXPECT_EQ(tenon::testing::allocations(), before);
}

TEST(GridTransfer, UpdateRebuildsOnlyWhereSomethingMoved) {
  const Pair pair = inner_pair();
  GridTransfer map = testing::make_transfer(pair, FieldKind::point_value);
  EXPECT_FALSE(map.update(pair.source->coordinates, pair.target->coordinates));
  EXPECT_EQ(map.built(), 1);
  std::vector<Vec3> moved = pair.target->coordinates;
  for (Vec3& x : moved) x = x + Vec3{0.05, 0, 0};
  EXPECT_TRUE(map.update(pair.source->coordinates, moved));
  EXPECT_EQ(map.built(), 2);
  const std::vector<double> values = testing::sampled(*pair.source, Location::node, linear);
  std::vector<double> result(moved.size());
  map.apply(values, result, 1);
  EXPECT_LT(testing::greatest_error(*pair.target, Location::node, result,
                                    [](const Vec3& x) {
                                      return linear(x + Vec3{0.05, 0, 0});
                                    }),
            1e-14);
}

TEST(GridTransfer, OneElementToOneElement) {
  const Pair pair{distributed(box(1)), distributed(box(1, {.tetrahedra = true}))};
  const std::vector<double> values = testing::sampled(*pair.source, Location::node, linear);
  EXPECT_EQ(testing::greatest_error(*pair.target, Location::node,
                                    testing::transferred(pair, FieldKind::point_value, values), linear),
            0.0);
}

TEST(GridTransfer, MemoryGrowsWithTheMap) {
  const Pair small{distributed(box(2)), distributed(box(2))}, large{distributed(box(6)), distributed(box(6))};
  const auto memory = [](const Pair& pair) {
    return testing::communicator().sum(testing::make_transfer(pair, FieldKind::point_value).memory());
  };
  EXPECT_GT(memory(large), memory(small));
}

}  // namespace
}  // namespace tenon::transfer

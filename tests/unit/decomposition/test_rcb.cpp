// SPDX-License-Identifier: BSD-3-Clause
// G04: balance, ownership against overlap, small motion, more ranks than points.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "framework/decomposition/graph_partition.hpp"
#include "framework/decomposition/rcb.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

const Communicator& comm() {
  return testing::communicator();
}

enum class Shape { random, clustered, collinear, planar, lattice, coincident };
constexpr Shape shapes[] = {Shape::random, Shape::clustered, Shape::collinear,
                            Shape::planar, Shape::lattice,   Shape::coincident};

// The same points on every rank.
std::vector<Vec3> points_of(Shape shape, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  std::normal_distribution<double> normal(0, 1e-3);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    Vec3 x{u(random), u(random), u(random)};
    switch (shape) {
      case Shape::random:
        break;
      case Shape::clustered:
        for (std::size_t c = 0; c < 3; ++c) x[c] = (i % 5) * 0.2 + normal(random);
        break;
      case Shape::collinear:
        x = {x[0], 2 * x[0], -x[0]};
        break;
      case Shape::planar:
        x[2] = 0;
        break;
      case Shape::lattice:
        x = {1.0 * (i % 7), 1.0 * (i / 7 % 7), 1.0 * (i / 49)};
        break;
      case Shape::coincident:
        x = {0.3, -2, 1e4};
        break;
    }
    points.push_back(x);
  }
  return points;
}

// Which points of all this rank holds: all in turn, or the last rank everything.
std::vector<std::size_t> mine(std::size_t count, bool all_on_last) {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < count; ++i)
    if (all_on_last ? comm().rank() == comm().size() - 1
                    : static_cast<int>(i % static_cast<std::size_t>(comm().size())) == comm().rank())
      indices.push_back(i);
  return indices;
}

// Part of every point, on every rank.
std::vector<int> partition_all(Rcb& rcb, const std::vector<Vec3>& points, const std::vector<double>& weights,
                               bool all_on_last) {
  std::vector<Vec3> x;
  std::vector<double> w;
  const std::vector<std::size_t> indices = mine(points.size(), all_on_last);
  for (const std::size_t i : indices) {
    x.push_back(points[i]);
    if (!weights.empty()) w.push_back(weights[i]);
  }
  const std::vector<int> part = rcb.partition(x, w);
  std::vector<std::int64_t> all(points.size(), 0);
  for (std::size_t k = 0; k < indices.size(); ++k) all[indices[k]] = part[k];
  comm().sum(all);
  return {all.begin(), all.end()};
}

int ceil_log2(int ranks) {
  return static_cast<int>(std::bit_width(static_cast<unsigned>(ranks - 1)));
}

TEST(Rcb, PartsDifferByAtMostOnePointPerLevel) {
  for (const Shape shape : {Shape::random, Shape::clustered, Shape::collinear, Shape::planar})
    for (const int count : {100, 1001, 5000})
      for (const bool all_on_last : {false, true}) {
        Rcb rcb(comm());
        std::vector<int> points_in(static_cast<std::size_t>(comm().size()), 0);
        for (const int p : partition_all(rcb, points_of(shape, count, 1), {}, all_on_last))
          ++points_in[static_cast<std::size_t>(p)];
        const auto [least, most] = std::minmax_element(points_in.begin(), points_in.end());
        EXPECT_LE(*most - *least, std::max(1, ceil_log2(comm().size()))) << static_cast<int>(shape) << " " << count;
      }
}

TEST(Rcb, WeightsAreSharedToWithinOnePoint) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(0.1, 5);
  for (const Shape shape : {Shape::random, Shape::clustered}) {
    const std::vector<Vec3> points = points_of(shape, 3000, 2);
    std::vector<double> weights;
    for (std::size_t i = 0; i < points.size(); ++i) weights.push_back(u(random));
    Rcb rcb(comm());
    const std::vector<int> part = partition_all(rcb, points, weights, false);
    std::vector<double> weight_in(static_cast<std::size_t>(comm().size()), 0);
    double total = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      weight_in[static_cast<std::size_t>(part[i])] += weights[i];
      total += weights[i];
    }
    const double mean = total / comm().size();
    EXPECT_LE(*std::max_element(weight_in.begin(), weight_in.end()), mean + 5.0);
    EXPECT_LE(imbalance(comm(), weight_in[static_cast<std::size_t>(comm().rank())]), 1 + 5.0 / mean);
  }
}

// The part that owns a point is among those that overlap a box about it, on every rank, wherever the cuts fall.
TEST(Rcb, BoxesThatTouchAPointOverlapItsPart) {
  for (const Shape shape : shapes)
    for (const int count : {1, 2, 3, 5, 8, 13, 343, 1000})
      for (const bool all_on_last : {false, true}) {
        const std::vector<Vec3> points = points_of(shape, count, 3);
        Rcb rcb(comm());
        const std::vector<int> part = partition_all(rcb, points, {}, all_on_last);
        for (std::size_t i = 0; i < points.size(); ++i) {
          Box box{points[i], points[i]};
          box.inflate(1e-14 * 1e4);
          std::vector<int> ranks{-1};
          rcb.ranks_overlapping(box, ranks);
          ASSERT_TRUE(std::is_sorted(ranks.begin(), ranks.end()));
          ASSERT_TRUE(std::binary_search(ranks.begin(), ranks.end(), part[i]))
              << "shape " << static_cast<int>(shape) << ", point " << i << " of " << count;
        }
      }
}

TEST(Rcb, OverlapIsTheSameOnEveryRankAndNoMoreThanNeeded) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> u(-0.2, 1.2);
  const std::vector<Vec3> points = points_of(Shape::random, 4000, 5);
  Rcb rcb(comm());
  const std::vector<int> part = partition_all(rcb, points, {}, false);
  std::vector<Box> bounds(static_cast<std::size_t>(comm().size()));
  for (std::size_t i = 0; i < points.size(); ++i) bounds[static_cast<std::size_t>(part[i])].add(points[i]);
  int superfluous = 0, hits = 0;
  for (int q = 0; q < 1000; ++q) {
    Box box;
    box.add(Vec3{u(random), u(random), u(random)});
    box.high = box.low + Vec3{0.05, 0.05, 0.05};
    std::vector<int> ranks;
    rcb.ranks_overlapping(box, ranks);
    std::int64_t mask = 0;
    for (const int rank : ranks) mask |= std::int64_t{1} << rank;
    EXPECT_EQ(comm().max(mask), mask);
    for (int rank = 0; rank < comm().size(); ++rank)
      if (bounds[static_cast<std::size_t>(rank)].overlaps(box)) {
        EXPECT_TRUE(mask >> rank & 1);
        ++hits;
      } else if (box.high[0] > 0 && box.low[0] < 1 && box.high[1] > 0 && box.low[1] < 1 && box.high[2] > 0 &&
                 box.low[2] < 1) {
        superfluous += mask >> rank & 1;
      }
  }
  EXPECT_LE(superfluous, hits / 5);
}

TEST(Rcb, SmallMotionMovesFewPoints) {
  const int count = 60000 / comm().size();
  std::mt19937 random(100 + static_cast<unsigned>(comm().rank()));
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.push_back({u(random), u(random), u(random)});
  Rcb rcb(comm());
  std::vector<int> before = rcb.partition(points, {});
  for (int step = 0; step < 4; ++step) {
    for (Vec3& x : points)
      for (double& value : x) value += 1e-3 * (2 * u(random) - 1);
    const std::vector<int> after = rcb.partition(points, {});
    std::int64_t moved = 0;
    for (std::size_t i = 0; i < points.size(); ++i) moved += before[i] != after[i];
    EXPECT_LE(comm().sum(moved), comm().sum(std::int64_t{count}) / 20) << "step " << step;
    before = after;
  }
}

TEST(Rcb, WorksWithoutPointsAndWithPointsThatAreNotFinite) {
  Rcb rcb(comm());
  EXPECT_TRUE(rcb.partition({}, {}).empty());
  std::vector<int> ranks;
  rcb.ranks_overlapping({{0, 0, 0}, {1, 1, 1}}, ranks);
  EXPECT_EQ(ranks, std::vector<int>{0});
  rcb.ranks_overlapping(Box(), ranks);
  EXPECT_EQ(ranks.size(), 1u) << "an empty box overlaps nothing";

  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  std::vector<Vec3> points = points_of(Shape::random, 100, 8);
  points[5] = {nan, 0, 0};
  points[6] = {0, -inf, 0};
  const std::vector<int> part = rcb.partition(points, std::vector<double>(100, 2.0));
  ASSERT_EQ(part.size(), 100u);
  EXPECT_EQ(part[5], 0);
  EXPECT_EQ(part[6], 0);
  for (const int p : part) EXPECT_TRUE(p >= 0 && p < comm().size());
  EXPECT_EQ(rcb.partition(std::vector<Vec3>(3, Vec3{nan, nan, nan}), {}), std::vector<int>(3, 0));
}

// To plan for more ranks than there are.
TEST(Rcb, MakesAnyNumberOfPartsInOneProcess) {
  const std::vector<Vec3> points = points_of(Shape::random, 6000, 7);
  for (const int parts : {1, 5, 64}) {
    Rcb rcb(Communicator::self(), parts);
    const std::vector<int> part = rcb.partition(points, {});
    std::vector<int> count(static_cast<std::size_t>(parts), 0), found;
    for (std::size_t i = 0; i < points.size(); ++i) {
      ++count[static_cast<std::size_t>(part[i])];
      found.clear();
      rcb.ranks_overlapping({points[i], points[i]}, found);
      EXPECT_NE(std::find(found.begin(), found.end(), part[i]), found.end());
    }
    EXPECT_LE(*std::max_element(count.begin(), count.end()), 1.02 * 6000 / parts + 2) << parts;
  }
}

}  // namespace
}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// The local kernel of the broad phase against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <utility>

#include "framework/search/box_join.hpp"
#include "tests/support/allocation_counter.hpp"

namespace tenon {
namespace {

using Pairs = std::vector<std::pair<LocalIndex, LocalIndex>>;
constexpr double infinity = std::numeric_limits<double>::infinity();

bool is_there(const Box& box) {
  return box.low[0] <= box.high[0] && box.low[1] <= box.high[1] && box.low[2] <= box.high[2];
}

Pairs brute_force(const std::vector<Box>& first, const std::vector<Box>& second, bool within) {
  Pairs pairs;
  for (std::size_t i = 0; i < first.size(); ++i)
    for (std::size_t k = within ? i + 1 : 0; k < second.size(); ++k)
      if (is_there(first[i]) && is_there(second[k]) && first[i].overlaps(second[k]))
        pairs.emplace_back(static_cast<LocalIndex>(i), static_cast<LocalIndex>(k));
  return pairs;
}

Pairs sorted(const std::vector<BoxJoin::Pair>& found, bool within) {
  Pairs pairs;
  for (const auto& [i, k] : found)
    pairs.push_back(within ? std::pair(std::min(i, k), std::max(i, k)) : std::pair(i, k));
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void expect_exact(const std::vector<Box>& first, const std::vector<Box>& second) {
  BoxJoin join;
  std::vector<BoxJoin::Pair> found;
  join.build(first, second);
  join.find_pairs(found);
  EXPECT_EQ(sorted(found, false), brute_force(first, second, false));
  join.build(first);
  join.find_pairs(found);
  EXPECT_EQ(sorted(found, true), brute_force(first, first, true));
}

// Sizes over five decades.
std::vector<Box> scattered(int count, unsigned seed, double largest, const Vec3& around = {}) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<Box> boxes;
  for (int i = 0; i < count; ++i) {
    const double size = largest * std::pow(10, -5 * u(random));
    const Vec3 low = around + Vec3{u(random), u(random), u(random)};
    boxes.push_back({low, low + Vec3{size * u(random), size * u(random), size * u(random)}});
  }
  return boxes;
}

TEST(BoxJoin, EqualsBruteForceForAnyCount) {
  for (const int m : {0, 1, 7, 8, 9, 64, 65, 600})
    for (const int n : {0, 1, 8, 63, 513}) {
      SCOPED_TRACE(std::to_string(m) + " x " + std::to_string(n));
      expect_exact(scattered(m, 1, 0.5), scattered(n, 2, 0.5));
    }
}

TEST(BoxJoin, IsExactFarFromZero) {
  for (const double far : {1e3, 1e8, -1e15})
    expect_exact(scattered(300, 3, 0.5, {far, 0, -far}), scattered(400, 4, 0.5, {far, 0, -far}));
}

// Boxes that share faces, edges and corners: floats alone could not tell whether they touch.
TEST(BoxJoin, BoxesThatTouchOverlap) {
  std::vector<Box> lattice, shifted;
  for (int i = 0; i < 512; ++i) {
    const Vec3 low{0.1 * (i % 8) + 1.0 / 3, 0.1 * (i / 8 % 8), 0.1 * (i / 64)};
    const Vec3 high{0.1 * (i % 8 + 1) + 1.0 / 3, 0.1 * (i / 8 % 8 + 1), 0.1 * (i / 64 + 1)};
    lattice.push_back({low, high});
    for (const double towards : {-infinity, infinity}) {  // the next number below and above
      Vec3 beside = high;
      for (double& x : beside) x = std::nextafter(x, towards);
      shifted.push_back({beside, beside + Vec3{0.05, 0.05, 0.05}});
    }
  }
  expect_exact(lattice, shifted);
}

TEST(BoxJoin, CoincidentAndFlatBoxes) {
  const std::vector<Box> same(100, Box{{1, 2, 3}, {1, 2, 3}});
  expect_exact(same, same);
  std::vector<Box> flat = scattered(500, 5, 0.3);
  for (Box& box : flat) box.low[1] = box.high[1] = 0.25;
  expect_exact(flat, flat);
}

TEST(BoxJoin, EmptyEndlessAndBadBoxes) {
  std::vector<Box> boxes = scattered(300, 6, 0.4);
  const double nan = std::nan("");
  boxes[3] = Box();
  boxes[4].low[1] = nan;
  boxes[5].high[2] = nan;
  boxes[6] = {{0, 0, 0}, {1, -1, 1}};
  boxes[7] = {{-infinity, 0.2, -infinity}, {infinity, 0.3, infinity}};
  boxes[8] = {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  boxes[9] = {{infinity, infinity, infinity}, {infinity, infinity, infinity}};
  boxes[10] = {{1e300, -1e300, 0}, {1e308, 1e300, 1}};
  boxes[11] = {{-1e-310, 0, 0}, {0, 1e-310, 1e-320}};
  expect_exact(boxes, scattered(200, 7, 0.4));
  expect_exact(boxes, boxes);
  expect_exact({boxes.begin() + 3, boxes.begin() + 7}, boxes);
}

TEST(BoxJoin, OneBuildAfterAnother) {
  BoxJoin join;
  std::vector<BoxJoin::Pair> found;
  for (const int count : {400, 3, 0, 900}) {
    const std::vector<Box> boxes = scattered(count, 8, 0.5), points = scattered(2 * count, 9, 0);
    join.build(boxes, points);
    join.find_pairs(found);
    EXPECT_EQ(sorted(found, false), brute_force(boxes, points, false));
    join.find_pairs(found);
    EXPECT_EQ(sorted(found, false), brute_force(boxes, points, false));
  }
}

TEST(HilbertCurve, OrderIsThatOfItsCodes) {
  for (const int count : {0, 1, 30, 5000}) {
    std::vector<Box> boxes = scattered(count, 13, 0);
    for (std::size_t i = 0; i < boxes.size(); i += 2) boxes[i].low = 1e-4 * boxes[i].low;  // crowded, ties
    Box bounds;
    for (const Box& box : boxes) bounds.add(box.low);
    const HilbertCurve curve(bounds);
    std::vector<LocalIndex> expected(boxes.size());
    std::iota(expected.begin(), expected.end(), 0);
    const auto code = [&](LocalIndex i) { return curve.code(boxes[static_cast<std::size_t>(i)].low); };
    std::stable_sort(expected.begin(), expected.end(), [&](LocalIndex a, LocalIndex b) { return code(a) < code(b); });
    EXPECT_EQ(curve.order(boxes.size(), [&](std::size_t i) { return boxes[i].low; }), expected);
  }
}

TEST(BoxJoin, AllocatesNothingOnceGrown) {
  const std::vector<Box> boxes = scattered(3000, 11, 0.1), points = scattered(2000, 12, 0);
  BoxJoin join;
  std::vector<BoxJoin::Pair> between, within;
  const auto search = [&] {
    join.build(boxes, points);
    join.find_pairs(between);
    join.build(boxes);
    join.find_pairs(within);
  };
  search();
  const std::int64_t before = testing::allocations();
  search();
  EXPECT_EQ(testing::allocations(), before);
  EXPECT_FALSE(between.empty() || within.empty());
}

// A hundredfold spread of sizes must not cost more than the pairs that it makes.
TEST(BoxJoin, TestsGrowWithThePairs) {
  std::vector<Box> fine, points;
  for (int i = 0; i < 100; ++i)
    for (int k = 0; k < 100; ++k) {
      const Vec3 low{0.01 * i, 0.01 * k, 0};
      fine.push_back({low, low + Vec3{0.01, 0.01, 0.01}});
      points.push_back({low + Vec3{0.003, 0.004, 0.005}, low + Vec3{0.003, 0.004, 0.005}});
    }
  BoxJoin join;
  std::vector<BoxJoin::Pair> found;
  join.build(fine, points);
  join.find_pairs(found);
  const std::int64_t alone = join.tests();
  fine.push_back({{0, 0, 0}, {1, 1, 1}});
  join.build(fine, points);
  join.find_pairs(found);
  EXPECT_EQ(found.size(), 20000u);
  EXPECT_LE(join.tests(), alone + 4 * 8 * 10000);  // eight comparisons per pair, and the groups above
}

// A fragment that has flown off, however far, must not make floats and curve blind to all the rest.
TEST(BoxJoin, FewBoxesFarAwayCostNothing) {
  std::vector<Box> boxes = scattered(4000, 10, 0), points = boxes;
  for (Box& box : boxes) box.inflate(0.02);
  BoxJoin join;
  std::vector<BoxJoin::Pair> found;
  join.build(boxes, points);
  join.find_pairs(found);
  const std::size_t pairs = found.size();
  const std::int64_t tests = join.tests();
  for (const double far : {1e3, 1e9, 1e30, 1e200}) {
    std::vector<Box> others = boxes;
    for (std::size_t i = 0; i < 5; ++i)
      others.push_back({{far, -far, far * static_cast<double>(i)}, {2 * far, far, 1e3 * far}});
    join.build(others, points);
    join.find_pairs(found);
    EXPECT_EQ(found.size(), pairs) << far;
    EXPECT_LE(join.tests(), tests + tests / 2) << far;
  }
}

}  // namespace
}  // namespace tenon

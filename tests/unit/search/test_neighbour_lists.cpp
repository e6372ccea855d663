// SPDX-License-Identifier: BSD-3-Clause
// Neighbour lists against all pairs: reaches that differ fourfold, points that coincide, points on faces of cells, far
// away, not finite, alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "framework/search/neighbour_lists.hpp"

namespace tenon::testing {
namespace {

struct Points {
  std::vector<Vec3> places;
  std::vector<double> reach;
  std::vector<GlobalId> ids;
  std::vector<std::uint8_t> image;
  std::size_t owned = 0;
  double greatest = 0;
};

/// Puts the owned ones in canonical order.
void order(Points& p, double skin) {
  p.greatest = p.reach.empty() ? 1 : *std::ranges::max_element(p.reach);
  const CellGrid grid = NeighbourLists::cells(p.greatest, skin);
  std::vector<std::size_t> by(p.owned);
  for (std::size_t i = 0; i < by.size(); ++i) by[i] = i;
  std::ranges::sort(by, {}, [&](std::size_t i) { return std::pair(grid.key(p.places[i]), p.ids[i]); });
  const Points old = p;
  for (std::size_t i = 0; i < by.size(); ++i)
    p.places[i] = old.places[by[i]], p.reach[i] = old.reach[by[i]], p.ids[i] = old.ids[by[i]];
}

void expect_all_pairs(Points p, double skin) {
  order(p, skin);
  NeighbourLists lists;
  lists.build({p.places, p.reach, p.ids, p.image, p.owned}, p.greatest, skin);
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < p.owned; ++i) {
    std::vector<LocalIndex> expected, found(lists.of(i).begin(), lists.of(i).end());
    for (std::size_t j = 0; j < p.places.size(); ++j) {
      const Vec3 d = p.places[j] - p.places[i];
      const double together = std::max(p.reach[i], p.reach[j]) + skin;
      if (j != i && dot(d, d) < together * together) expected.push_back(static_cast<LocalIndex>(j));
    }
    std::ranges::sort(found);
    ASSERT_EQ(found, expected) << "of point " << i;
    pairs += found.size();
  }
  EXPECT_EQ(lists.pairs(), pairs);
  std::vector<int> visits(p.owned, 0);
  for (const NeighbourLists::Run& run : lists.runs())
    for (std::size_t i = run.first; i < run.last; ++i) ++visits[i];
  EXPECT_EQ(std::ranges::count(visits, 1), std::ssize(visits));
}

Points random_points(std::size_t count, std::size_t owned, double size, double spread, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> one(0, 1);
  Points p;
  for (std::size_t i = 0; i < count; ++i) {
    p.places.push_back({size * one(random), size * one(random), size * one(random)});
    p.reach.push_back(0.06 * std::pow(spread, one(random)));
    p.ids.push_back(static_cast<GlobalId>(i));
    p.image.push_back(0);
  }
  p.owned = owned;
  return p;
}

TEST(NeighbourLists, AllPairs) {
  expect_all_pairs(random_points(2000, 2000, 1, 1, 1), 0);
  expect_all_pairs(random_points(2000, 2000, 1, 1, 2), 0.02);
  expect_all_pairs(random_points(2000, 1500, 1, 4, 3), 0.01);
}

TEST(NeighbourLists, OnALattice) {
  Points p = random_points(1000, 700, 1, 1, 4);
  for (std::size_t i = 0; i < 1000; ++i)
    p.places[i] = {0.06 * static_cast<double>(i % 10), 0.06 * static_cast<double>(i / 10 % 10),
                   0.06 * static_cast<double>(i / 100) - 0.3};
  expect_all_pairs(p, 0);
}

TEST(NeighbourLists, AllInOnePlace) {
  Points p = random_points(100, 60, 0, 1, 5);
  expect_all_pairs(p, 0);
}

TEST(NeighbourLists, FarAwayAndNotFinite) {
  Points p = random_points(300, 200, 1, 1, 6);
  p.places[3] = {1e30, 0, 0}, p.places[4] = {1e30, 1e-3, 0}, p.places[5] = {-1e30, 1e30, 1e30};
  p.places[7] = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
  p.places[250] = {std::numeric_limits<double>::infinity(), 0, 0};
  expect_all_pairs(p, 0.01);
}

TEST(NeighbourLists, OneAndNone) {
  expect_all_pairs(random_points(1, 1, 1, 1, 7), 0.1);
  expect_all_pairs(random_points(0, 0, 1, 1, 8), 0.1);
  expect_all_pairs(random_points(5, 0, 1, 1, 9), 0.1);
}

// By cell, then id: whatever the order in which copies came.
TEST(NeighbourLists, InCanonicalOrder) {
  Points p = random_points(500, 250, 0.4, 1, 10);
  order(p, 0);
  const auto ids_of = [&](const Points& points, std::size_t i) {
    NeighbourLists lists;
    lists.build({points.places, points.reach, points.ids, points.image, points.owned}, points.greatest, 0);
    std::vector<GlobalId> ids;
    for (const LocalIndex j : lists.of(i)) ids.push_back(points.ids[static_cast<std::size_t>(j)]);
    return ids;
  };
  Points turned = p;
  std::reverse(turned.places.begin() + 250, turned.places.end());
  std::reverse(turned.ids.begin() + 250, turned.ids.end());
  for (std::size_t i = 0; i < 250; i += 17) EXPECT_EQ(ids_of(p, i), ids_of(turned, i));
}

}  // namespace
}  // namespace tenon::testing

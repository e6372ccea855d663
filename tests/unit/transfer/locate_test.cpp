// SPDX-License-Identifier: BSD-3-Clause
// The rendezvous against brute force over all elements, and bit for bit against one rank that has everything.
#include "transfer/locate.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numeric>

#include "framework/mesh/shape_functions.hpp"
#include "transfer/place_many.hpp"
#include "transfer_testing.hpp"

namespace tenon::transfer {
namespace {

using testing::communicator;

/// Brute force: every element is a candidate, and the nearest is sought among all.
Placement oracle(const ElementSet& all, const Vec3& point, const PlaceRules& rules) {
  std::vector<LocalIndex> candidates(all.size());
  std::iota(candidates.begin(), candidates.end(), 0);
  const Placement inside = place_inside(all, candidates, point, rules);
  if (inside.found()) return inside;
  // One tree of boxes without end, so that nothing is left out.
  const Box everywhere{{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}};
  const std::vector<Box> boxes(all.size(), everywhere);
  return place_nearest(all, BoxTree(boxes), point, 1e9, rules);
}

/// Four at a time or one by one, Newton ends within its round-off.
void expect_near(const Placement& a, const Placement& b, const Vec3& at) {
  EXPECT_EQ(a.element, b.element) << at[0] << " " << at[1] << " " << at[2];
  EXPECT_EQ(a.is_outside(), b.is_outside());
  const auto wa = testing::weights_of(a), wb = testing::weights_of(b);
  for (std::size_t i = 0; i < max_nodes; ++i) EXPECT_NEAR(wa[i], wb[i], 1e-13);
}

/// By one rank that has all elements.
std::vector<Placement> alone(const ElementSet& all, const std::vector<Vec3>& points, const PlaceRules& rules) {
  std::vector<Placement> places(points.size());
  place_many(all, BoxTree(all.boxes), points, 1e9, rules, places);
  return places;
}

void expect_same(const Placement& a, const Placement& b, const Vec3& at) {
  EXPECT_EQ(a.element, b.element) << at[0] << " " << at[1] << " " << at[2];
  EXPECT_EQ(a.state, b.state);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a.distance), std::bit_cast<std::uint64_t>(b.distance));
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.xi[c]), std::bit_cast<std::uint64_t>(b.xi[c]));
}

/// Deals points out, so that they are nowhere near their elements; the last rank gets none.
std::vector<Vec3> dealt(const std::vector<Vec3>& points) {
  std::vector<Vec3> mine;
  const int ranks = std::max(1, communicator().size() - 1);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (static_cast<int>(i) % ranks == communicator().rank()) mine.push_back(points[i]);
  return mine;
}

void compare(MeshData data, const std::vector<Vec3>& points, const PlaceRules& rules) {
  const ElementSet all = testing::element_set(data);
  const auto mesh = testing::distributed(std::move(data));
  const std::vector<Vec3> mine = dealt(points);
  const Containers containers = containers_of(*mesh, mesh->coordinates, {}, rules.tolerance, "test");
  const std::vector<Placement> placed = Locator(communicator(), rules, false, "test").find(containers, mine);
  ASSERT_EQ(placed.size(), mine.size());
  const std::vector<Placement> serial = alone(all, mine, rules);
  for (std::size_t i = 0; i < mine.size(); ++i) {
    expect_same(placed[i], serial[i], mine[i]);
    expect_near(placed[i], oracle(all, mine[i], rules), mine[i]);
  }
}

std::vector<Vec3> random_points(int count, double low, double high, std::uint64_t seed) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    Vec3 x;
    for (int c = 0; c < 3; ++c)
      x[static_cast<std::size_t>(c)] =
          low + (high - low) * testing::random_number(seed, static_cast<std::uint64_t>(3 * i + c));
    points.push_back(x);
  }
  return points;
}

std::vector<Vec3> lattice_points(int n) {
  std::vector<Vec3> points;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) points.push_back({1.0 * i / n, 1.0 * j / n, 1.0 * k / n});
  return points;
}

TEST(Locate, RandomPointsInDistortedHexes) {
  compare(testing::box(5, {.distortion = 0.2}), random_points(400, 0, 1, 1), {});
}

TEST(Locate, PointsOnFacesEdgesAndCornersOfHexesAndTets) {
  compare(testing::box(3), lattice_points(6), {});
  compare(testing::box(3, {.tetrahedra = true}), lattice_points(6), {});
}

TEST(Locate, PointsAroundAndFarAway) {
  for (const bool extrapolate : {false, true}) {
    compare(testing::box(4, {.distortion = 0.2}), random_points(60, -0.3, 1.3, 2), {1e-9, extrapolate});
    compare(testing::box(3, {.tetrahedra = true}), random_points(30, -50, 60, 3), {1e-9, extrapolate});
  }
}

TEST(Locate, ShearedElementsWhoseBoxesOverlapManyTimes) {
  // Each point is in a dozen boxes and in the element with the highest id of them.
  MeshData sheared = testing::box(12);
  for (Vec3& x : sheared.coordinates) x[0] += 12 * x[2];
  std::vector<Vec3> points;
  for (int k = 0; k < 12; ++k)
    for (int i = 0; i < 30; ++i) {
      const double z = (k + 0.05) / 12;
      points.push_back({(i + 0.5) / 30 + 12 * z, 0.37, z});
    }
  compare(std::move(sheared), points, {});
}

TEST(Locate, MixedKinds) {
  compare(testing::mixed_box(3), random_points(200, -0.1, 1.1, 4), {});
}

TEST(Locate, OneElementForAllRanks) {
  compare(testing::box(1), random_points(40, -1, 2, 5), {});
}

TEST(Locate, SphereAwayFromTheOrigin) {
  MeshData sphere = generate(SphereShape{.radius = 1e-3, .core = 2, .shell = 2});
  testing::shift(sphere, {1000, -2000, 500});
  std::vector<Vec3> points = random_points(100, -1.1e-3, 1.1e-3, 6);
  for (Vec3& p : points) p = p + Vec3{1000, -2000, 500};
  compare(std::move(sphere), points, {});
}

TEST(Locate, NoPointsAtAll) {
  const auto mesh = testing::distributed(testing::box(2));
  const Containers containers = containers_of(*mesh, mesh->coordinates, {}, 1e-9, "test");
  EXPECT_TRUE(Locator(communicator(), {}, false, "test").find(containers, {}).empty());
}

TEST(Containers, FlatElementsAreSkippedAndCounted) {
  MeshData data = testing::box(2);
  const auto mesh = testing::distributed(std::move(data));
  std::vector<Vec3> x = mesh->coordinates;
  for (Vec3& p : x) p[2] = p[2] == 1.0 ? 0.5 : p[2];  // the upper layer has no height left
  const Containers containers = containers_of(*mesh, x, {}, 1e-9, "test");
  EXPECT_EQ(containers.skipped, 4);
  EXPECT_EQ(containers.count, 4);
}

TEST(Containers, WedgeCollapsedHexIsSoundAndHoldsPoints) {
  MeshData data = testing::box(1);
  data.coordinates[1] = data.coordinates[0];
  data.coordinates[5] = data.coordinates[4];
  const std::vector<Vec3> points{{0.1, 0.5, 0.5}, {0.4, 0.9, 0.2}};
  compare(std::move(data), points, {});
}

TEST(Containers, InvertedElementsAreRefusedByName) {
  const auto mesh = testing::distributed(testing::box(1));
  std::vector<Vec3> x = mesh->coordinates;
  for (Vec3& p : x) p[2] = -p[2];
  std::vector<Vec3> bow_tie = mesh->coordinates;  // two opposite edges crossed: the volume cancels
  for (Vec3& p : bow_tie)
    if (p[1] == 1) p[0] = 1 - p[0];
  for (const std::vector<Vec3>& coordinates : {x, bow_tie}) {
    try {
      containers_of(*mesh, coordinates, {}, 1e-9, "heat");
      FAIL() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::geometry);
      EXPECT_NE(std::string(error.what()).find("transfer 'heat': element 1 of block 'box'"), std::string::npos)
          << error.what();
    }
  }
}

TEST(Containers, ChoiceOfBlocksAndSidesIsChecked) {
  const auto mesh = testing::distributed(testing::mixed_box(3));
  const Containers all = containers_of(*mesh, mesh->coordinates, {}, 1e-9, "test");
  const std::string first = mesh->blocks.front().name;
  const Containers some = containers_of(*mesh, mesh->coordinates, {{first}, ""}, 1e-9, "test");
  EXPECT_EQ(some.count, mesh->blocks.front().global_count);
  EXPECT_LT(some.count, all.count);
  EXPECT_THROW(containers_of(*mesh, mesh->coordinates, {{"no such block"}, ""}, 1e-9, "test"), Error);
  EXPECT_THROW(containers_of(*mesh, mesh->coordinates, {{}, "no such side set"}, 1e-9, "test"), Error);
}

TEST(Locate, AgainAfterMotionIsAsIfSoughtAnew) {
  for (const bool tetrahedra : {false, true})
    for (const double step : {1e-4, 0.02, 0.3}) {  // of the size of the body; elements have a fifth
      const auto mesh = testing::distributed(testing::box(5, {.tetrahedra = tetrahedra, .distortion = 0.15}));
      std::vector<Vec3> points = dealt(random_points(300, -0.1, 1.1, 7));
      Containers containers = containers_of(*mesh, mesh->coordinates, {}, 1e-9, "test");
      Locator locator(communicator(), {}, true, "test");
      locator.find(containers, points);
      std::vector<Vec3> x = mesh->coordinates;
      double moved = 0;
      for (int k = 0; k < 3; ++k) {
        for (Vec3& p : x) p = p + step * Vec3{std::sin(2 * p[1]), 0.5 * std::cos(3 * p[0]), 0.3 * p[0]};
        for (Vec3& p : points) p = p + step * Vec3{-0.2, 0.4 * p[2], 0.1};
        moved += 1.2 * step;
        move_containers(containers, *mesh, x, "test");
        const std::vector<Placement> again = locator.find_again(containers, points, moved);
        if (locator.decomposed()) moved = 0;
        const std::vector<Placement> anew = Locator(communicator(), {}, false, "test").find(containers, points);
        for (std::size_t i = 0; i < points.size(); ++i) expect_same(again[i], anew[i], points[i]);
      }
    }
}

}  // namespace
}  // namespace tenon::transfer

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

/// All elements of a whole mesh, as packets.
std::vector<ElementPacket> all_elements(const MeshData& mesh) {
  std::vector<ElementPacket> all;
  for (const BlockData& block : mesh.blocks) {
    const auto nodes = static_cast<std::size_t>(topology(block.kind).nodes);
    for (std::size_t e = 0; e < block.size(); ++e) {
      ElementPacket packet;
      Box box;
      for (std::size_t a = 0; a < nodes; ++a) {
        packet.corners[a] = mesh.coordinates[static_cast<std::size_t>(block.connectivity[e * nodes + a])];
        box.add(packet.corners[a]);
      }
      packet.kind = block.kind;
      packet.size = box.diagonal();
      packet.id = static_cast<GlobalId>(all.size());
      all.push_back(packet);
    }
  }
  return all;
}

/// Brute force: every element is a candidate, and the nearest is sought among all.
Placement oracle(const std::vector<ElementPacket>& all, const Vec3& point, const PlaceRules& rules) {
  std::vector<LocalIndex> candidates(all.size());
  std::iota(candidates.begin(), candidates.end(), 0);
  const Placement inside = place_inside(all, candidates, point, rules);
  if (inside.element != no_id) return inside;
  // One tree of boxes without end, so that nothing is left out.
  const Box everywhere{{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}};
  const std::vector<Box> boxes(all.size(), everywhere);
  return place_nearest(all, BoxTree(boxes), point, 1e9, rules);
}

/// Four at a time or one by one, Newton ends within its round-off.
void expect_near(const Placement& a, const Placement& b, const Vec3& at) {
  EXPECT_EQ(a.element, b.element) << at[0] << " " << at[1] << " " << at[2];
  EXPECT_EQ(a.outside, b.outside);
  for (std::size_t i = 0; i < max_nodes; ++i) EXPECT_NEAR(a.weights[i], b.weights[i], 1e-13);
}

/// By one rank that has all elements.
std::vector<Placement> alone(const std::vector<ElementPacket>& all, const std::vector<Vec3>& points,
                             const PlaceRules& rules) {
  std::vector<Box> boxes(all.size());
  for (std::size_t e = 0; e < all.size(); ++e) {
    for (const Vec3& corner : all[e].corner_span()) boxes[e].add(corner);
    boxes[e].inflate(1e-8 * all[e].size);
  }
  std::vector<Placement> places(points.size());
  place_many(all, boxes, BoxTree(boxes), points, 1e9, rules, places);
  return places;
}

void expect_same(const Placement& a, const Placement& b, const Vec3& at) {
  EXPECT_EQ(a.element, b.element) << at[0] << " " << at[1] << " " << at[2];
  EXPECT_EQ(a.outside, b.outside);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a.distance), std::bit_cast<std::uint64_t>(b.distance));
  for (std::size_t i = 0; i < max_nodes; ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.weights[i]), std::bit_cast<std::uint64_t>(b.weights[i]));
}

void compare(MeshData data, const std::vector<Vec3>& points, const PlaceRules& rules) {
  const std::vector<ElementPacket> all = all_elements(data);
  const auto mesh = testing::distributed(std::move(data));
  std::vector<Vec3> mine;  // dealt out, so that points are nowhere near their elements; the last rank gets none
  const int dealt = std::max(1, communicator().size() - 1);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (static_cast<int>(i) % dealt == communicator().rank()) mine.push_back(points[i]);
  const Containers containers = containers_of(*mesh, mesh->coordinates, rules.tolerance, "test");
  const std::vector<Placement> placed = locate(communicator(), containers, mine, rules, "test");
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
  const Containers containers = containers_of(*mesh, mesh->coordinates, 1e-9, "test");
  EXPECT_TRUE(locate(communicator(), containers, {}, {}, "test").empty());
}

TEST(Containers, FlatElementsAreSkippedAndCounted) {
  MeshData data = testing::box(2);
  const auto mesh = testing::distributed(std::move(data));
  std::vector<Vec3> x = mesh->coordinates;
  for (Vec3& p : x) p[2] = p[2] == 1.0 ? 0.5 : p[2];  // the upper layer has no height left
  const Containers containers = containers_of(*mesh, x, 1e-9, "test");
  EXPECT_EQ(containers.skipped, 4);
  EXPECT_EQ(communicator().sum(static_cast<std::int64_t>(containers.elements.size())), 4);
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
      containers_of(*mesh, coordinates, 1e-9, "heat");
      FAIL() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::geometry);
      EXPECT_NE(std::string(error.what()).find("transfer 'heat': element 1 of block 'box'"), std::string::npos)
          << error.what();
    }
  }
}

TEST(Containers, SurfacesAreRefused) {
  const auto mesh = testing::distributed(generate(PlateShape{.elements_x = 2, .elements_y = 2}));
  EXPECT_THROW(containers_of(*mesh, mesh->coordinates, 1e-9, "test"), Error);
}

}  // namespace
}  // namespace tenon::transfer

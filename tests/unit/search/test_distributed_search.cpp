// SPDX-License-Identifier: BSD-3-Clause
// Candidates found at the rendezvous against brute force over everything, with every kind of coincidence.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "framework/search/distributed_search.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

const Communicator& comm() {
  return testing::communicator();
}

struct Case {
  std::string name;
  std::vector<Box> boxes;
  std::vector<Vec3> points;
  double reach = 0;
};

// n^3 boxes of size h that touch, and points on all their corners: every cut coincides with faces and points.
Case lattice(int n, double h, const Vec3& origin) {
  Case c{"lattice", {}, {}};
  for (int i = 0; i < n * n * n; ++i) {
    const Vec3 low{origin[0] + h * (i % n), origin[1] + h * (i / n % n), origin[2] + h * (i / n / n)};
    c.boxes.push_back(
        {low, {origin[0] + h * (i % n + 1), origin[1] + h * (i / n % n + 1), origin[2] + h * (i / n / n + 1)}});
  }
  const int m = n + 1;
  for (int i = 0; i < m * m * m; ++i)
    c.points.push_back({origin[0] + h * (i % m), origin[1] + h * (i / m % m), origin[2] + h * (i / m / m)});
  return c;
}

std::vector<Case> cases() {
  std::vector<Case> all{{"nothing", {}, {}}};
  all.push_back({"boxes only", lattice(3, 1, {0, 0, 0}).boxes, {}});
  all.push_back({"points only", {}, lattice(3, 1, {0, 0, 0}).points});
  all.push_back({"one of each", {{{0, 0, 0}, {1, 1, 1}}}, {{1, 1, 1}}});
  all.push_back(lattice(2, 1, {0, 0, 0}));
  all.push_back(lattice(6, 1, {0, 0, 0}));
  all.push_back(lattice(7, 0.1, {0.3, -12.7, 1e3}));
  Case plane = lattice(8, 0.125, {-0.5, -0.5, 0});
  plane.name = "plane";
  for (Box& box : plane.boxes) box.low[2] = box.high[2] = 0;
  for (Vec3& point : plane.points) point[2] = 0;
  all.push_back(plane);
  all.push_back({"coincident", std::vector<Box>(50, Box{{0, 0, 0}, {1, 1, 1}}), std::vector<Vec3>(70, Vec3{1, 1, 1})});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-1, 1);
  Case scattered{"random with reach", {}, {}, 0.125};
  for (int i = 0; i < 300; ++i) {
    const Vec3 x{u(random), u(random), u(random)};
    scattered.boxes.push_back({x, x + std::abs(u(random)) * Vec3{0.2, 0.2, 0.2}});
    scattered.points.push_back({u(random), u(random), u(random)});
  }
  for (int i = 0; i < 100; ++i) {  // exactly at the reach
    const Box& box = scattered.boxes[static_cast<std::size_t>(i)];
    scattered.points.push_back({box.high[0] + 0.125, box.high[1], box.low[2]});
  }
  all.push_back(scattered);
  Case bad = scattered;
  bad.name = "with bad ones";
  for (std::size_t i = 0; i < 300; i += 9) {
    bad.boxes[i].low[i % 3] = std::nan("");
    bad.boxes[i + 1] = Box();
    bad.points[i][1] = std::nan("");
  }
  all.push_back(bad);
  Case far_apart = lattice(4, 1, {0, 0, 0});
  far_apart.name = "every rank within reach of all";
  far_apart.reach = std::numeric_limits<double>::infinity();
  all.push_back(far_apart);
  return all;
}

// Spreads items over the ranks in one of several ways; true where this rank holds item i.
bool holds(int way, std::size_t i, std::size_t count) {
  const auto ranks = static_cast<std::size_t>(comm().size()), rank = static_cast<std::size_t>(comm().rank());
  switch (way) {
    case 0:
      return i % ranks == rank;
    case 1:
      return i * ranks / count == rank;
    default:
      return rank == ranks - 1;  // the others own nothing
  }
}

void compare_with_brute_force(const Case& c, int way) {
  SCOPED_TRACE(c.name + ", way " + std::to_string(way));
  std::vector<Box> boxes;
  std::vector<Vec3> points;
  std::vector<int> box_ids, point_ids;
  for (std::size_t i = 0; i < c.boxes.size(); ++i)
    if (holds(way, i, c.boxes.size())) boxes.push_back(c.boxes[i]), box_ids.push_back(static_cast<int>(i));
  for (std::size_t i = 0; i < c.points.size(); ++i)
    if (holds(2 - way, i, c.points.size())) points.push_back(c.points[i]), point_ids.push_back(static_cast<int>(i));

  const DistributedSearch search(comm(), boxes, points, c.reach, "test");
  std::vector<int> sent_ids;
  for (const LocalIndex i : search.box_of_send()) sent_ids.push_back(box_ids[static_cast<std::size_t>(i)]);
  std::vector<int> arrived_boxes(static_cast<std::size_t>(search.boxes().received()));
  search.boxes().forward(std::span<const int>(sent_ids), std::span(arrived_boxes));
  std::vector<int> arrived_points(static_cast<std::size_t>(search.points().received()));
  search.points().forward(std::span<const int>(point_ids), std::span(arrived_points));
  EXPECT_EQ(comm().sum(static_cast<std::int64_t>(arrived_points.size())), static_cast<std::int64_t>(c.points.size()));
  ASSERT_EQ(search.arrived_boxes().size(), arrived_boxes.size());
  ASSERT_EQ(search.tree().size(), static_cast<LocalIndex>(arrived_boxes.size()));

  for (std::size_t p = 0; p < arrived_points.size(); ++p) {
    const Vec3 point = search.arrived_points()[p];
    const Box around{point - c.reach * Vec3{1, 1, 1}, point + c.reach * Vec3{1, 1, 1}};
    std::vector<LocalIndex> found;
    search.tree().overlapping(around, found);
    std::vector<int> ids, expected;
    for (const LocalIndex i : found) ids.push_back(arrived_boxes[static_cast<std::size_t>(i)]);
    std::sort(ids.begin(), ids.end());
    for (std::size_t i = 0; i < c.boxes.size(); ++i) {
      const Vec3 &low = c.boxes[i].low, &high = c.boxes[i].high;
      if (!std::isnan(low[0] + low[1] + low[2] + high[0]) && c.boxes[i].overlaps(around))
        expected.push_back(static_cast<int>(i));
    }
    ASSERT_EQ(ids, expected) << "point " << arrived_points[p];
  }

  // Results go back the way the points came.
  std::vector<int> back(points.size(), -1);
  search.points().reverse(std::span<const int>(arrived_points), std::span(back));
  EXPECT_EQ(back, point_ids);
}

TEST(DistributedSearch, CandidatesEqualBruteForce) {
  for (const Case& c : cases())
    for (int way = 0; way < 3; ++way) compare_with_brute_force(c, way);
}

TEST(DistributedSearch, ClonesOnlyBoxesNearCuts) {
  const Case c = lattice(12, 1, {0, 0, 0});
  std::vector<Box> boxes;
  std::vector<Vec3> points;
  if (comm().rank() == 0) boxes = c.boxes, points = c.points;
  const DistributedSearch search(comm(), boxes, points, 0, "test");
  const std::int64_t arrived = comm().sum(std::int64_t{search.boxes().received()});
  EXPECT_GE(arrived, static_cast<std::int64_t>(c.boxes.size()));
  EXPECT_LE(arrived, static_cast<std::int64_t>(c.boxes.size()) + 2 * 12 * 12 * (comm().size() - 1));
}

TEST(DistributedSearch, KeptCutsMoveFewItems) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<Box> boxes;
  std::vector<Vec3> points;
  for (int i = 0; i < 2000; ++i) points.push_back({u(random), u(random), u(random)});
  Rcb rcb(comm());
  std::vector<int> before(points.size()), after(points.size());
  for (std::vector<int>* ranks : {&before, &after}) {
    const DistributedSearch search(comm(), rcb, boxes, points, 0, "test");
    const std::vector<int> here(static_cast<std::size_t>(search.points().received()), comm().rank());
    search.points().reverse(std::span<const int>(here), std::span(*ranks));
    for (Vec3& point : points) point[0] += 1e-3 * (u(random) - 0.5);
  }
  int moved = 0;
  for (std::size_t i = 0; i < points.size(); ++i) moved += before[i] != after[i];
  EXPECT_LE(moved, 100);
}

}  // namespace
}  // namespace tenon

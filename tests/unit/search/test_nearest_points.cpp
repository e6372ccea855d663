// SPDX-License-Identifier: BSD-3-Clause
// The k nearest points against brute force over everything, however the points are spread over space and ranks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include "framework/search/nearest_points.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

const Communicator& comm() {
  return testing::communicator();
}

struct Case {
  std::string name;
  std::vector<Vec3> cloud, points;
};

/// Deterministic numbers in [-1, 1).
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()() { return std::uniform_real_distribution<double>(-1, 1)(engine_); }
  Vec3 point() {
    const double x = (*this)(), y = (*this)(), z = (*this)();
    return {x, y, z};
  }
  std::vector<Vec3> points(int count, const Vec3& scale = {1, 1, 1}) {
    std::vector<Vec3> all;
    for (int i = 0; i < count; ++i) {
      const Vec3 x = point();
      all.push_back({scale[0] * x[0], scale[1] * x[1], scale[2] * x[2]});
    }
    return all;
  }

 private:
  std::mt19937 engine_;
};

std::vector<Case> cases() {
  Random random(7);
  std::vector<Case> all{{"nothing", {}, {}}, {"no points", random.points(20), {}}, {"no cloud", {}, random.points(20)}};
  all.push_back({"random", random.points(700), random.points(300)});
  all.push_back({"fewer than k", random.points(7), random.points(50)});
  all.push_back({"one", {{1, 2, 3}}, random.points(30)});
  all.push_back({"coincident", std::vector<Vec3>(60, Vec3{0.1, 0.2, 0.3}), random.points(40)});
  Case pairs{"each point five times", {}, {}};
  for (const Vec3& x : random.points(80)) pairs.cloud.insert(pairs.cloud.end(), 5, x);
  pairs.points = random.points(100);
  pairs.points.insert(pairs.points.end(), pairs.cloud.begin(), pairs.cloud.begin() + 40);
  all.push_back(pairs);
  all.push_back({"line", random.points(300, {1, 0, 0}), random.points(100, {1.5, 1e-3, 0.3})});
  all.push_back({"plane", random.points(400, {1, 0, 2}), random.points(100)});
  Case lattice{"lattice: most distances equal", {}, {}};
  for (int i = 0; i < 512; ++i) lattice.cloud.push_back({0.25 * (i % 8), 0.25 * (i / 8 % 8), 0.25 * (i / 64)});
  lattice.points = lattice.cloud;
  for (const Vec3& x : lattice.cloud) lattice.points.push_back(x + Vec3{0.125, 0.125, 0.125});
  all.push_back(lattice);
  Case clusters{"clusters 1000 : 1", random.points(150), random.points(60)};
  for (const Vec3& x : random.points(150)) clusters.cloud.push_back(Vec3{0.3, 0.3, 0.3} + 1e-3 * x);
  for (const Vec3& x : random.points(60)) clusters.points.push_back(Vec3{0.3, 0.3, 0.3} + 2e-3 * x);
  all.push_back(clusters);
  Case away{"far away and far from zero", {}, {}};
  for (const Vec3& x : random.points(200)) away.cloud.push_back(Vec3{1e6, 0, 0} + 1e-2 * x);
  for (const Vec3& x : random.points(30)) away.points.push_back(x);
  for (const Vec3& x : random.points(30)) away.points.push_back(Vec3{1e6, 0, 0} + 1e-2 * x);
  all.push_back(away);
  return all;
}

/// Ids that are in no order of space.
GlobalId id_of(std::size_t i, std::size_t count) {
  return static_cast<GlobalId>((i * 7919 + 13) % count * 3);
}

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

/// What every point should find, by brute force.
std::vector<Nearest> expected(const Case& c, const Vec3& x, int k) {
  std::vector<Nearest> all;
  for (std::size_t i = 0; i < c.cloud.size(); ++i) {
    const Vec3 d = c.cloud[i] - x;
    all.push_back({id_of(i, c.cloud.size()), d[0] * d[0] + d[1] * d[1] + d[2] * d[2]});
  }
  std::sort(all.begin(), all.end(), [](const Nearest& a, const Nearest& b) {
    return std::pair(a.squared_distance, a.id) < std::pair(b.squared_distance, b.id);
  });
  all.resize(static_cast<std::size_t>(k));
  return all;
}

void compare_with_brute_force(const Case& c, int way, int k) {
  SCOPED_TRACE(c.name + ", way " + std::to_string(way) + ", k " + std::to_string(k));
  std::vector<CloudPoint> cloud;
  for (std::size_t i = 0; i < c.cloud.size(); ++i)
    if (holds(way, i, c.cloud.size()))
      cloud.push_back({c.cloud[i], id_of(i, c.cloud.size()), comm().rank(), static_cast<LocalIndex>(cloud.size())});
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < c.points.size(); ++i)
    if (holds(2 - way, i, c.points.size())) points.push_back(c.points[i]);

  const std::vector<Nearest> found = k_nearest(comm(), cloud, points, k, "test");
  const auto width = static_cast<std::size_t>(k);
  ASSERT_EQ(found.size(), points.size() * width);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::vector<Nearest> right = expected(c, points[p], k);
    for (std::size_t j = 0; j < width; ++j) {
      ASSERT_EQ(found[p * width + j].id, right[j].id) << "neighbour " << j << " of " << points[p][0];
      ASSERT_EQ(found[p * width + j].squared_distance, right[j].squared_distance);
    }
  }
}

TEST(NearestPoints, EqualBruteForce) {
  for (const Case& c : cases())
    for (int way = 0; way < 3; ++way)
      for (const int k : {1, 20}) compare_with_brute_force(c, way, k);
}

TEST(NearestPoints, NeighboursSayWhereTheirOwnersKeepThem) {
  Random random(3);
  const std::vector<Vec3> all = random.points(100);
  std::vector<CloudPoint> cloud;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (holds(0, i, all.size()))
      cloud.push_back({all[i], static_cast<GlobalId>(i), comm().rank(), static_cast<LocalIndex>(cloud.size())});
  const std::vector<Vec3> points = random.points(25);
  std::vector<CloudPoint> nearest(points.size());
  for_each_with_nearest(
      comm(), cloud, points, 4, sizeof(CloudPoint), std::as_writable_bytes(std::span(nearest)),
      [](const Vec3&, std::span<const NearPoint> near, std::span<std::byte> result) {
        std::memcpy(result.data(), near.front().point, sizeof(CloudPoint));
      },
      "test");
  for (const CloudPoint& p : nearest) {
    const auto ranks = static_cast<GlobalId>(comm().size());
    EXPECT_EQ(p.owner, p.id % ranks);
    EXPECT_EQ(p.at_owner, p.id / ranks);
    EXPECT_EQ(p.x, all[static_cast<std::size_t>(p.id)]);
  }
}

TEST(NearestPoints, RefusesWhatIsNoPlaceOnAllRanks) {
  std::vector<CloudPoint> cloud{{{0, 0, 0}, comm().rank(), comm().rank(), 0}};
  std::vector<Vec3> points{{1, 0, 0}};
  if (comm().rank() == comm().size() - 1) points.front()[1] = std::nan("");
  EXPECT_THROW(k_nearest(comm(), cloud, points, 3, "test"), Error);
  points.front() = {1, 0, 0};
  if (comm().rank() == 0) cloud.front().x[2] = 1e200;
  EXPECT_THROW(k_nearest(comm(), cloud, points, 3, "test"), Error);
}

}  // namespace
}  // namespace tenon

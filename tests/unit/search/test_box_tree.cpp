// SPDX-License-Identifier: BSD-3-Clause
// The tree against brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <string>

#include "framework/search/box_tree.hpp"

namespace tenon {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Vec3 random_point(std::mt19937& random, double low, double high) {
  std::uniform_real_distribution<double> u(low, high);
  return {u(random), u(random), u(random)};
}

struct Case {
  std::string name;
  std::vector<Box> boxes;
};

std::vector<Case> cases() {
  std::mt19937 random(7);
  std::vector<Case> all{{"none", {}}, {"one", {{{0, 0, 0}, {1, 1, 1}}}}};
  for (const int count : {7, 8, 9, 63, 64, 65, 600}) {
    Case c{"random " + std::to_string(count), {}};
    for (int i = 0; i < count; ++i) {
      const Vec3 low = random_point(random, -1, 1);
      c.boxes.push_back({low, low + random_point(random, 0, 0.3)});
    }
    all.push_back(c);
  }
  Case lattice{"lattice whose boxes touch", {}};
  for (int i = 0; i < 512; ++i) {
    const Vec3 low{0.25 * (i % 8) - 1, 0.25 * (i / 8 % 8) - 1, 0.25 * (i / 64) - 1};
    lattice.boxes.push_back({low, low + Vec3{0.25, 0.25, 0.25}});
  }
  all.push_back(lattice);
  all.push_back({"coincident", std::vector<Box>(100, Box{{0, 0, 0}, {0.5, 0.5, 0.5}})});
  Case points{"points", {}}, sizes{"sizes of 1e-9 to 1e3", {}}, far{"far from the origin", {}}, bad{"bad ones", {}};
  for (int i = 0; i < 200; ++i) {
    const Vec3 x = random_point(random, -1, 1);
    points.boxes.push_back({x, x});
    const double size = std::pow(10.0, -9 + 12 * (i / 200.0));
    sizes.boxes.push_back({x - size * Vec3{1, 1, 1}, x + size * Vec3{1, 1, 1}});
    far.boxes.push_back({x + Vec3{1e7, -1e7, 3e6}, x + Vec3{1e7 + 0.1, -1e7 + 0.1, 3e6 + 0.1}});
    bad.boxes.push_back({x, x + Vec3{0.3, 0.3, 0.3}});
  }
  for (std::size_t i = 0; i < 200; i += 7) {
    bad.boxes[i].low[i % 3] = nan;
    bad.boxes[i + 1].high[i % 3] = nan;
    bad.boxes[i + 2] = Box();
    bad.boxes[i + 3] = {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};
  }
  all.insert(all.end(),
             {points, sizes, far, bad, {"all not a number", std::vector<Box>(20, {{nan, nan, nan}, {nan, nan, nan}})}});
  return all;
}

// Points inside, outside and exactly on faces and corners of the boxes.
std::vector<Vec3> queries(const Case& c) {
  std::mt19937 random(11);
  std::vector<Vec3> points;
  for (int i = 0; i < 100; ++i) points.push_back(random_point(random, -1.5, 1.5));
  for (std::size_t i = 0; i < c.boxes.size(); i += 3) {
    points.insert(points.end(), {c.boxes[i].low, c.boxes[i].high, 0.5 * (c.boxes[i].low + c.boxes[i].high)});
    points.push_back({c.boxes[i].low[0], c.boxes[i].high[1], c.boxes[i].low[2]});
    points.push_back({std::nextafter(c.boxes[i].low[0], -infinity), c.boxes[i].low[1], c.boxes[i].low[2]});
  }
  points.push_back({nan, 0, 0});
  return points;
}

bool is_number(const Box& b) {
  return b.low[0] == b.low[0] && b.low[1] == b.low[1] && b.low[2] == b.low[2] && b.high[0] == b.high[0] &&
         b.high[1] == b.high[1] && b.high[2] == b.high[2];
}

TEST(BoxTree, FindsWhatContainsAPoint) {
  for (const Case& c : cases()) {
    const BoxTree tree(c.boxes);
    EXPECT_EQ(tree.size(), static_cast<LocalIndex>(c.boxes.size()));
    for (const Vec3& point : queries(c)) {
      std::vector<LocalIndex> found{-5}, expected{-5};
      tree.containing(point, found);
      for (std::size_t i = 0; i < c.boxes.size(); ++i)
        if (c.boxes[i].contains(point)) expected.push_back(static_cast<LocalIndex>(i));
      std::sort(found.begin(), found.end());
      ASSERT_EQ(found, expected) << c.name;
    }
  }
}

TEST(BoxTree, FindsWhatOverlapsABox) {
  std::mt19937 random(13);
  for (const Case& c : cases()) {
    const BoxTree tree(c.boxes);
    for (const Vec3& point : queries(c)) {
      const Box query{point, point + random_point(random, 0, 0.5)};
      std::vector<LocalIndex> found, expected;
      tree.overlapping(query, found);
      for (std::size_t i = 0; i < c.boxes.size(); ++i)
        if (is_number(c.boxes[i]) && c.boxes[i].overlaps(query)) expected.push_back(static_cast<LocalIndex>(i));
      std::sort(found.begin(), found.end());
      ASSERT_EQ(found, expected) << c.name;
    }
  }
}

TEST(BoxTree, NearestVisitsEveryItemAtTheLeastDistance) {
  for (const Case& c : cases()) {
    const BoxTree tree(c.boxes);
    for (const Vec3& point : queries(c)) {
      double expected = infinity;
      for (const Box& box : c.boxes)
        if (is_number(box) && !box.empty()) expected = std::min(expected, box.distance(point));
      std::vector<double> visited(c.boxes.size(), -1);
      const double least = tree.nearest(point, infinity, [&](LocalIndex i) {
        EXPECT_EQ(visited[static_cast<std::size_t>(i)], -1) << "visited twice";
        return visited[static_cast<std::size_t>(i)] = c.boxes[static_cast<std::size_t>(i)].distance(point);
      });
      if (std::isnan(point[0] + point[1] + point[2]) || std::isinf(expected)) {
        EXPECT_EQ(least, infinity) << c.name;
        continue;
      }
      ASSERT_EQ(least, expected) << c.name;
      for (std::size_t i = 0; i < c.boxes.size(); ++i)
        if (is_number(c.boxes[i]) && c.boxes[i].distance(point) == least) {
          ASSERT_EQ(visited[i], least) << c.name << ": box " << i << " was left out";
        }
    }
  }
}

TEST(BoxTree, NearestKeepsToTheLimitAndVisitsFew) {
  std::mt19937 random(17);
  std::vector<Box> boxes;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 x = random_point(random, 0, 1);
    boxes.push_back({x, x});
  }
  const BoxTree tree(boxes);
  const Vec3 outside{2, 0.5, 0.5};
  EXPECT_EQ(tree.nearest(outside, 0.9, [](LocalIndex) { return 0.0; }), infinity);
  int visits = 0;
  for (int q = 0; q < 1000; ++q) {
    const Vec3 point = random_point(random, 0, 1);
    tree.nearest(point, infinity, [&](LocalIndex i) {
      ++visits;
      return norm(boxes[static_cast<std::size_t>(i)].low - point);
    });
  }
  EXPECT_LT(visits, 20 * 1000);
  EXPECT_GE(visits, 1000);
}

TEST(BoxTree, IsRebuilt) {
  BoxTree tree(std::vector<Box>(1000, Box{{0, 0, 0}, {1, 1, 1}}));
  tree.build(std::vector<Box>(3, Box{{5, 5, 5}, {6, 6, 6}}));
  std::vector<LocalIndex> found;
  tree.containing({0.5, 0.5, 0.5}, found);
  EXPECT_TRUE(found.empty());
  tree.containing({5.5, 5.5, 5.5}, found);
  EXPECT_EQ(found.size(), 3u);
  tree.build({});
  EXPECT_EQ(tree.size(), 0);
  tree.containing({5.5, 5.5, 5.5}, found);
  EXPECT_EQ(found.size(), 3u);
}

}  // namespace
}  // namespace tenon

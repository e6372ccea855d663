// SPDX-License-Identifier: BSD-3-Clause
// The serial heart of transfer: weights of one point in one or a few elements.
#include "transfer/place.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "framework/mesh/shape_functions.hpp"

namespace tenon::transfer {
namespace {

/// One element of some kind.
ElementSet element(ElementKind kind, std::initializer_list<Vec3> corners, GlobalId id = 0) {
  ElementSet set;
  set.x.assign(corners);
  for (std::size_t a = 0; a < set.x.size(); ++a) set.nodes.push_back(static_cast<LocalIndex>(a));
  set.stride = set.x.size();
  set.kinds = {kind};
  set.ids = {id};
  set.items = {static_cast<LocalIndex>(id)};
  Box box;
  for (const Vec3& x : set.x) box.add(x);
  box.inflate(1e-8);
  set.boxes = {box};
  set.x.push_back({});
  return set;
}

std::vector<ElementSet> one_of_each() {
  return {
      element(ElementKind::hex8,
              {{0, 0, 0}, {1, 0.1, 0}, {1.1, 1, 0.1}, {0, 0.9, 0}, {0.1, 0, 1}, {1, 0, 0.8}, {1, 1.2, 1}, {0, 1, 1.1}}),
      element(ElementKind::tet4, {{0, 0, 0}, {1, 0.1, 0}, {0.2, 1, 0}, {0.1, 0.2, 1}}),
      element(ElementKind::wedge6, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.1}, {0, 0.1, 1}, {1, 0, 1.2}, {0.1, 1, 1}}),
      element(ElementKind::pyramid5, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1.1, 0}, {0.4, 0.5, 1}})};
}

std::vector<double> weights_of(const Placement& place) {
  std::vector<double> weights(place.nodes());
  shape_weights(place, weights);
  return weights;
}

double sum(const Placement& place) {
  const std::vector<double> weights = weights_of(place);
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

Vec3 weighted(const ElementSet& e, const Placement& place) {
  const std::vector<double> weights = weights_of(place);
  Vec3 x{};
  for (std::size_t a = 0; a < weights.size(); ++a) x = x + weights[a] * e.x[a];
  return x;
}

Placement inside(const ElementSet& e, const Vec3& point) {
  std::vector<LocalIndex> candidates{0};
  return place_inside(e, candidates, point, {});
}

Placement nearest(const ElementSet& e, const Vec3& point, bool extrapolate) {
  return place_nearest(e, BoxTree(e.boxes), point, 10.0, {1e-9, extrapolate});
}

TEST(Place, InnerPointHasPositiveWeightsThatReproduceIt) {
  for (const ElementSet& e : one_of_each()) {
    const Vec3 point = map_to_space(e.kind(0), CornerList(e, 0).span(), 0.7 * element_centre(e.kind(0)));
    const Placement place = inside(e, point);
    ASSERT_EQ(place.element, 0) << topology(e.kind(0)).name;
    EXPECT_FALSE(place.is_outside());
    EXPECT_NEAR(sum(place), 1.0, 2e-16);
    EXPECT_LT(norm(weighted(e, place) - point), 1e-15);
    for (const double w : weights_of(place)) EXPECT_GE(w, 0.0);
  }
}

TEST(Place, CornerIsExactlyThatCorner) {
  for (const ElementSet& e : one_of_each())
    for (std::size_t a = 0; a < e.stride; ++a) {
      const Placement place = inside(e, e.x[a]);
      ASSERT_EQ(place.element, 0) << topology(e.kind(0)).name << " corner " << a;
      for (std::size_t b = 0; b < e.stride; ++b) EXPECT_EQ(weights_of(place)[b], a == b ? 1.0 : 0.0);
    }
}

TEST(Place, OutsideIsNotInside) {
  for (const ElementSet& e : one_of_each()) EXPECT_EQ(inside(e, {-0.5, 0.3, 0.3}).element, no_id);
}

TEST(Place, SharedFaceGoesToTheSmallestId) {
  ElementSet both = element(ElementKind::hex8,
                            {{0, 0, 0},
                             {1, 0, 0},
                             {1, 1, 0},
                             {0, 1, 0},
                             {0, 0, 1},
                             {1, 0, 1},
                             {1, 1, 1},
                             {0, 1, 1},
                             {2, 0, 0},
                             {2, 1, 0},
                             {2, 0, 1},
                             {2, 1, 1}},
                            7);
  both.stride = 8;
  both.nodes = {0, 1, 2, 3, 4, 5, 6, 7, 1, 8, 9, 2, 5, 10, 11, 6};
  both.ids = {7, 4}, both.items = {7, 4};
  for (const auto& order : {std::vector<LocalIndex>{0, 1}, std::vector<LocalIndex>{1, 0}}) {
    std::vector<LocalIndex> candidates = order;
    EXPECT_EQ(place_inside(both, candidates, {1, 0.3, 0.6}, {}).element, 4);
    candidates = order;
    // Farther from the face than round-off: in the one that really holds it, although the other is within tolerance.
    EXPECT_EQ(place_inside(both, candidates, {1 - 1e-10, 0.3, 0.6}, {}).element, 7);
  }
}

TEST(Place, NearestHasNoNegativeWeightsAndTheTrueDistance) {
  for (const ElementSet& e : one_of_each()) {
    const Vec3 point{0.3, 0.2, -0.25};
    const Placement place = nearest(e, point, false);
    ASSERT_EQ(place.element, 0);
    EXPECT_TRUE(place.is_outside());
    EXPECT_NEAR(sum(place), 1.0, 2e-16);
    for (const double w : weights_of(place)) EXPECT_GE(w, 0.0);
    EXPECT_NEAR(norm(weighted(e, place) - point), place.distance, 1e-14);
  }
}

TEST(Place, ExtrapolationReproducesThePointHoweverFar) {
  for (const ElementSet& e : one_of_each())
    for (const double away : {0.01, 0.4, 3.0}) {
      const Vec3 point{0.3, -away, 0.2};
      const Placement place = nearest(e, point, true);
      ASSERT_TRUE(place.is_outside());
      EXPECT_NEAR(sum(place), 1.0, 1e-15);
      EXPECT_LT(norm(weighted(e, place) - point), 1e-14 * (1 + away)) << topology(e.kind(0)).name << " " << away;
    }
}

TEST(Place, BeyondReachIsNothing) {
  const ElementSet e = one_of_each().front();
  EXPECT_EQ(place_nearest(e, BoxTree(e.boxes), {-3, 0, 0}, 2.0, {}).element, no_id);
}

TEST(Place, PartitionOfUnityDropsRoundOff) {
  std::vector<double> weights{0.3, 1e-17, 0.7 + 3e-13, -2e-16};
  make_partition_of_unity(weights);
  EXPECT_EQ(weights[1], 0.0);
  EXPECT_EQ(weights[3], 0.0);
  EXPECT_EQ(weights[0] + weights[2], 1.0);
}

}  // namespace
}  // namespace tenon::transfer

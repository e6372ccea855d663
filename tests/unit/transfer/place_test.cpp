// SPDX-License-Identifier: BSD-3-Clause
// The serial heart of transfer: weights of one point in one or a few elements.
#include "transfer/place.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "framework/mesh/shape_functions.hpp"

namespace tenon::transfer {
namespace {

ElementPacket element(ElementKind kind, std::initializer_list<Vec3> corners, GlobalId id = 0) {
  ElementPacket packet;
  std::copy(corners.begin(), corners.end(), packet.corners.begin());
  packet.kind = kind;
  packet.id = id;
  packet.item = static_cast<LocalIndex>(id);
  packet.owner = 0;
  packet.size = 2;
  return packet;
}

std::vector<ElementPacket> one_of_each() {
  return {
      element(ElementKind::hex8,
              {{0, 0, 0}, {1, 0.1, 0}, {1.1, 1, 0.1}, {0, 0.9, 0}, {0.1, 0, 1}, {1, 0, 0.8}, {1, 1.2, 1}, {0, 1, 1.1}}),
      element(ElementKind::tet4, {{0, 0, 0}, {1, 0.1, 0}, {0.2, 1, 0}, {0.1, 0.2, 1}}),
      element(ElementKind::wedge6, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.1}, {0, 0.1, 1}, {1, 0, 1.2}, {0.1, 1, 1}}),
      element(ElementKind::pyramid5, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1.1, 0}, {0.4, 0.5, 1}})};
}

double sum(const Placement& place) {
  return std::accumulate(place.weights.begin(), place.weights.end(), 0.0);
}

Vec3 weighted(const ElementPacket& e, const Placement& place) {
  Vec3 x{};
  for (std::size_t a = 0; a < e.corner_span().size(); ++a) x = x + place.weights[a] * e.corners[a];
  return x;
}

Placement inside(const ElementPacket& e, const Vec3& point) {
  std::vector<LocalIndex> candidates{0};
  return place_inside(std::span(&e, 1), candidates, point, {});
}

Placement nearest(const ElementPacket& e, const Vec3& point, bool extrapolate) {
  Box box;
  for (const Vec3& c : e.corner_span()) box.add(c);
  box.inflate(1e-8);
  return place_nearest(std::span(&e, 1), BoxTree(std::span(&box, 1)), point, 10.0, {1e-9, extrapolate});
}

TEST(Place, InnerPointHasPositiveWeightsThatReproduceIt) {
  for (const ElementPacket& e : one_of_each()) {
    const Vec3 point = map_to_space(e.kind, e.corner_span(), 0.7 * element_centre(e.kind));
    const Placement place = inside(e, point);
    ASSERT_EQ(place.element, 0) << topology(e.kind).name;
    EXPECT_FALSE(place.outside);
    EXPECT_NEAR(sum(place), 1.0, 2e-16);
    EXPECT_LT(norm(weighted(e, place) - point), 1e-15);
    for (const double w : place.weights) EXPECT_GE(w, 0.0);
  }
}

TEST(Place, CornerIsExactlyThatCorner) {
  for (const ElementPacket& e : one_of_each())
    for (std::size_t a = 0; a < e.corner_span().size(); ++a) {
      const Placement place = inside(e, e.corners[a]);
      ASSERT_EQ(place.element, 0) << topology(e.kind).name << " corner " << a;
      for (std::size_t b = 0; b < max_nodes; ++b) EXPECT_EQ(place.weights[b], a == b ? 1.0 : 0.0);
    }
}

TEST(Place, OutsideIsNotInside) {
  for (const ElementPacket& e : one_of_each()) EXPECT_EQ(inside(e, {-0.5, 0.3, 0.3}).element, no_id);
}

TEST(Place, SharedFaceGoesToTheSmallestId) {
  const std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  ElementPacket left = element(ElementKind::hex8, {x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7]}, 7);
  ElementPacket right = left;
  right.id = 4;
  for (Vec3& c : right.corners) c[0] += 1;
  for (const auto& order : {std::vector<LocalIndex>{0, 1}, std::vector<LocalIndex>{1, 0}}) {
    const std::vector<ElementPacket> both{left, right};
    std::vector<LocalIndex> candidates = order;
    EXPECT_EQ(place_inside(both, candidates, {1, 0.3, 0.6}, {}).element, 4);
    candidates = order;
    // Farther from the face than round-off: in the one that really holds it, although the other is within tolerance.
    EXPECT_EQ(place_inside(both, candidates, {1 - 1e-10, 0.3, 0.6}, {}).element, 7);
  }
}

TEST(Place, NearestHasNoNegativeWeightsAndTheTrueDistance) {
  for (const ElementPacket& e : one_of_each()) {
    const Vec3 point{0.3, 0.2, -0.25};
    const Placement place = nearest(e, point, false);
    ASSERT_EQ(place.element, 0);
    EXPECT_TRUE(place.outside);
    EXPECT_NEAR(sum(place), 1.0, 2e-16);
    for (const double w : place.weights) EXPECT_GE(w, 0.0);
    EXPECT_NEAR(norm(weighted(e, place) - point), place.distance, 1e-14);
  }
}

TEST(Place, ExtrapolationReproducesThePointHoweverFar) {
  for (const ElementPacket& e : one_of_each())
    for (const double away : {0.01, 0.4, 3.0}) {
      const Vec3 point{0.3, -away, 0.2};
      const Placement place = nearest(e, point, true);
      ASSERT_TRUE(place.outside);
      EXPECT_NEAR(sum(place), 1.0, 1e-15);
      EXPECT_LT(norm(weighted(e, place) - point), 1e-14 * (1 + away)) << topology(e.kind).name << " " << away;
    }
}

TEST(Place, BeyondReachIsNothing) {
  const ElementPacket e = one_of_each().front();
  Box box;
  for (const Vec3& c : e.corner_span()) box.add(c);
  EXPECT_EQ(place_nearest(std::span(&e, 1), BoxTree(std::span(&box, 1)), {-3, 0, 0}, 2.0, {}).element, no_id);
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

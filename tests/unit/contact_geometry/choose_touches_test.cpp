// SPDX-License-Identifier: BSD-3-Clause
// The choice among neighbouring faces: folds, corners, curved surfaces.
#include "components/contact_geometry/choose_touches.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tenon::contact {
namespace {

struct Surface {
  std::vector<FaceShape> faces;
  std::vector<std::array<GlobalId, 4>> nodes;
};

/// Two unit squares that meet in the edge x = 0 and rise by `left` and `right` radians on either side, upwards outward.
Surface fold(double left, double right) {
  const Vec3 a{-std::cos(left), 0, std::sin(left)}, b{std::cos(right), 0, std::sin(right)}, along{0, 1, 0};
  const Vec3 o{0, 0, 0};
  return {{{4, {a, o, along, a + along}}, {4, {o, b, b + along, along}}}, {{0, 1, 2, 3}, {1, 4, 5, 2}}};
}

struct Result {
  int count;
  std::array<Choice, most_touches> chosen;
};

Result choose(const Surface& surface, const Vec3& from, const Vec3& to, double clearance = 0, bool two_sided = false,
              double margin = 0.05) {
  std::vector<Touch> touches;
  std::vector<std::array<GlobalId, 4>> nodes;
  std::vector<GlobalId> ids;
  for (std::size_t i = 0; i < surface.faces.size(); ++i) {
    Touch touch;
    if (!touch_face(from, to, surface.faces[i], surface.faces[i], clearance, 0.2, two_sided, margin, touch)) continue;
    touches.push_back(touch);
    nodes.push_back(surface.nodes[i]);
    ids.push_back(static_cast<GlobalId>(i));
  }
  Result result;
  result.count = choose_touches(touches, nodes, ids, result.chosen);
  for (int i = 0; i < result.count; ++i) result.chosen[i].candidate = static_cast<int>(ids[result.chosen[i].candidate]);
  return result;
}

TEST(ChooseTouches, AConcaveFoldIsTouchedOnBothSides) {
  const Surface valley = fold(M_PI / 4, M_PI / 4);
  const Result r = choose(valley, {0.001, 0.5, 0.02}, {0.001, 0.5, 0.01});
  ASSERT_EQ(r.count, 2);
  EXPECT_EQ(r.chosen[0].candidate, 0);
  EXPECT_EQ(r.chosen[1].candidate, 1);
  EXPECT_LT(r.chosen[0].touch.normal[0] * r.chosen[1].touch.normal[0], 0.0);
  // Pressed into the bottom, and resting there with what a solution leaves.
  EXPECT_EQ(choose(valley, {0, 0.5, 1e-3}, {0, 0.5, -0.01}).count, 2);
  EXPECT_EQ(choose(valley, {0, 0.5, -1e-7}, {0, 0.5, -1e-4}).count, 2);
}

TEST(ChooseTouches, AConvexEdgeIsTouchedOnce) {
  const Surface ridge = fold(-M_PI / 4, -M_PI / 4);
  const Result above = choose(ridge, {0.0, 0.5, 0.03}, {0.0, 0.5, 0.01});
  ASSERT_EQ(above.count, 1);
  EXPECT_NEAR(above.chosen[0].touch.normal[2], 1.0, 1e-12);
  EXPECT_EQ(choose(ridge, {0.0, 0.5, 0.01}, {0.0, 0.5, -0.03}).count, 1);
  // Behind both sides: out where it is nearest.
  const Result inside = choose(ridge, {0.05, 0.5, -0.06}, {0.05, 0.5, -0.06});
  ASSERT_EQ(inside.count, 1);
  EXPECT_EQ(inside.chosen[0].candidate, 1);
}

TEST(ChooseTouches, ANodeThatSlidesAlongABlocksSideIsNotLiftedByItsTop) {
  // Top: z = 0, x < 0. Side: x = 0, z < 0.
  const Surface corner = fold(0.0, -M_PI / 2);
  for (const double gap : {1e-3, 1e-9, 0.0, -1e-9, -1e-3}) {
    const Result r = choose(corner, {gap, 0.5, -0.05}, {gap - 1e-3, 0.5, -0.05});
    ASSERT_EQ(r.count, 1) << gap;
    EXPECT_EQ(r.chosen[0].candidate, 1);
    EXPECT_NEAR(r.chosen[0].touch.normal[0], 1.0, 1e-12);
  }
}

TEST(ChooseTouches, OverAFacetedSurfaceTheNormalTurnsNoMoreThanTheFacets) {
  // A cylinder of radius 1 with facets of 10 degrees, over which a node slides.
  const double facet = M_PI / 18;
  Surface cylinder;
  for (int i = 0; i < 9; ++i) {
    const auto at = [&](int k, double y) { return Vec3{std::sin((k - 4) * facet), y, std::cos((k - 4) * facet)}; };
    cylinder.faces.push_back({4, {at(i, 0), at(i + 1, 0), at(i + 1, 1), at(i, 1)}});
    cylinder.nodes.push_back({2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
  }
  for (const double height : {0.01, 0.0, -0.002}) {
    Vec3 last{0, 0, 0};
    for (int step = 0; step <= 1000; ++step) {
      const double angle = (-3.0 + 6.0 * step / 1000) * facet;
      const Vec3 at{(1 + height) * std::sin(angle), 0.5, (1 + height) * std::cos(angle)};
      const Result r = choose(cylinder, at, at);
      ASSERT_EQ(r.count, 1) << height << " " << step;
      const Vec3 normal = r.chosen[0].touch.normal;
      if (step > 0) {
        EXPECT_GT(dot(normal, last), std::cos(1.01 * facet)) << height << " " << step;
      }
      EXPECT_GT(dot(normal, at), std::cos(1.01 * facet));
      last = normal;
    }
  }
}

TEST(ChooseTouches, AboveSharedEdgesAndCornersOfAFlatSurfaceThereIsOneTouch) {
  Surface flat;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) {
      const double x = i, y = j;
      flat.faces.push_back({4, {{{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}}}});
      flat.nodes.push_back({i + 3 * j, i + 1 + 3 * j, i + 4 + 3 * j, i + 3 + 3 * j});
    }
  for (const bool two_sided : {false, true})
    for (const Vec3& at : {Vec3{1, 0.5, 0}, Vec3{0.3, 1, 0}, Vec3{1, 1, 0}, Vec3{1 + 1e-13, 1 - 1e-13, 0}})
      for (const double end : {0.01, -0.01, -5.0}) {
        const Result r = choose(flat, at + Vec3{0, 0, 0.02}, at + Vec3{0, 0, end}, 0, two_sided);
        ASSERT_EQ(r.count, 1) << at[0] << " " << at[1] << " " << end;
        EXPECT_NEAR(r.chosen[0].touch.normal[2], 1.0, 1e-9);
        EXPECT_NEAR(r.chosen[0].touch.end_gap, end, 1e-9);
      }
}

TEST(ChooseTouches, TheInsideCornerOfABoxHasThreeSides) {
  Surface corner{{{4, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}},
                  {4, {{{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}}}},
                  {4, {{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}}}},
                 {{0, 1, 4, 2}, {0, 2, 6, 3}, {0, 3, 5, 1}}};
  EXPECT_EQ(choose(corner, {0.02, 0.02, 0.02}, {0.01, 0.01, 0.01}).count, 3);
  EXPECT_EQ(choose(corner, {0.02, 0.02, 0.02}, {-0.01, -0.01, -0.01}).count, 3);
}

TEST(ChooseTouches, KeepsTheFourSmallestGapsInTheOrderOfIds) {
  std::vector<Touch> touches(6);
  std::vector<std::array<GlobalId, 4>> nodes;
  std::vector<GlobalId> ids;
  const double gaps[6] = {0.5, -0.1, 0.5, -0.3, 0.2, 0.1};
  for (int i = 0; i < 6; ++i) {
    touches[i].end_gap = gaps[i];
    touches[i].inside = true;
    touches[i].weights = {0.25, 0.25, 0.25, 0.25};
    nodes.push_back({10 * i, 10 * i + 1, 10 * i + 2, 10 * i + 3});
    ids.push_back(i);
  }
  std::array<Choice, most_touches> chosen;
  ASSERT_EQ(choose_touches(touches, nodes, ids, chosen), 4);
  const int expected[4] = {1, 3, 4, 5};
  for (int i = 0; i < 4; ++i) EXPECT_EQ(chosen[i].candidate, expected[i]);
}

}  // namespace
}  // namespace tenon::contact

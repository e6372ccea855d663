// SPDX-License-Identifier: BSD-3-Clause
// Nothing gets into a closed box, through whichever face, edge or corner and at whichever speed.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "components/contact_geometry/choose_touches.hpp"
#include "tests/unit/contact_geometry/random_scenes.hpp"

namespace tenon::contact {
namespace {

struct Surface {
  std::vector<FaceShape> faces;
  std::vector<std::array<GlobalId, 4>> nodes;
  std::vector<GlobalId> ids;
};

/// The unit cube with irregular corners, of 6 quadrilaterals or 12 triangles.
Surface closed_box(bool triangles, Random& random, double irregular) {
  std::array<Vec3, 8> corner;
  for (int i = 0; i < 8; ++i)
    corner[i] = Vec3{i & 1 ? 1.0 : 0.0, i & 2 ? 1.0 : 0.0, i & 4 ? 1.0 : 0.0} + random.in_cube(irregular);
  constexpr int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  Surface surface;
  for (const auto& q : quads)
    if (triangles) {
      surface.faces.push_back({3, {corner[q[0]], corner[q[1]], corner[q[2]], {}}});
      surface.nodes.push_back({q[0], q[1], q[2], no_id});
      surface.faces.push_back({3, {corner[q[0]], corner[q[2]], corner[q[3]], {}}});
      surface.nodes.push_back({q[0], q[2], q[3], no_id});
    } else {
      surface.faces.push_back({4, {corner[q[0]], corner[q[1]], corner[q[2]], corner[q[3]]}});
      surface.nodes.push_back({q[0], q[1], q[2], q[3]});
    }
  for (std::size_t i = 0; i < surface.faces.size(); ++i) surface.ids.push_back(static_cast<GlobalId>(i));
  return surface;
}

/// A random place on the surface: on a face, an edge or a corner.
Vec3 aim(const Surface& surface, Random& random) {
  const FaceShape& face = surface.faces[random.below(static_cast<int>(surface.faces.size()))];
  const int kind = random.below(3), k = random.below(face.corners);
  if (kind == 0) return face.x[k];
  if (kind == 1) {
    const double s = random(0, 1);
    return face.x[k] + s * (face.x[(k + 1) % face.corners] - face.x[k]);
  }
  return place_on(face, random_place(random, face));
}

/// Is a constraint left that the node violates, and which keeps the side from which it came?
bool stopped(const Surface& surface, const Vec3& from, const Vec3& to, bool two_sided) {
  std::vector<Touch> touches;
  std::vector<std::array<GlobalId, 4>> nodes;
  std::vector<GlobalId> ids;
  for (std::size_t i = 0; i < surface.faces.size(); ++i) {
    Touch touch;
    if (!touch_face(from, to, surface.faces[i], surface.faces[i], 0.0, 0.2, two_sided, 0.01, touch)) continue;
    touches.push_back(touch);
    nodes.push_back(surface.nodes[i]);
    ids.push_back(surface.ids[i]);
  }
  std::array<Choice, most_touches> chosen;
  const int count = choose_touches(touches, nodes, ids, chosen);
  for (int i = 0; i < count; ++i)
    if (chosen[i].touch.end_gap < 0 && chosen[i].touch.gap > -1e-9) return true;
  return false;
}

void shoot(bool triangles, bool two_sided, double shortest, double longest, int shots, double irregular) {
  Random random(triangles ? 21 : 22);
  const Surface surface = closed_box(triangles, random, irregular);
  const Vec3 centre{0.5, 0.5, 0.5};
  int leaks = 0;
  for (int i = 0; i < shots; ++i) {
    const Vec3 target = aim(surface, random);
    // Towards the middle of the box, more or less, so that the target is where it enters.
    Vec3 inwards = centre + random.in_cube(0.3) - target;
    inwards = (1 / norm(inwards)) * inwards;
    const double outside = random(0.02, 0.98), length = random(shortest, longest);
    const Vec3 from = target - outside * length * inwards, to = target + (1 - outside) * length * inwards;
    if (!stopped(surface, from, to, two_sided)) ++leaks;
  }
  EXPECT_EQ(leaks, 0) << "of " << shots;
}

TEST(Leaks, NoFastShotEntersABoxOfTriangles) {
  shoot(true, false, 0.2, 20, 30000, 0.1);
}
TEST(Leaks, NoFastShotEntersABoxOfQuadrilaterals) {
  shoot(false, false, 0.2, 20, 30000, 0.0);
}
TEST(Leaks, NoFastShotEntersABoxOfWarpedFaces) {
  shoot(false, false, 0.2, 20, 10000, 0.1);
}
TEST(Leaks, NoFastShotEntersABoxOfShells) {
  shoot(true, true, 0.2, 20, 10000, 0.1);
  shoot(false, true, 0.2, 20, 10000, 0.1);
}
TEST(Leaks, NoSlowNodeEntersABox) {
  shoot(true, false, 1e-4, 0.1, 10000, 0.1);
  shoot(false, false, 1e-4, 0.1, 10000, 0.1);
}

}  // namespace
}  // namespace tenon::contact

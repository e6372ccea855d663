// SPDX-License-Identifier: BSD-3-Clause
#include "components/contact_geometry/face_touch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/contact_geometry/first_crossing.hpp"
#include "components/contact_geometry/patch.hpp"

namespace tenon::contact {
namespace {

// Travel in a step, relative to the face's width, up to which the foot of the end position is used.
constexpr double slow_travel = 0.1;
// Heights and distances below this share of the face's size are round-off.
constexpr double round_off = 1e-12;
// A node behind a solid's face and beside its rim by less than this share of its size is still behind it: what is left
// by an iterative solution, in a valley between two faces.
constexpr double valley = 1e-3;

using CornerPositions = std::array<Vec3, 4>;

/// Corners relative to the node: the node stands still at the origin.
struct Scene {
  int corners;
  CornerPositions start, end;
  double clearance, depth, margin;
  bool two_sided;
  double size;    // m, longest edge or diagonal at the end
  double width;   // m, twice the area over that
  double travel;  // m, of the fastest corner relative to the node
  bool fast;      // travels far against the face's width
};

/// Cheap, and never wrong: are the boxes of the two motions farther apart than `reach` along an axis?
bool boxes_apart(const Vec3& node0, const Vec3& node1, const FaceShape& face0, const FaceShape& face1, double reach) {
  const auto& x0 = face0.x;
  const auto& x1 = face1.x;
  const int last = face0.corners - 1;
  for (int c = 0; c < 3; ++c) {
    const double n0 = node0[c] - reach, n1 = node1[c] - reach, m0 = node0[c] + reach, m1 = node1[c] + reach;
    const double low0 = std::min(std::min(x0[0][c], x0[1][c]), std::min(x0[2][c], x0[last][c]));
    const double low1 = std::min(std::min(x1[0][c], x1[1][c]), std::min(x1[2][c], x1[last][c]));
    const double high0 = std::max(std::max(x0[0][c], x0[1][c]), std::max(x0[2][c], x0[last][c]));
    const double high1 = std::max(std::max(x1[0][c], x1[1][c]), std::max(x1[2][c], x1[last][c]));
    if ((low0 > m0 && low1 > m1) || (high0 < n0 && high1 < n1)) return true;
  }
  return false;
}

Vec3 weighted(const CornerPositions& x, const std::array<double, 4>& w, int corners) {
  Vec3 sum = w[0] * x[0];
  for (int i = 1; i < corners; ++i) sum = sum + w[i] * x[i];
  return sum;
}

/// Sizes, speed, and a second refusal: all of the motion on one side of a plane parallel to the face's.
bool measure(Scene& s) {
  double size2 = 0, travel2 = 0;
  Vec3 sum{0, 0, 0};
  for (int i = 0; i < s.corners; ++i) {
    const Vec3 step = s.end[i] - s.start[i];
    travel2 = std::max(travel2, dot(step, step));
    sum = sum + s.start[i] + s.end[i];
    for (int j = 0; j < i; ++j) {
      const Vec3 span = s.end[i] - s.end[j];
      size2 = std::max(size2, dot(span, span));
    }
  }
  if (!std::isfinite(sum[0] + sum[1] + sum[2] + travel2)) return false;
  const Vec3 normal = s.corners == 3 ? cross(s.end[1] - s.end[0], s.end[2] - s.end[0])
                                     : cross(s.end[2] - s.end[0], s.end[3] - s.end[1]);
  const double length = norm(normal);  // twice the area
  s.size = std::sqrt(size2);
  s.travel = std::sqrt(travel2);
  s.width = s.size > 0 ? length / s.size : 0.0;
  s.fast = !(s.travel <= slow_travel * s.width);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int i = 0; i < s.corners; ++i) {
    const double at0 = dot(normal, s.start[i]), at1 = dot(normal, s.end[i]);
    low = std::min({low, at0, at1});
    high = std::max({high, at0, at1});
  }
  const double reach = (s.clearance + s.margin) * length;
  const double behind = s.two_sided ? reach : std::max(reach, s.depth * length);
  return low <= behind && high >= -reach;
}

FaceShape shape(const Scene& s, const CornerPositions& x) {
  return {s.corners, x};
}

/// Fills in what follows from weights, normals and corners; false if it is out of reach at the end.
bool finish(const Scene& s, Touch& touch) {
  touch.from = -1.0 * weighted(s.start, touch.weights, s.corners);
  touch.to = -1.0 * weighted(s.end, touch.weights, s.corners);
  touch.gap = dot(touch.normal, touch.from) - s.clearance;
  touch.end_gap = dot(touch.normal, touch.to) - s.clearance;
  Vec3 sum = s.end[0];
  for (int i = 1; i < s.corners; ++i) sum = sum + s.end[i];
  touch.centre = (1.0 / s.corners) * sum;
  return touch.end_gap <= s.margin;
}

/// The crossing of two patches whose neighbouring corners do not coincide, with weights of all given corners.
bool cross_face(const Scene& s, std::array<double, 4>& weights, double& time) {
  Corners corners = distinct_corners(s.corners, s.start);
  if (corners.count < s.corners) {
    const Corners other = distinct_corners(s.corners, s.end);
    if (other.count != corners.count || other.index != corners.index) corners = {s.corners, {0, 1, 2, 3}};
  }
  const auto& k = corners.index;
  const Patch start = make_patch(corners.count, {s.start[k[0]], s.start[k[1]], s.start[k[2]], s.start[k[3]]});
  const Patch end = make_patch(corners.count, {s.end[k[0]], s.end[k[1]], s.end[k[2]], s.end[k[3]]});
  Crossing crossing;
  if (!first_crossing(start, end, !s.two_sided, crossing)) return false;
  const std::array<double, 4> w = corner_weights(corners.count == 3, crossing.xi, crossing.eta);
  weights = {0, 0, 0, 0};
  for (int i = 0; i < corners.count; ++i) weights[k[i]] = w[i];
  time = crossing.time;
  return true;
}

bool all_positive(const std::array<double, 4>& w, int corners) {
  for (int i = 0; i < corners; ++i)
    if (!(w[i] > 1e-9)) return false;
  return true;
}

/// Touch of a node that crosses the face: where it does, and on the side from which it comes.
bool crossing_touch(const Scene& s, const std::array<double, 4>& weights, double time, Touch& touch) {
  const Vec3 from = weighted(s.start, weights, s.corners), to = weighted(s.end, weights, s.corners);
  const Vec3 approach = to - from;  // of the face towards the node
  Vec3 normal = face_normal(shape(s, s.end), weights);
  CornerPositions then;
  for (int i = 0; i < 4; ++i) then[i] = s.start[i] + time * (s.end[i] - s.start[i]);
  const Vec3 normal_then = face_normal(shape(s, then), weights);
  double along = dot(approach, normal), along_then = dot(approach, normal_then);
  // The face may turn so much after a glancing crossing that the end's normal would take the other side.
  if (normal == Vec3{0, 0, 0} || along * along_then < 0 || dot(normal, normal_then) < 0) {
    normal = normal_then;
    along = along_then;
  }
  if (normal == Vec3{0, 0, 0}) return false;
  if (s.two_sided && (along < 0 || (along == 0 && dot(from, normal) > 0))) normal = -1.0 * normal;
  touch.weights = weights;
  touch.normal = touch.face_normal = normal;
  touch.inside = all_positive(weights, s.corners);
  touch.time = time;
  touch.beyond_rim = false;
  return finish(s, touch);
}

/// Where the node lies over the interior at the end, it did so at the start if it moved along the face by less than
/// this.
double room_to_rim(const Scene& s, const std::array<double, 4>& w) {
  const bool triangle = s.corners == 3;
  const double xi = xi_of(triangle, w), eta = eta_of(triangle, w);
  const double far = triangle ? w[0] : std::min(1 - xi, 1 - eta);
  return 0.25 * s.width * std::min(std::min(xi, eta), far);
}

enum class Start { front, behind, elsewhere };

/// Where the node starts against a solid's face: behind it by no more than its depth and not beside its rim, or in
/// front.
Start start_of(const Scene& s, ClosestPoint& foot) {
  foot = closest_point(shape(s, s.start), {0, 0, 0});
  const Vec3 normal = face_normal(shape(s, s.start), foot.weights);
  const double height = -dot(normal, foot.point);
  if (height > 0) return Start::front;
  if (foot.distance > s.depth + round_off * s.size) return Start::elsewhere;
  const Vec3 beside = foot.point + height * normal;
  return foot.inside || norm(beside) <= valley * s.size ? Start::behind : Start::elsewhere;
}

/// Touch of a node that does not cross the face, or so slowly that the foot of its end position is the right place.
/// `height0` and `height1`: of the node over the face at the foot, at start and end.
bool inside_touch(const Scene& s, const Vec3& normal, double height0, double height1, Touch& touch) {
  double side = 1;
  if (s.two_sided) {
    const bool on_surface = std::abs(height0) <= round_off * s.size;
    if (s.fast && !on_surface && height0 * height1 < 0) return false;  // it came round the rim
    side = on_surface ? (height1 > height0 ? -1.0 : 1.0) : (height0 > 0 ? 1.0 : -1.0);
    if (on_surface && s.fast) side = height1 >= 0 ? 1.0 : -1.0;
  }
  touch.normal = touch.face_normal = side * normal;
  return finish(s, touch);
}

/// The same with the foot on the rim. `from` and `to`: the node relative to the foot at start and end.
bool rim_touch(const Scene& s, const Vec3& normal, const Vec3& from, const Vec3& to, Touch& touch) {
  const double distance = norm(to), height0 = dot(normal, from), height1 = dot(normal, to);
  const bool on_rim = distance <= round_off * s.size;
  std::array<double, 4> weights;
  double time;
  if (s.two_sided) {
    const bool above = height0 > 0 || (height0 == 0 && height1 <= 0);
    touch.face_normal = above ? normal : -1.0 * normal;
    if (!on_rim && dot(from, to) > 0) {
      touch.normal = (1 / distance) * to;
      return finish(s, touch);
    }
    // It passed the rim: through the face, or over its rounded edge.
    if (!s.fast && cross_face(s, weights, time)) return crossing_touch(s, weights, time, touch);
    const double before = norm(from);
    touch.normal = before > round_off * s.size ? (1 / before) * from : touch.face_normal;
    return finish(s, touch);
  }
  touch.face_normal = normal;
  if (height1 > 0 && !on_rim) {
    touch.normal = (1 / distance) * to;
    return finish(s, touch);
  }
  touch.normal = normal;
  if (!finish(s, touch)) return false;
  const double beside = norm(to - height1 * normal), at_rim = valley * s.size;
  touch.beyond_rim = !(beside <= at_rim && height0 >= -s.depth) && (s.fast || !cross_face(s, weights, time));
  // It slides into a fold, or past the edge of a block: no farther than it travels.
  return !touch.beyond_rim || (s.travel <= s.width && beside <= s.travel + at_rim);
}

}  // namespace

bool touch_face(const Vec3& node0, const Vec3& node1, const FaceShape& face0, const FaceShape& face1, double clearance,
                double depth, bool two_sided, double margin, Touch& touch) {
  const double near = clearance + margin, reach = two_sided ? near : std::max(near, depth);
  if (boxes_apart(node0, node1, face0, face1, reach)) return false;
  Scene s{face0.corners, {}, {}, clearance, depth, margin, two_sided, 0, 0, 0, false};
  for (int i = 0; i < s.corners; ++i) {
    s.start[i] = face0.x[i] - node0;
    s.end[i] = face1.x[i] - node1;
  }
  if (!measure(s)) return false;

  std::array<double, 4> weights;
  double time;
  if (s.fast && cross_face(s, weights, time)) return crossing_touch(s, weights, time, touch);

  ClosestPoint foot = closest_point(shape(s, s.end), {0, 0, 0});
  const bool out_of_reach = foot.distance > near;
  if (out_of_reach && two_sided) return false;
  Vec3 normal = face_normal(shape(s, s.end), foot.weights);
  if (normal == Vec3{0, 0, 0}) return false;
  Vec3 from = -1.0 * weighted(s.start, foot.weights, s.corners), to = -1.0 * foot.point;
  double height0 = dot(normal, from), height1 = dot(normal, to);
  touch.time = 1;
  touch.beyond_rim = false;
  if (!two_sided && (height0 < 0 || (s.fast && height1 < 0))) {
    // Behind a solid's face: it belongs to the face only if it has been there from the start, or comes from the front
    // (a warped face's normal is another at the start).
    const bool clearly = !s.fast && foot.inside && -height0 <= std::min(depth, 0.1 * s.width) &&
                         norm(from - height0 * normal) <= room_to_rim(s, foot.weights);
    ClosestPoint first{};
    const Start start = clearly ? Start::behind : start_of(s, first);
    if (start == Start::elsewhere || (start == Start::front && s.fast && foot.inside)) return false;
    if (start == Start::behind && s.fast) {
      foot = first;
      normal = face_normal(shape(s, s.end), foot.weights);
      if (normal == Vec3{0, 0, 0}) return false;
    }
    touch.weights = foot.weights;
    touch.inside = foot.inside;
    touch.normal = touch.face_normal = normal;
    if (!foot.inside && start == Start::front) return rim_touch(s, normal, from, to, touch);
    if (!foot.inside && !s.fast && !first.inside) return rim_touch(s, normal, from, to, touch);
    return finish(s, touch);
  }
  if (out_of_reach && height1 > 0) return false;
  touch.weights = foot.weights;
  touch.inside = foot.inside;
  return foot.inside ? inside_touch(s, normal, height0, height1, touch) : rim_touch(s, normal, from, to, touch);
}

}  // namespace tenon::contact

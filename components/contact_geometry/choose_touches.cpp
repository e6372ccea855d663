// SPDX-License-Identifier: BSD-3-Clause
#include "components/contact_geometry/choose_touches.hpp"

#include <algorithm>
#include <bitset>

namespace tenon::contact {
namespace {

using FaceNodes = std::array<GlobalId, 4>;

// Sine of the angle between two faces up to which they are flat to each other.
constexpr double flat = 0.02;
// Concave folds of less than 30 degrees are kept away from one face at a time.
constexpr double nearly_parallel = 0.866;

bool has(const FaceNodes& nodes, GlobalId id) {
  return std::find(nodes.begin(), nodes.end(), id) != nodes.end();
}

bool share_corner(const FaceNodes& a, const FaceNodes& b) {
  for (const GlobalId id : a)
    if (id != no_id && has(b, id)) return true;
  return false;
}

/// The foot of `touch` lies on a corner or an edge that belongs to the other face, too.
bool foot_on_shared_rim(const Touch& touch, const FaceNodes& nodes, const FaceNodes& other) {
  if (touch.inside) return false;
  for (int i = 0; i < 4; ++i)
    if (touch.weights[i] > 1e-9 && !has(other, nodes[i])) return false;
  return true;
}

/// Height of b's centre over a's face, as the sine of an angle.
double rise(const Touch& a, const Touch& b) {
  const Vec3 to = b.centre - a.foot;
  const double length = norm(to);
  return length > 0 ? dot(to, a.face_normal) / length : 0.0;
}

/// Is `a` to be preferred where only one can stay? Ties go to the first.
bool nearer(const Touch& a, const Touch& b) {
  if (a.inside != b.inside) return a.inside;
  return std::abs(a.end_gap) <= std::abs(b.end_gap);
}

/// Round a convex edge: that which is crossed last, or which the node is behind least.
bool entered_through(const Touch& a, const Touch& b) {
  if (!(a.gap > 0 && b.gap > 0)) return a.gap != b.gap ? a.gap > b.gap : nearer(a, b);
  const bool crosses_a = a.end_gap < 0, crosses_b = b.end_gap < 0;
  if (!crosses_a || !crosses_b) return crosses_a == crosses_b ? nearer(a, b) : crosses_b;
  // Times gap / (gap - end_gap) without division.
  const double left = a.gap * (b.gap - b.end_gap), right = b.gap * (a.gap - a.end_gap);
  return left != right ? left > right : nearer(a, b);
}

enum class Keep { both, first, second };

/// Two touches of faces that share a corner, the first with the smaller id.
Keep compare(const Touch& a, const Touch& b, bool same_rim) {
  const double alike = dot(a.normal, b.normal);
  if (same_rim && alike > nearly_parallel) return nearer(a, b) ? Keep::first : Keep::second;
  const double over_a = rise(a, b), over_b = rise(b, a);
  const bool above_a = over_a > flat, above_b = over_b > flat, below_a = over_a < -flat, below_b = over_b < -flat;
  if ((above_a && below_b) || (below_a && above_b) || dot(a.face_normal, b.face_normal) < -nearly_parallel) {
    if (a.time != b.time) return a.time < b.time ? Keep::first : Keep::second;
    return nearer(a, b) ? Keep::first : Keep::second;
  }
  if (below_a || below_b) return entered_through(a, b) ? Keep::first : Keep::second;
  if (above_a || above_b) {
    if (alike <= nearly_parallel) return Keep::both;
    return a.end_gap <= b.end_gap ? Keep::first : Keep::second;
  }
  return nearer(a, b) ? Keep::first : Keep::second;
}

}  // namespace

int choose_touches(std::span<const Touch> touches, std::span<const FaceNodes> face_nodes,
                   std::span<const GlobalId> face_ids, std::span<Choice> chosen) {
  const int count = std::min(static_cast<int>(touches.size()), most_candidates);
  std::bitset<most_candidates> dropped;
  // Rims first, against all others: what lies beyond a rim must not outlive the face that it belongs to.
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count && !dropped[i]; ++j) {
      if (i == j || touches[j].time > touches[i].time || !foot_on_shared_rim(touches[i], face_nodes[i], face_nodes[j]))
        continue;
      if (!foot_on_shared_rim(touches[j], face_nodes[j], face_nodes[i])) dropped[i] = true;
    }
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count && !dropped[i]; ++j) {
      if (dropped[j] || !share_corner(face_nodes[i], face_nodes[j])) continue;
      const bool same_rim = foot_on_shared_rim(touches[i], face_nodes[i], face_nodes[j]) &&
                            foot_on_shared_rim(touches[j], face_nodes[j], face_nodes[i]);
      const Keep keep = compare(touches[i], touches[j], same_rim);
      if (keep == Keep::first) dropped[j] = true;
      if (keep == Keep::second) dropped[i] = true;
    }
  const int room = std::min(most_touches, static_cast<int>(chosen.size()));
  while (count - static_cast<int>(dropped.count()) > room) {
    // Ties go to the smaller id: the last of the largest gaps leaves.
    int worst = -1;
    for (int i = 0; i < count; ++i)
      if (!dropped[i] && (worst < 0 || touches[i].end_gap >= touches[worst].end_gap)) worst = i;
    dropped[worst] = true;
  }
  int kept = 0;
  for (int i = 0; i < count; ++i)
    if (!dropped[i]) chosen[kept++] = {i, touches[i]};
  return kept;
}

}  // namespace tenon::contact

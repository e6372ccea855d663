// SPDX-License-Identifier: BSD-3-Clause
#include "components/contact_geometry/choose_touches.hpp"

#include <algorithm>
#include <bitset>

namespace tenon::contact {
namespace {

using FaceNodes = std::array<GlobalId, 4>;

// Sine of the angle between two faces up to which they are flat to each other.
constexpr double flat_sine = 0.02;
// Concave folds of less than 15 degrees are kept away from one face at a time.
constexpr double nearly_parallel = 0.966;

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
  const Vec3 to = b.centre + a.to;
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

enum class Fold { none, convex, concave, opposed };

/// How the second face lies to the first, seen from the sides on which the node is.
Fold fold(const Touch& a, const Touch& b) {
  const double over_a = rise(a, b), over_b = rise(b, a);
  const bool above = over_a > flat_sine || over_b > flat_sine, below = over_a < -flat_sine || over_b < -flat_sine;
  if ((above && below) || dot(a.face_normal, b.face_normal) < -nearly_parallel) return Fold::opposed;
  return above ? Fold::concave : below ? Fold::convex : Fold::none;
}

/// In a concave fold there is nothing round which a normal could turn.
void take_face_normal(Touch& touch) {
  const double clearance = dot(touch.normal, touch.to) - touch.end_gap;
  touch.normal = touch.face_normal;
  touch.gap = dot(touch.normal, touch.from) - clearance;
  touch.end_gap = dot(touch.normal, touch.to) - clearance;
}

enum class Keep { both, first, second };

/// Two touches of faces that share a corner, the first with the smaller id. `rim_a`: a's foot is on a rim that b
/// shares.
Keep compare(Touch& a, Touch& b, Fold between, bool rim_a, bool rim_b) {
  const auto only = [](bool first) { return first ? Keep::first : Keep::second; };
  if (between == Fold::opposed) return only(a.time != b.time ? a.time < b.time : nearer(a, b));
  if (between == Fold::concave) {
    if (rim_a) take_face_normal(a);
    if (rim_b) take_face_normal(b);
    if (dot(a.normal, b.normal) <= nearly_parallel) return Keep::both;
    if (a.beyond_rim != b.beyond_rim) return only(b.beyond_rim);
    return only(a.end_gap <= b.end_gap);
  }
  if (a.beyond_rim != b.beyond_rim) return only(b.beyond_rim);
  if (rim_a != rim_b && a.time == b.time) return only(rim_b);
  if (rim_a && rim_b && dot(a.normal, b.normal) > nearly_parallel) return only(nearer(a, b));
  return only(between == Fold::convex ? entered_through(a, b) : nearer(a, b));
}

}  // namespace

int choose_touches(std::span<const Touch> touches, std::span<const FaceNodes> face_nodes,
                   std::span<const GlobalId> face_ids, std::span<Choice> chosen) {
  const int count = std::min(static_cast<int>(touches.size()), most_candidates);
  std::array<Touch, most_candidates> kept;
  std::bitset<most_candidates> dropped;
  const auto shared_rim = [&](int i, int j) { return foot_on_shared_rim(touches[i], face_nodes[i], face_nodes[j]); };
  // What lies beyond a rim counts beside a neighbour alone, and only if that is not the one to which the node belongs.
  for (int i = 0; i < count; ++i) {
    kept[i] = touches[i];
    bool neighbour = false;
    for (int j = 0; j < count && !dropped[i]; ++j) {
      if (i == j || !shared_rim(i, j)) continue;
      const bool concave = fold(touches[i], touches[j]) == Fold::concave;
      neighbour |= concave || !touches[j].beyond_rim;
      if (touches[j].time <= touches[i].time && !shared_rim(j, i) && !concave) dropped[i] = true;
    }
    if (touches[i].beyond_rim && !neighbour) dropped[i] = true;
  }
  // Concave folds before the others: what is round a convex edge is on the far side of the whole fold.
  for (const bool concave : {true, false})
    for (int i = 0; i < count; ++i)
      for (int j = i + 1; j < count && !dropped[i]; ++j) {
        if (dropped[j] || !share_corner(face_nodes[i], face_nodes[j])) continue;
        const Fold between = fold(touches[i], touches[j]);
        if ((between == Fold::concave) != concave) continue;
        const Keep keep = compare(kept[i], kept[j], between, shared_rim(i, j), shared_rim(j, i));
        if (keep == Keep::first) dropped[j] = true;
        if (keep == Keep::second) dropped[i] = true;
      }
  const int room = std::min(most_touches, static_cast<int>(chosen.size()));
  while (count - static_cast<int>(dropped.count()) > room) {
    // Ties go to the smaller id: the last of the largest gaps leaves.
    int worst = -1;
    for (int i = 0; i < count; ++i)
      if (!dropped[i] && (worst < 0 || kept[i].end_gap >= kept[worst].end_gap)) worst = i;
    dropped[worst] = true;
  }
  int choices = 0;
  for (int i = 0; i < count; ++i)
    if (!dropped[i]) chosen[choices++] = {i, kept[i]};
  return choices;
}

}  // namespace tenon::contact

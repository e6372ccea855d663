// SPDX-License-Identifier: BSD-3-Clause
// Differences between points of two edges fill a parallelogram; the edges touch where it contains the origin. Its
// closest point and its first crossing are those of a face.
#include "components/contact_geometry/edge_touch.hpp"

#include <algorithm>
#include <cmath>

#include "components/contact_geometry/closest_point.hpp"
#include "components/contact_geometry/first_crossing.hpp"

namespace tenon::contact {
namespace {

constexpr double slow_travel = 0.1;  // against the shorter edge
constexpr double parallel_sine = 0.02;
constexpr double flat_edge = 0.999;
// How far a direction of contact may leave the cone of an edge's normals, as a cosine.
constexpr double cone_slack = 0.05;
constexpr double round_off = 1e-12;

/// second - first, at xi along the first and eta along the second edge.
std::array<Vec3, 4> differences(const EdgeShape& first, const EdgeShape& second) {
  return {second.x[0] - first.x[0], second.x[0] - first.x[1], second.x[1] - first.x[1], second.x[1] - first.x[0]};
}

bool apart(const std::array<Vec3, 4>& start, const std::array<Vec3, 4>& end, double reach) {
  for (int c = 0; c < 3; ++c) {
    double low = start[0][c], high = low;
    for (int i = 0; i < 4; ++i) {
      low = std::min({low, start[i][c], end[i][c]});
      high = std::max({high, start[i][c], end[i][c]});
    }
    if (!(low <= reach && high >= -reach)) return true;
  }
  return false;
}

/// May this edge be touched along `normal` (from the edge outwards)?
bool in_cone(const Vec3& outward, const Vec3& normal) {
  const double length2 = dot(outward, outward);
  return length2 == 0 || dot(outward, normal) >= length2 - cone_slack;
}

}  // namespace

bool touch_edges(const EdgeShape& first0, const EdgeShape& first1, const EdgeShape& second0, const EdgeShape& second1,
                 const Vec3& outward_first, const Vec3& outward_second, double clearance, double depth, double margin,
                 EdgeTouch& touch) {
  const std::array<Vec3, 4> start = differences(first0, second0), end = differences(first1, second1);
  if (apart(start, end, std::max(clearance + margin, depth))) return false;
  if (dot(outward_first, outward_first) > flat_edge * flat_edge ||
      dot(outward_second, outward_second) > flat_edge * flat_edge)
    return false;
  double travel2 = 0, sum = 0;
  for (int i = 0; i < 4; ++i) {
    const Vec3 step = end[i] - start[i];
    travel2 = std::max(travel2, dot(step, step));
    for (int c = 0; c < 3; ++c) sum += start[i][c] + end[i][c];
  }
  if (!std::isfinite(sum + travel2)) return false;
  const Patch patch0 = make_patch(4, start), patch1 = make_patch(4, end);
  const Vec3 along = patch1.normal(0.5, 0.5);
  const double first_length = norm(patch1.a), second_length = norm(patch1.b), length = norm(along);
  if (!(length > parallel_sine * first_length * second_length)) return false;
  const double size = std::max(first_length, second_length);
  const bool fast = std::sqrt(travel2) > slow_travel * std::min(first_length, second_length);
  Vec3 normal = (1 / length) * along;

  // Solids: away from the second edge's body and into the first's.
  const Vec3 outward = outward_second - outward_first;
  const bool oriented = dot(outward, outward) > 0;
  if (oriented && dot(outward, normal) < 0) normal = -1.0 * normal;
  if (!in_cone(outward_second, normal) || !in_cone(outward_first, -1.0 * normal)) return false;

  Crossing crossing;
  const bool crosses = fast && first_crossing(patch0, patch1, false, crossing);
  if (crosses) {
    touch.first = crossing.xi;
    touch.second = crossing.eta;
  } else {
    const ClosestPoint foot = closest_point({4, end}, {0, 0, 0});
    if (!foot.inside) return false;
    touch.first = xi_of(false, foot.weights);
    touch.second = eta_of(false, foot.weights);
  }
  if (!(touch.first > 0 && touch.first < 1 && touch.second > 0 && touch.second < 1)) return false;
  double from = -dot(normal, patch0.at(touch.first, touch.second));
  double to = -dot(normal, patch1.at(touch.first, touch.second));
  const double zero = round_off * size;
  bool other_side = false;
  if (!oriented) {
    // The side of the start; from the very edge, that opposite to the motion.
    if (fast && !crosses && from * to < 0 && std::abs(from) > zero) return false;
    other_side = std::abs(from) > zero ? from < 0 : crosses || !fast ? to > from : to < 0;
    if (crosses && std::abs(to - from) > zero) other_side = to > from;
  } else if (fast && to < 0 && from > zero && !crosses) {
    return false;
  } else if (crosses && to > from) {
    return false;
  }
  if (other_side) {
    normal = -1.0 * normal;
    from = -from;
    to = -to;
  }
  touch.normal = normal;
  touch.gap = from - clearance;
  touch.end_gap = to - clearance;
  return from >= -depth - zero && touch.end_gap <= margin;
}

}  // namespace tenon::contact

// SPDX-License-Identifier: BSD-3-Clause
// The nearest point of an element: the point itself if it is inside a solid, else the nearest over the element's sides.
#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/base/box.hpp"
#include "framework/mesh/curved_face.hpp"
#include "framework/mesh/shape_functions.hpp"

namespace tenon {

namespace {

using Vec2 = std::array<double, 2>;

/// Parameter in [0, 1] of the point of the segment a, a + d nearest to the origin.
double on_segment(const Vec3& a, const Vec3& d) {
  const double length = dot(d, d);
  return length > 0 ? std::clamp(-dot(a, d) / length, 0.0, 1.0) : 0.0;
}

/// Weights of the corners of a triangle at its point nearest to the origin [Eri05, section 5.1.5, recast]: the foot of
/// the perpendicular if that is inside, else the best of the three edges.
Vec3 on_triangle(const std::array<Vec3, 3>& p) {
  const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0], normal = cross(e1, e2);
  const double area = dot(normal, normal);
  if (area > 0) {
    double w1 = dot(cross(e2, p[0]), normal) / area, w2 = dot(cross(p[0], e1), normal) / area;
    const Vec3 foot = p[0] + (w1 * e1 + w2 * e2);  // once more from there, for slivers
    w1 += dot(cross(e2, foot), normal) / area, w2 += dot(cross(foot, e1), normal) / area;
    if (w1 >= 0 && w2 >= 0 && w1 + w2 <= 1) return {1 - w1 - w2, w1, w2};
  }
  Vec3 best{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = (i + 1) % 3;
    const double t = on_segment(p[i], p[k] - p[i]);
    const Vec3 foot = p[i] + t * (p[k] - p[i]);
    if (const double d = dot(foot, foot); d < least) {
      least = d;
      best = {};
      best[i] = 1 - t, best[k] = t;
    }
  }
  return best;
}

/// Bilinear patch c + u x + v y + u v xy over [-1, 1]^2, seen from the point: f = |.|^2 / 2 is to be least.
class Patch {
 public:
  explicit Patch(const std::array<Vec3, 4>& p)
      : c_(0.25 * (p[0] + p[1] + p[2] + p[3])),
        x_(0.25 * (p[1] - p[0] + (p[2] - p[3]))),
        y_(0.25 * (p[3] - p[0] + (p[2] - p[1]))),
        xy_(0.25 * (p[0] - p[1] + (p[2] - p[3]))) {}

  Vec3 position(const Vec2& s) const { return c_ + s[0] * x_ + s[1] * (y_ + s[0] * xy_); }
  double half_square(const Vec2& s) const {
    const Vec3 r = position(s);
    return 0.5 * dot(r, r);
  }

  /// The least over a 5 x 5 lattice picks the valleys; a descent ends in the bottom of each.
  Vec2 nearest() const {
    constexpr int n = 5;
    std::array<std::array<double, n>, n> f;
    const auto place = [](int i, int k) { return Vec2{0.5 * i - 1, 0.5 * k - 1}; };
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) f[i][k] = half_square(place(i, k));
    const auto least_around = [&](int i, int k) {
      for (int a = std::max(i - 1, 0); a <= std::min(i + 1, n - 1); ++a)
        for (int b = std::max(k - 1, 0); b <= std::min(k + 1, n - 1); ++b)
          if (f[a][b] < f[i][k]) return false;
      return true;
    };
    Vec2 best{};
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) {
        if (!least_around(i, k)) continue;
        const Vec2 s = descend(place(i, k));
        if (const double value = half_square(s); value < least) least = value, best = s;
      }
    return best;
  }

 private:
  /// Projected Newton [Ber82]: variables held at a bound with the gradient pushing outwards are fixed, the rest take a
  /// Newton step (Gauss-Newton where the Hessian is not positive), clipped and halved until f falls enough.
  Vec2 descend(Vec2 s) const {
    for (int i = 0; i < 50; ++i) {
      const Vec3 r = position(s), ru = x_ + s[1] * xy_, rv = y_ + s[0] * xy_;
      const Vec2 g{dot(r, ru), dot(r, rv)};
      const auto held = [&](std::size_t k) { return (s[k] <= -1 && g[k] >= 0) || (s[k] >= 1 && g[k] <= 0); };
      const Vec2 step = newton_step(g, r, ru, rv, held(0), held(1));
      const double f = 0.5 * dot(r, r);
      double damp = 1;
      Vec2 next = s;
      bool fell = false;
      for (int halving = 0; halving < 30 && !fell; ++halving, damp *= 0.5) {
        for (std::size_t k = 0; k < 2; ++k) next[k] = std::clamp(s[k] - damp * step[k], -1.0, 1.0);
        fell = half_square(next) <= f - 1e-4 * (g[0] * (s[0] - next[0]) + g[1] * (s[1] - next[1])) && next != s;
      }
      const double moved = std::max(std::abs(next[0] - s[0]), std::abs(next[1] - s[1]));
      if (!fell) break;
      s = next;
      if (moved < 1e-14) break;
    }
    return polished(s);
  }

  /// Falls of f end where they are round-off of f, which leaves the square root of round-off in s; the last steps of
  /// Newton go by the gradient alone.
  Vec2 polished(Vec2 s) const {
    for (int i = 0; i < 4; ++i) {
      const Vec3 r = position(s), ru = x_ + s[1] * xy_, rv = y_ + s[0] * xy_;
      const Vec2 g{dot(r, ru), dot(r, rv)};
      const auto held = [&](std::size_t k) { return (s[k] <= -1 && g[k] >= 0) || (s[k] >= 1 && g[k] <= 0); };
      const Vec2 step = newton_step(g, r, ru, rv, held(0), held(1));
      const double length = std::max(std::abs(step[0]), std::abs(step[1]));
      if (!(length < 1e-6) || length < 1e-16) break;
      for (std::size_t k = 0; k < 2; ++k) s[k] = std::clamp(s[k] - step[k], -1.0, 1.0);
    }
    return s;
  }

  Vec2 newton_step(const Vec2& g, const Vec3& r, const Vec3& ru, const Vec3& rv, bool held_u, bool held_v) const {
    // Along one variable the patch is straight, so the second derivative is that of Gauss-Newton.
    const double huu = dot(ru, ru), hvv = dot(rv, rv), gauss_newton = dot(ru, rv);
    const auto along = [](double gradient, double curvature) { return curvature > 0 ? gradient / curvature : 0.0; };
    if (held_u || held_v) return {held_u ? 0.0 : along(g[0], huu), held_v ? 0.0 : along(g[1], hvv)};
    for (const double huv : {gauss_newton + dot(r, xy_), gauss_newton}) {
      const double determinant = huu * hvv - huv * huv;
      if (determinant > 1e-10 * huu * hvv)
        return {(hvv * g[0] - huv * g[1]) / determinant, (huu * g[1] - huv * g[0]) / determinant};
    }
    return {along(g[0], huu), along(g[1], hvv)};
  }

  Vec3 c_, x_, y_, xy_;
};

/// Weights of the corners of a side at its point nearest to the origin.
std::array<double, max_side_nodes> on_side(const std::array<Vec3, max_side_nodes>& corner, int nodes) {
  if (nodes == 3) {
    const Vec3 w = on_triangle({corner[0], corner[1], corner[2]});
    return {w[0], w[1], w[2], 0};
  }
  const Vec2 s = Patch(corner).nearest();
  std::array<double, max_side_nodes> weight;
  shape_values(ElementKind::quad4, {s[0], s[1], 0}, weight);
  return weight;
}

/// One side as the point sees it.
struct SeenSide {
  std::size_t side;
  std::array<Vec3, max_side_nodes> corner;
  double at_least;  ///< distance to the box of its corners; the side lies within their hull
};

/// Sides by ascending `at_least`, so that the first often settles the search; equal ones in the order of the table.
/// A surface element has one.
std::size_t see_sides(const Topology& t, std::span<const Vec3> corners, const Vec3& point,
                      std::array<SeenSide, max_sides>& sides) {
  const std::size_t count = t.dimension == 2 ? 1 : static_cast<std::size_t>(t.sides);
  for (std::size_t s = 0; s < count; ++s) {
    SeenSide seen{s, {}, 0};
    Box box;
    for (std::size_t i = 0; i < static_cast<std::size_t>(t.side_nodes[s]); ++i) {
      seen.corner[i] = corners[static_cast<std::size_t>(t.side[s][i])] - point;
      box.add(seen.corner[i]);
    }
    seen.at_least = box.distance({0, 0, 0});
    std::size_t k = s;
    for (; k > 0 && seen.at_least < sides[k - 1].at_least; --k) sides[k] = sides[k - 1];
    sides[k] = seen;
  }
  return count;
}

}  // namespace

NearestPoint nearest_point(ElementKind kind, std::span<const Vec3> corners, const Vec3& point) {
  const InverseMap inside = inverse_map(kind, corners, point);
  if (inside.converged && overshoot(kind, inside.xi) == 0) return {inside.xi, 0.0};

  if (!middle_nodes(kind).empty()) return nearest_on_curved_sides(kind, corners, point);

  const Topology& t = topology(kind);
  const std::span<const Vec3> reference = local_nodes(kind);
  NearestPoint best{element_centre(kind), std::numeric_limits<double>::infinity()};
  std::array<SeenSide, max_sides> sides{};
  const std::size_t count = see_sides(t, corners, point, sides);
  for (std::size_t k = 0; k < count && sides[k].at_least <= best.distance; ++k) {
    const std::array<double, max_side_nodes> weight = on_side(sides[k].corner, t.side_nodes[sides[k].side]);
    Vec3 away{}, xi{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(t.side_nodes[sides[k].side]); ++i) {
      away = away + weight[i] * sides[k].corner[i];
      xi = xi + weight[i] * reference[static_cast<std::size_t>(t.side[sides[k].side][i])];
    }
    if (const double distance = norm(away); distance < best.distance) best = {xi, distance};
  }
  return best;
}

}  // namespace tenon

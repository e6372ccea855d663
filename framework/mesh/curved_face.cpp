// SPDX-License-Identifier: BSD-3-Clause
#include "framework/mesh/curved_face.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenon {

namespace {

using Vec2 = std::array<double, 2>;

double dot(const Vec2& a, const Vec2& b) {
  return a[0] * b[0] + a[1] * b[1];
}

/// n . s + d >= 0 within the face.
struct Bound {
  Vec2 n;
  double d;
  double room(const Vec2& s) const { return dot(n, s) + d; }
};

/// A side with curved edges, seen from the point: P(u, v), of which f = |P|^2 / 2 is to be least over [-1, 1]^2, or
/// over the triangle u, v >= 0, u + v <= 1.
class CurvedFace {
 public:
  /// `corner` and, between it and the next one, `middle`.
  CurvedFace(std::span<const Vec3> corner, std::span<const Vec3> middle) : square_(corner.size() == 4) {
    if (square_)
      make_square(corner, middle);
    else
      make_triangle(corner, middle);
  }

  Vec3 position(const Vec2& s) const {
    const double u = s[0], v = s[1];
    return c_[0] + u * (c_[1] + u * c_[3] + v * (c_[4] + u * c_[6] + v * c_[7])) + v * (c_[2] + v * c_[5]);
  }
  double half_square(const Vec2& s) const {
    const Vec3 p = position(s);
    return 0.5 * tenon::dot(p, p);
  }

  /// The least places of a lattice pick the valleys; a descent ends in the bottom of each.
  Vec2 nearest() const {
    constexpr int n = 9;
    std::array<std::array<double, n>, n> f;
    const auto inside = [&](int i, int k) { return i >= 0 && k >= 0 && (square_ ? i < n && k < n : i + k < n); };
    const auto place = [&](int i, int k) {
      const double u = i / (n - 1.0), v = k / (n - 1.0);
      return square_ ? Vec2{2 * u - 1, 2 * v - 1} : Vec2{u, v};
    };
    const auto value = [&](int i, int k) -> double& {
      return f[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)];
    };
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k)
        if (inside(i, k)) value(i, k) = half_square(place(i, k));
    const auto least_around = [&](int i, int k) {
      for (int a = i - 1; a <= i + 1; ++a)
        for (int b = k - 1; b <= k + 1; ++b)
          if (inside(a, b) && value(a, b) < value(i, k)) return false;
      return true;
    };
    Vec2 best{};
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) {
        if (!inside(i, k) || !least_around(i, k)) continue;
        const Vec2 s = descend(place(i, k));
        if (const double here = half_square(s); here < least) least = here, best = s;
      }
    return best;
  }

  /// Weights of the corners that give the same place on the plane reference side.
  std::array<double, 4> corner_weights(const Vec2& s) const {
    std::array<double, 4> weight{};
    shape_values(square_ ? ElementKind::quad4 : ElementKind::tri3, {s[0], s[1], 0}, weight);
    return weight;
  }

 private:
  // Coefficients of 1, u, v, u^2, uv, v^2, u^2 v, u v^2.

  void make_square(std::span<const Vec3> corner, std::span<const Vec3> middle) {
    constexpr std::array<Vec2, 4> at{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    const auto add = [this](const std::array<double, 8>& shape, const Vec3& x) {
      for (std::size_t t = 0; t < 8; ++t) c_[t] = c_[t] + shape[t] * x;
    };
    for (std::size_t i = 0; i < 4; ++i) {
      const double u = at[i][0], v = at[i][1], q = 0.25, h = 0.5;
      add({-q, 0, 0, q, q * u * v, q, q * v, q * u}, corner[i]);
      // Middle nodes lie below, right, above, left.
      const double a = i == 1 ? 1 : -1, b = i == 0 ? -1 : 1;
      if (i % 2 == 0)
        add({h, 0, h * b, -h, 0, 0, -h * b, 0}, middle[i]);
      else
        add({h, h * a, 0, 0, 0, -h, 0, -h * a}, middle[i]);
    }
  }
  void make_triangle(std::span<const Vec3> x, std::span<const Vec3> m) {
    c_[0] = x[0];
    c_[1] = 4.0 * m[0] - 3.0 * x[0] - x[1];
    c_[2] = 4.0 * m[2] - 3.0 * x[0] - x[2];
    c_[3] = 2.0 * (x[0] + x[1]) - 4.0 * m[0];
    c_[4] = 4.0 * (x[0] - m[0] + (m[1] - m[2]));
    c_[5] = 2.0 * (x[0] + x[2]) - 4.0 * m[2];
  }

  std::span<const Bound> bounds() const {
    static constexpr std::array<Bound, 4> of_square{{{{1, 0}, 1}, {{-1, 0}, 1}, {{0, 1}, 1}, {{0, -1}, 1}}};
    static constexpr std::array<Bound, 3> of_triangle{{{{1, 0}, 0}, {{0, 1}, 0}, {{-1, -1}, 1}}};
    return square_ ? std::span<const Bound>(of_square) : std::span<const Bound>(of_triangle);
  }
  /// Onto the face, from a rounding beside it.
  Vec2 tidied(Vec2 s) const {
    if (square_) return {std::clamp(s[0], -1.0, 1.0), std::clamp(s[1], -1.0, 1.0)};
    s[0] = std::clamp(s[0], 0.0, 1.0);
    s[1] = std::clamp(s[1], 0.0, 1 - s[0]);
    return s;
  }

  struct Slope {
    double f;
    Vec2 gradient;
    double uu, uv, vv;  ///< Gauss-Newton
    double more_uu, more_uv, more_vv;
  };
  Slope slope(const Vec2& s) const {
    const double u = s[0], v = s[1];
    const Vec3 p = position(s);
    const Vec3 pu = c_[1] + 2 * u * c_[3] + v * (c_[4] + 2 * u * c_[6] + v * c_[7]);
    const Vec3 pv = c_[2] + 2 * v * c_[5] + u * (c_[4] + u * c_[6] + 2 * v * c_[7]);
    const Vec3 puu = 2.0 * (c_[3] + v * c_[6]), pvv = 2.0 * (c_[5] + u * c_[7]);
    const Vec3 puv = c_[4] + 2 * u * c_[6] + 2 * v * c_[7];
    using tenon::dot;
    return {0.5 * dot(p, p), {dot(p, pu), dot(p, pv)}, dot(pu, pu), dot(pu, pv), dot(pv, pv), dot(p, puu), dot(p, puv),
            dot(p, pvv)};
  }

  static Vec2 newton_step(const Slope& at) {
    for (const double more : {1.0, 0.0}) {
      const double uu = at.uu + more * at.more_uu, uv = at.uv + more * at.more_uv, vv = at.vv + more * at.more_vv;
      const double determinant = uu * vv - uv * uv;
      if (uu > 0 && determinant > 1e-10 * uu * vv)
        return {(uv * at.gradient[1] - vv * at.gradient[0]) / determinant,
                (uv * at.gradient[0] - uu * at.gradient[1]) / determinant};
    }
    return steepest(at);
  }
  static Vec2 steepest(const Slope& at) {
    const double scale = at.uu + at.vv;
    return scale > 0 ? Vec2{-at.gradient[0] / scale, -at.gradient[1] / scale} : Vec2{0, 0};
  }
  /// Along a bound.
  static Vec2 sliding_step(const Slope& at, const Vec2& n) {
    const Vec2 t{-n[1], n[0]};
    const auto curvature = [&](double more) {
      return t[0] * t[0] * (at.uu + more * at.more_uu) + 2 * t[0] * t[1] * (at.uv + more * at.more_uv) +
             t[1] * t[1] * (at.vv + more * at.more_vv);
    };
    double h = curvature(1);
    if (!(h > 1e-10 * curvature(0))) h = curvature(0);
    const double length = h > 0 ? -dot(at.gradient, t) / h : 0;
    return {length * t[0], length * t[1]};
  }

  /// Newton (Gauss-Newton where the Hessian is not positive) as long as it stays inside; along a bound that it would
  /// leave by; straight down where neither goes on. Cut at the bounds and halved until f falls enough.
  Vec2 descend(Vec2 s) const {
    for (int i = 0; i < 60; ++i) {
      const Slope at = slope(s);
      bool moved = attempt(s, at, newton_step(at));
      for (const Bound& bound : bounds())
        if (!moved && bound.room(s) <= 1e-14) moved = attempt(s, at, sliding_step(at, bound.n));
      if (!moved) moved = attempt(s, at, steepest(at));
      if (!moved) break;
    }
    return polished(s);
  }
  /// Falls of f end where they are round-off of f, which leaves the square root of round-off in s; the last steps of
  /// Newton go by the gradient alone.
  Vec2 polished(Vec2 s) const {
    for (int i = 0; i < 4; ++i) {
      const Slope at = slope(s);
      Vec2 step = newton_step(at);
      int held = 0;
      for (const Bound& bound : bounds())
        if (bound.room(s) <= 1e-14 && dot(bound.n, at.gradient) > 0) {
          step = sliding_step(at, bound.n);
          ++held;
        }
      const double length = std::max(std::abs(step[0]), std::abs(step[1]));
      if (held > 1 || !(length < 1e-6) || length < 1e-16) break;
      s = tidied({s[0] + step[0], s[1] + step[1]});
    }
    return s;
  }
  bool attempt(Vec2& s, const Slope& at, const Vec2& step) const {
    if (std::max(std::abs(step[0]), std::abs(step[1])) < 1e-16) return false;
    double damp = 1;
    for (const Bound& bound : bounds()) {
      const double rate = dot(bound.n, step), room = std::max(bound.room(s), 0.0);
      if (rate < 0) damp = std::min(damp, room / -rate);
    }
    if (damp <= 1e-14) return false;
    for (int halving = 0; halving < 30; ++halving, damp *= 0.5) {
      const Vec2 next = tidied({s[0] + damp * step[0], s[1] + damp * step[1]});
      const double expected = dot(at.gradient, {next[0] - s[0], next[1] - s[1]});
      if (next == s) return false;
      if (half_square(next) <= at.f + 1e-4 * expected && expected < 0) {
        s = next;
        return true;
      }
    }
    return false;
  }

  bool square_;
  std::array<Vec3, 8> c_{};
};

}  // namespace

NearestPoint nearest_on_curved_sides(ElementKind kind, std::span<const Vec3> nodes, const Vec3& point) {
  const Topology& t = topology(kind);
  const std::span<const Vec3> reference = local_nodes(kind);
  NearestPoint best{element_centre(kind), std::numeric_limits<double>::infinity()};
  for (std::size_t s = 0; s < static_cast<std::size_t>(t.sides); ++s) {
    const auto count = static_cast<std::size_t>(t.side_nodes[s]);
    std::array<Vec3, max_side_nodes> corner, middle;
    for (std::size_t i = 0; i < count; ++i) {
      const std::int8_t a = t.side[s][i], b = t.side[s][(i + 1) % count];
      corner[i] = nodes[static_cast<std::size_t>(a)] - point;
      middle[i] = nodes[static_cast<std::size_t>(middle_node(kind, a, b))] - point;
    }
    const CurvedFace face{std::span(corner).first(count), std::span(middle).first(count)};
    const Vec2 at = face.nearest();
    const double distance = norm(face.position(at));
    if (!(distance < best.distance)) continue;
    const std::array<double, 4> weight = face.corner_weights(at);
    best = {{0, 0, 0}, distance};
    for (std::size_t i = 0; i < count; ++i)
      best.xi = best.xi + weight[i] * reference[static_cast<std::size_t>(t.side[s][i])];
  }
  return best;
}

}  // namespace tenon

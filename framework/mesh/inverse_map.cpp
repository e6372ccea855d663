// SPDX-License-Identifier: BSD-3-Clause
// Where in an element a point lies: Newton on x(xi) = point, kept on the branch of the map that holds the element.
#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/mesh/second_order.hpp"
#include "framework/mesh/shape_functions.hpp"
#include "framework/mesh/trilinear.hpp"

namespace tenon {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int most_iterations = 60;

double greatest(const Vec3& v) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

/// Solves [j0 j1 j2] d = r by Cramer's rule; returns the determinant, and leaves d alone if that is zero or not finite.
double solve(const std::array<Vec3, 3>& j, const Vec3& r, Vec3& d) {
  const Vec3 c12 = cross(j[1], j[2]);
  const double determinant = dot(j[0], c12);
  if (!(std::abs(determinant) > 0) || !std::isfinite(determinant)) return 0;
  const Vec3 c20 = cross(j[2], j[0]), c01 = cross(j[0], j[1]);
  const double inverse = 1 / determinant;
  if (!std::isfinite(inverse)) return 0;
  d = {dot(c12, r) * inverse, dot(c20, r) * inverse, dot(c01, r) * inverse};
  return determinant;
}

/// Residual that is round-off: a few roundings of the largest distance from the point, m.
double round_off(const Trilinear& t) {
  double sum = 0;
  for (const Vec3* v : {&t.c, &t.x, &t.y, &t.z}) sum += greatest(*v);
  return 2 * epsilon * sum;
}

/// The map of a hex8 or wedge6 seen from the point: zero where x(xi) = point.
struct TrilinearResidual {
  Trilinear map;
  double noise;
  explicit TrilinearResidual(const Trilinear& seen_from_point) : map(seen_from_point), noise(round_off(map)) {}
  Vec3 value(const Vec3& xi) const { return map.value(xi); }
  std::array<Vec3, 3> jacobian(const Vec3& xi) const { return map.jacobian(xi); }
};

/// The same of a pyramid5: c + x xi + y eta + z zeta + xy xi eta / (1 - zeta).
struct PyramidResidual {
  Trilinear map;
  double noise;
  PyramidResidual(std::span<const Vec3> corners, const Vec3& point) {
    std::array<Vec3, 4> p;
    for (std::size_t a = 0; a < 4; ++a) p[a] = corners[a] - point;
    map.c = 0.25 * ((p[0] + p[2]) + (p[1] + p[3]));
    map.x = 0.25 * ((p[1] - p[0]) + (p[2] - p[3]));
    map.y = 0.25 * ((p[3] - p[0]) + (p[2] - p[1]));
    map.xy = 0.25 * ((p[0] - p[1]) + (p[2] - p[3]));
    map.z = (corners[4] - point) - map.c;
    noise = round_off(map);
  }
  Vec3 value(const Vec3& xi) const {
    const double height = 1 - xi[2], term = height == 0 ? 0.0 : xi[0] * xi[1] / height;
    return map.c + xi[0] * map.x + xi[1] * map.y + xi[2] * map.z + term * map.xy;
  }
  std::array<Vec3, 3> jacobian(const Vec3& xi) const {
    const double height = 1 - xi[2];
    const double a = height == 0 ? 0.0 : xi[1] / height, b = height == 0 ? 0.0 : xi[0] / height;
    return {map.x + a * map.xy, map.y + b * map.xy, map.z + (a * b) * map.xy};
  }
};

struct Outcome {
  InverseMap map;
  bool right_branch = false;  ///< the Jacobian is positive at the solution, as within the element
};

/// Newton with steps of at most the distance to the centre plus 1 (it may overshoot to another branch else), halved
/// until the residual falls. Converged when a full step was so small that the next, quadratically smaller, is
/// round-off, or when the residual itself is.
template <typename Residual>
Outcome newton(const Residual& f, const Vec3& start) {
  Outcome best;
  best.map.xi = start;
  Vec3 xi = start;
  Vec3 r = f.value(xi);
  double squared = dot(r, r);
  for (int i = 0; i < most_iterations; ++i) {
    Vec3 step;
    const double determinant = solve(f.jacobian(xi), r, step);
    if (determinant == 0) return best;
    const double length = greatest(step), reach = 1 + greatest(xi);
    double damp = length > reach ? reach / length : 1;
    const bool last = length < 1e-9 * reach || greatest(r) <= f.noise;
    Vec3 next = xi - damp * step;
    if (last) {
      best.map = {next, true};
      best.right_branch = determinant > 0;
      return best;
    }
    Vec3 next_r = f.value(next);
    double next_squared = dot(next_r, next_r);
    for (int halving = 0; !(next_squared < squared) && halving < 12; ++halving) {
      damp *= 0.5;
      next = xi - damp * step;
      next_r = f.value(next);
      next_squared = dot(next_r, next_r);
    }
    if (!(next_squared < squared)) {
      best.map.converged = greatest(r) <= 16 * f.noise;  // nothing left but round-off
      best.right_branch = determinant > 0;
      return best;
    }
    xi = next, r = next_r, squared = next_squared;
    best.map.xi = xi;
  }
  return best;
}

/// Newton damped by the natural level function [Deu04]: the next simplified step must be shorter. That does not change
/// with the scales of x, so it gets along valleys of nearly collapsed elements, where the residual hardly falls.
template <typename Residual>
Outcome natural_newton(const Residual& f, const Vec3& start) {
  Outcome best;
  Vec3 xi = start;
  double damp = 1;
  for (int i = 0; i < most_iterations; ++i) {
    const std::array<Vec3, 3> j = f.jacobian(xi);
    Vec3 step;
    const double determinant = solve(j, f.value(xi), step);
    if (determinant == 0) break;
    const double length = greatest(step), reach = 1 + greatest(xi);
    if (length < 1e-9 * reach) {
      best.map = {xi - step, true};
      best.right_branch = determinant > 0;
      break;
    }
    damp = std::min({1.0, 4 * damp, reach / length});
    Vec3 next, simplified;
    for (int halving = 0; halving < 30; ++halving, damp *= 0.5) {
      next = xi - damp * step;
      if (solve(j, f.value(next), simplified) != 0 && norm(simplified) <= (1 - 0.25 * damp) * norm(step)) break;
    }
    xi = next;
  }
  return best;
}

/// Newton from the centre, and, should that fail or end on a folded branch of the map, from eight places around it:
/// of the solutions found on the right branch, that nearest to the element.
template <typename Residual>
InverseMap search(ElementKind kind, const Residual& f) {
  const Outcome first = newton(f, element_centre(kind));
  if (first.map.converged && first.right_branch) return first.map;
  InverseMap best = first.map;
  bool best_right = false;
  double best_overshoot = first.map.converged ? overshoot(kind, first.map.xi) : std::numeric_limits<double>::infinity();
  for (const QuadraturePoint& q : quadrature(kind)) {
    const Outcome other = newton(f, q.xi);
    if (!other.map.converged || (best_right && !other.right_branch)) continue;
    const double outside = overshoot(kind, other.map.xi);
    if ((other.right_branch && !best_right) || outside < best_overshoot) {
      best = other.map, best_right = other.right_branch, best_overshoot = outside;
    }
  }
  if (best_right) return best;
  for (const QuadraturePoint& q : quadrature(kind))
    if (const Outcome other = natural_newton(f, q.xi); other.map.converged && other.right_branch) return other.map;
  return best;
}

/// With curved edges the map may have several solutions of positive determinant: one outside counts only if there is
/// none inside. That is sure if the point is outside the element's box, or if the map is one-to-one on a region that
/// holds both; else Newton from many places looks for another.
InverseMap curved_search(ElementKind kind, std::span<const Vec3> nodes, const Vec3& point) {
  const second_order::Map f(kind, nodes, point);
  const Outcome first = newton(f, element_centre(kind));
  const bool usable = first.map.converged && first.right_branch;
  const double outside = overshoot(kind, first.map.xi);
  if (usable && outside == 0) return first.map;
  Box box = second_order::bezier_box(kind, nodes);
  box.inflate(1e-6 * box.diagonal());
  if (usable) {
    const double reach = greatest(first.map.xi - element_centre(kind));
    const double of_element = kind == ElementKind::hex20 ? 1.0 : 0.75;
    if (!box.contains(point) || f.is_injective_within(std::max(reach, of_element))) return first.map;
  }
  InverseMap best = first.map;
  best.converged = usable;
  double least = usable ? outside : std::numeric_limits<double>::infinity();
  const auto look_from = [&](const auto& solver) {
    for (const QuadraturePoint& q : quadrature(kind == ElementKind::hex20 ? ElementKind::hex8 : ElementKind::tet4)) {
      const Outcome other = solver(q.xi);
      if (!other.map.converged || !other.right_branch) continue;
      const double overshot = overshoot(kind, other.map.xi);
      if (overshot < least) best = other.map, least = overshot;
      if (least == 0) return;
    }
  };
  look_from([&](const Vec3& start) { return newton(f, start); });
  if (std::isinf(least)) look_from([&](const Vec3& start) { return natural_newton(f, start); });
  return best;
}

InverseMap tet_inverse(std::span<const Vec3> corners, const Vec3& point) {
  InverseMap result{element_centre(ElementKind::tet4), false};
  const std::array<Vec3, 3> j{corners[1] - corners[0], corners[2] - corners[0], corners[3] - corners[0]};
  const Vec3 seen = point - corners[0];
  result.converged = solve(j, seen, result.xi) != 0;
  if (!result.converged) return result;
  // Cramer's rule leaves residuals in slivers; solutions for these remove them.
  const double noise = 4 * epsilon * (greatest(seen) + greatest(j[0]) + greatest(j[1]) + greatest(j[2]));
  for (int i = 0; i < 4; ++i) {
    const Vec3 rest = seen - (result.xi[0] * j[0] + (result.xi[1] * j[1] + result.xi[2] * j[2]));
    if (greatest(rest) <= noise) break;
    Vec3 more{};
    solve(j, rest, more);
    result.xi = result.xi + more;
  }
  return result;
}

}  // namespace

InverseMap inverse_map(ElementKind kind, std::span<const Vec3> corners, const Vec3& point) {
  switch (kind) {
    case ElementKind::hex8:
      return search(kind, TrilinearResidual(Trilinear::hex(corners, point)));
    case ElementKind::wedge6:
      return search(kind, TrilinearResidual(Trilinear::wedge(corners, point)));
    case ElementKind::pyramid5:
      return search(kind, PyramidResidual(corners, point));
    case ElementKind::tet4:
      return tet_inverse(corners, point);
    case ElementKind::hex20:
    case ElementKind::tet10:
      return curved_search(kind, corners, point);
    case ElementKind::quad4:
    case ElementKind::tri3:
    case ElementKind::particle:
      break;
  }
  return {element_centre(kind), false};  // a surface has no inverse
}

double overshoot(ElementKind kind, const Vec3& xi) {
  const double x = std::abs(xi[0]), y = std::abs(xi[1]), z = std::abs(xi[2]);
  double outside = 0;
  switch (kind) {
    case ElementKind::hex8:
    case ElementKind::hex20:
      outside = std::max({x, y, z}) - 1;
      break;
    case ElementKind::tet4:
    case ElementKind::tet10:
      outside = 2 * std::max({-xi[0], -xi[1], -xi[2], xi[0] + xi[1] + xi[2] - 1});
      break;
    case ElementKind::wedge6:
      outside = std::max(2 * std::max({-xi[0], -xi[1], xi[0] + xi[1] - 1}), z - 1);
      break;
    case ElementKind::pyramid5:
      outside = std::max(-2 * xi[2], std::max(x, y) + xi[2] - 1);
      break;
    case ElementKind::quad4:
      outside = std::max(x, y) - 1;
      break;
    case ElementKind::tri3:
      outside = 2 * std::max({-xi[0], -xi[1], xi[0] + xi[1] - 1});
      break;
    case ElementKind::particle:
      outside = std::max({x, y, z});
      break;
  }
  return std::max(outside, 0.0);
}

}  // namespace tenon

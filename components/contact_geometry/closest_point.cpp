// SPDX-License-Identifier: BSD-3-Clause
#include "components/contact_geometry/closest_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/contact_geometry/patch.hpp"
#include "components/contact_geometry/polynomial_roots.hpp"

namespace tenon::contact {
namespace {

// Parameters this close to 0 or 1 are on the rim, which is then found exactly.
constexpr double rim = 1e-12;

/// A place on the patch and its squared distance from the origin.
struct Place {
  double xi = 0, eta = 0;
  double squared = std::numeric_limits<double>::infinity();
  int feature = -1;
};

/// Closest point of the rim of `corners` points to the origin.
Place closest_on_rim(const Corners& corners, const std::array<Vec3, 4>& x, std::array<double, 4>& weights) {
  Place best;
  for (int k = 0; k < corners.count; ++k) {
    const int i = corners.index[k], j = corners.index[k + 1 == corners.count ? 0 : k + 1];
    const Vec3 along = x[j] - x[i];
    const double length2 = dot(along, along), s = -dot(x[i], along);
    const double share = s <= 0 ? 0.0 : s >= length2 ? 1.0 : s / length2;
    const Vec3 p = share == 1.0 ? x[j] : x[i] + share * along;
    const double squared = dot(p, p);
    if (!(squared < best.squared)) continue;
    best.squared = squared;
    best.feature = share == 0.0 ? 4 + i : share == 1.0 ? 4 + j : i;
    weights = {0, 0, 0, 0};
    weights[i] = 1 - share;
    weights[j] += share;
  }
  return best;
}

bool strictly_inside(bool triangle, double xi, double eta) {
  return xi > rim && eta > rim && (triangle ? xi + eta < 1 - rim : xi < 1 - rim && eta < 1 - rim);
}

/// The foot in the plane of a triangle; false where that is not in its interior, or where it has no area.
bool foot_in_triangle(const Patch& p, Place& place) {
  const Vec3 normal = cross(p.a, p.b);
  const double n2 = dot(normal, normal), aa = dot(p.a, p.a), bb = dot(p.b, p.b);
  if (!(n2 > 1e-28 * std::max(aa, bb) * std::max(aa, bb))) return false;
  place.xi = dot(cross(p.b, p.origin), normal) / n2;
  place.eta = dot(cross(p.origin, p.a), normal) / n2;
  if (!strictly_inside(true, place.xi, place.eta)) return false;
  const Vec3 foot = p.at(place.xi, place.eta);
  place.squared = dot(foot, foot);
  return true;
}

/// Proves a stationary place (on the rim: one from which the distance does not fall inwards) to be the global minimum.
/// Another place differs from it by D = dxi A + deta B, B = p_eta at the place and A = p_xi at the other eta, and its
/// squared distance by at least |D|^2 - 2 dxi deta g.twist, g from the place to the origin. With |D|^2 >= 2 |dxi deta|
/// (|A||B| - |A.B|) and |A||B| - |A.B| = |A x B|^2 / (|A||B| + |A.B|) it suffices that |A x B|^2 >= |g.twist| (|A||B| +
/// |A.B|) for all A, which are between those of the two edges.
bool is_global(const Patch& p, double xi, double eta) {
  const double lift = std::abs(dot(p.at(xi, eta), p.twist));
  if (lift == 0 && p.twist == Vec3{0, 0, 0}) return true;
  const Vec3 b = p.along_eta(xi), end = p.a + p.twist;
  const Vec3 middle = p.a + 0.5 * p.twist, normal = cross(middle, b);
  const double m = std::min(dot(cross(p.a, b), normal), dot(cross(end, b), normal));
  if (!(m > 0)) return false;
  const double aa = std::max(dot(p.a, p.a), dot(end, end)), ab = std::max(std::abs(dot(p.a, b)), std::abs(dot(end, b)));
  return m * m >= lift * (std::sqrt(aa * dot(b, b)) + ab) * dot(normal, normal);
}

/// Newton for a stationary point of the distance; true if it converged in the interior.
bool newton(const Patch& p, Place& place, int most) {
  double xi = place.xi, eta = place.eta;
  for (int i = 0; i < most; ++i) {
    const Vec3 a = p.along_xi(eta), b = p.along_eta(xi), r = p.origin + xi * p.a + eta * b;
    const double aa = dot(a, a), bb = dot(b, b), ab = dot(a, b) + dot(r, p.twist);
    const double ga = dot(r, a), gb = dot(r, b), det = aa * bb - ab * ab;
    if (!(det > 1e-14 * aa * bb)) return false;
    const double dx = (ab * gb - bb * ga) / det, de = (ab * ga - aa * gb) / det;
    const double new_xi = std::clamp(xi + dx, 0.0, 1.0), new_eta = std::clamp(eta + de, 0.0, 1.0);
    const double step = std::abs(new_xi - xi) + std::abs(new_eta - eta);
    xi = new_xi;
    eta = new_eta;
    if (step > 1e-9) continue;
    if (!strictly_inside(false, xi, eta)) return false;
    const Vec3 foot = p.at(xi, eta);
    place = {xi, eta, dot(foot, foot), -1};
    return true;
  }
  return false;
}

/// Can the distance still fall from this place of the rim towards the interior?
bool falls_inwards(const Patch& p, double xi, double eta) {
  const Vec3 r = p.at(xi, eta);
  const double ga = dot(r, p.along_xi(eta)), gb = dot(r, p.along_eta(xi));
  const double tolerance = 1e-14 * norm(r);
  const double ta = tolerance * norm(p.a), tb = tolerance * norm(p.b);
  return (xi <= rim && ga < -ta) || (xi >= 1 - rim && ga > ta) || (eta <= rim && gb < -tb) ||
         (eta >= 1 - rim && gb > tb);
}

/// All stationary points of the distance in the interior of a bilinear patch. At fixed xi the patch is a line in eta,
/// whose squared distance from the origin is N - M^2 / Q with N = P.P, M = P.D, Q = D.D, P = origin + xi a,
/// D = b + xi twist; its derivative vanishes where the quintic N' Q^2 - 2 M M' Q + M^2 Q' does.
Place best_stationary_point(const Patch& given) {
  // The lines run along the longer direction, where their distance is best conditioned.
  const bool swap = dot(given.a, given.a) > dot(given.b, given.b);
  Patch p = given;
  if (swap) std::swap(p.a, p.b);
  const std::array<double, 3> n{dot(p.origin, p.origin), 2 * dot(p.origin, p.a), dot(p.a, p.a)};
  const std::array<double, 3> m{dot(p.origin, p.b), dot(p.origin, p.twist) + dot(p.a, p.b), dot(p.a, p.twist)};
  const std::array<double, 3> q{dot(p.b, p.b), 2 * dot(p.b, p.twist), dot(p.twist, p.twist)};
  const std::array<double, 2> dn{n[1], 2 * n[2]}, dm{m[1], 2 * m[2]}, dq{q[1], 2 * q[2]};
  std::array<double, quintic_coefficients> c{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 2; ++k) c[i + j + k] += q[i] * q[j] * dn[k] - 2 * q[i] * m[j] * dm[k] + m[i] * m[j] * dq[k];
  std::array<double, quintic_coefficients - 1> roots;
  const int found = roots_in_unit_interval(c, roots);
  Place best;
  for (int i = 0; i < found; ++i) {
    const Vec3 line = p.along_eta(roots[i]), from = p.origin + roots[i] * p.a;
    const double length2 = dot(line, line);
    if (!(length2 > 0)) continue;
    Place place{roots[i], -dot(from, line) / length2};
    if (!strictly_inside(false, place.xi, place.eta)) continue;
    const Vec3 foot = p.at(place.xi, place.eta);
    place.squared = dot(foot, foot);
    Place polished = place;
    if (newton(p, polished, 8) && polished.squared <= place.squared) place = polished;
    if (place.squared < best.squared) best = place;
  }
  if (swap) std::swap(best.xi, best.eta);
  return best;
}

}  // namespace

ClosestPoint closest_point(const FaceShape& face, const Vec3& x) {
  std::array<Vec3, 4> d{};
  for (int i = 0; i < face.corners; ++i) d[i] = face.x[i] - x;
  const Corners corners = distinct_corners(face.corners, d);
  const bool triangle = corners.count == 3;
  const Patch patch =
      make_patch(corners.count, {d[corners.index[0]], d[corners.index[1]], d[corners.index[2]], d[corners.index[3]]});
  Place inner{0.5, 0.5};
  bool inside =
      triangle ? foot_in_triangle(patch, inner) : newton(patch, inner, 8) && is_global(patch, inner.xi, inner.eta);

  ClosestPoint result;
  Place best = inner;
  if (!inside) {
    best = closest_on_rim(corners, d, result.weights);
    const double xi = xi_of(false, result.weights), eta = eta_of(false, result.weights);
    if (!triangle && (falls_inwards(patch, xi, eta) || !is_global(patch, xi, eta))) {
      const Place stationary = best_stationary_point(patch);
      inside = stationary.squared < best.squared;
      if (inside) best = stationary;
    }
  }
  if (inside) {
    const std::array<double, 4> w = corner_weights(triangle, best.xi, best.eta);
    result.weights = {0, 0, 0, 0};
    for (int k = 0; k < corners.count; ++k) result.weights[corners.index[k]] = w[k];
  }
  result.inside = inside;
  result.feature = inside ? -1 : best.feature;
  result.distance = std::sqrt(best.squared);
  result.point = x;
  for (int i = 0; i < face.corners; ++i) result.point = result.point + result.weights[i] * d[i];
  return result;
}

Vec3 face_normal(const FaceShape& face, const std::array<double, 4>& weights) {
  const Corners corners = distinct_corners(face.corners, face.x);
  const auto& index = corners.index;
  const bool triangle = corners.count == 3;
  const Patch p = make_patch(corners.count, {face.x[index[0]], face.x[index[1]], face.x[index[2]], face.x[index[3]]});
  const Vec3 diagonal = p.a + p.b + p.twist;
  const double size2 = std::max({dot(p.a, p.a), dot(p.b, p.b), dot(diagonal, diagonal)});
  const auto unit = [&](const Vec3& normal, Vec3& result) {
    const double length = norm(normal);
    if (!(length > 1e-13 * size2)) return false;
    result = (1 / length) * normal;
    return true;
  };
  const std::array<double, 4> w{weights[index[0]], weights[index[1]], weights[index[2]], weights[index[3]]};
  Vec3 result{0, 0, 0};
  if (unit(p.normal(xi_of(triangle, w), eta_of(triangle, w)), result)) return result;
  // At a corner of 180 degrees the tangents are parallel: the normal of the whole face.
  if (!triangle) unit(p.normal(0.5, 0.5), result);
  return result;
}

}  // namespace tenon::contact

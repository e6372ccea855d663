// SPDX-License-Identifier: BSD-3-Clause
// A triangle or a bilinear quadrilateral in its two parameters.
#pragma once

#include <array>
#include <cmath>

#include "framework/base/types.hpp"

namespace tenon::contact {

/// p(xi, eta) = origin + xi a + eta b + xi eta twist; a triangle has no twist and lives in xi, eta >= 0, xi + eta <= 1,
/// a quadrilateral in the unit square.
struct Patch {
  Vec3 origin, a, b, twist;
  bool triangle = false;

  Vec3 at(double xi, double eta) const { return origin + xi * a + eta * (b + xi * twist); }
  Vec3 along_xi(double eta) const { return a + eta * twist; }
  Vec3 along_eta(double xi) const { return b + xi * twist; }
  /// Not of unit length; follows the corners by the right-hand rule.
  Vec3 normal(double xi, double eta) const { return cross(along_xi(eta), along_eta(xi)); }
};

/// Patch of corners that are given relative to a point.
inline Patch make_patch(int corners, const std::array<Vec3, 4>& x) {
  Patch patch;
  patch.triangle = corners == 3;
  patch.origin = x[0];
  patch.a = x[1] - x[0];
  if (patch.triangle) {
    patch.b = x[2] - x[0];
    patch.twist = {0, 0, 0};
  } else {
    patch.b = x[3] - x[0];
    patch.twist = (x[2] - x[3]) - patch.a;
  }
  return patch;
}

inline std::array<double, 4> corner_weights(bool triangle, double xi, double eta) {
  if (triangle) return {1 - xi - eta, xi, eta, 0};
  return {(1 - xi) * (1 - eta), xi * (1 - eta), xi * eta, (1 - xi) * eta};
}

inline double xi_of(bool triangle, const std::array<double, 4>& w) {
  return triangle ? w[1] : w[1] + w[2];
}
inline double eta_of(bool triangle, const std::array<double, 4>& w) {
  return triangle ? w[2] : w[2] + w[3];
}

/// The corners that count: a quadrilateral of which two neighbouring corners coincide is a triangle.
struct Corners {
  int count;
  std::array<int, 4> index;
};

inline Corners distinct_corners(int corners, const std::array<Vec3, 4>& x) {
  if (corners == 4)
    for (int k = 0; k < 4; ++k)
      if (x[k] == x[(k + 1) % 4]) return {3, {(k + 1) % 4, (k + 2) % 4, (k + 3) % 4, 0}};
  return {corners, {0, 1, 2, 3}};
}

}  // namespace tenon::contact

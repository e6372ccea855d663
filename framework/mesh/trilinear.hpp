// SPDX-License-Identifier: BSD-3-Clause
// The map of hex8 and wedge6 as a polynomial in its local coordinates: cheap to evaluate again and again.
#pragma once

#include <array>
#include <span>

#include "framework/base/types.hpp"

namespace tenon {

/// x = c + x xi + y eta + z zeta + xy xi eta + yz eta zeta + zx zeta xi + xyz xi eta zeta.
struct Trilinear {
  Vec3 c{}, x{}, y{}, z{}, xy{}, yz{}, zx{}, xyz{};

  /// Of a hex8 whose corners are seen from `origin`.
  static Trilinear hex(std::span<const Vec3> corner, const Vec3& origin) {
    Trilinear t;
    for (std::size_t i = 0; i < 3; ++i) {
      std::array<double, 8> p;
      for (std::size_t a = 0; a < 8; ++a) p[a] = corner[a][i] - origin[i];
      const double a0 = p[0] + p[1], a1 = p[3] + p[2], a2 = p[4] + p[5], a3 = p[7] + p[6];
      const double d0 = p[1] - p[0], d1 = p[2] - p[3], d2 = p[5] - p[4], d3 = p[6] - p[7];
      t.c[i] = 0.125 * ((a0 + a1) + (a2 + a3));
      t.y[i] = 0.125 * ((a1 - a0) + (a3 - a2));
      t.z[i] = 0.125 * ((a2 + a3) - (a0 + a1));
      t.yz[i] = 0.125 * ((a3 - a2) - (a1 - a0));
      t.x[i] = 0.125 * ((d0 + d1) + (d2 + d3));
      t.xy[i] = 0.125 * ((d1 - d0) + (d3 - d2));
      t.zx[i] = 0.125 * ((d2 + d3) - (d0 + d1));
      t.xyz[i] = 0.125 * ((d3 - d2) - (d1 - d0));
    }
    return t;
  }
  /// Of a wedge6: no terms in xi eta.
  static Trilinear wedge(std::span<const Vec3> corner, const Vec3& origin) {
    std::array<Vec3, 3> middle, half;
    for (std::size_t a = 0; a < 3; ++a) {
      middle[a] = 0.5 * ((corner[a] - origin) + (corner[a + 3] - origin));
      half[a] = 0.5 * (corner[a + 3] - corner[a]);
    }
    Trilinear t;
    t.c = middle[0], t.x = middle[1] - middle[0], t.y = middle[2] - middle[0];
    t.z = half[0], t.zx = half[1] - half[0], t.yz = half[2] - half[0];
    return t;
  }

  Vec3 value(const Vec3& s) const {
    Vec3 r;
    for (std::size_t i = 0; i < 3; ++i)
      r[i] = (c[i] + s[0] * (x[i] + s[1] * xy[i])) + (s[1] * y[i] + s[2] * (z[i] + s[0] * zx[i])) +
             s[1] * s[2] * (yz[i] + s[0] * xyz[i]);
    return r;
  }
  /// Columns dx/dxi, dx/deta, dx/dzeta.
  std::array<Vec3, 3> jacobian(const Vec3& s) const {
    std::array<Vec3, 3> j;
    for (std::size_t i = 0; i < 3; ++i) {
      j[0][i] = x[i] + s[1] * xy[i] + s[2] * (zx[i] + s[1] * xyz[i]);
      j[1][i] = y[i] + s[0] * xy[i] + s[2] * (yz[i] + s[0] * xyz[i]);
      j[2][i] = z[i] + s[0] * zx[i] + s[1] * (yz[i] + s[0] * xyz[i]);
    }
    return j;
  }
  /// Of a hex8: integral of the determinant over [-1, 1]^3; the terms left out are odd, or have two equal columns.
  double volume() const {
    const auto det = [](const Vec3& a, const Vec3& b, const Vec3& d) { return dot(a, cross(b, d)); };
    return 8 * (det(x, y, z) + (det(x, xy, zx) + det(xy, y, yz) + det(zx, yz, z)) / 3);
  }
};

}  // namespace tenon

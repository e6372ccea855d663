// SPDX-License-Identifier: BSD-3-Clause
// Four points at once in four trilinear hexahedra: local coordinates by Newton's method, and shape functions there.
#pragma once

#include <array>
#include <limits>

#include "framework/base/pack.hpp"
#include "framework/base/types.hpp"

namespace tenon::transfer {

/// A point and the corners of an element: x[nodes[a]]. One more double may be read behind each.
struct HexTask {
  const LocalIndex* nodes;
  const Vec3* point;
};

/// x(xi) - point = c0 + xi cx + eta cy + zeta cz + xi eta cxy + eta zeta cyz + zeta xi czx + xi eta zeta cxyz, by
/// component.
struct HexPolynomial {
  Pack c0[3], cx[3], cy[3], cz[3], cxy[3], cyz[3], czx[3], cxyz[3];
};

/// Corners relative to the point, corner by corner.
struct HexCorners {
  Pack x[8][3];
};

TENON_KERNEL HexCorners hex_corners(const Vec3* x, const std::array<HexTask, 4>& tasks) {
  HexCorners result;
  const auto at = [&](std::size_t task, int i) { return load(x[tasks[task].nodes[i]].data()); };
  Pack p[4];
  for (int l = 0; l < 4; ++l) {
    const Vec3& point = *tasks[static_cast<std::size_t>(l)].point;
    p[l] = Pack{point[0], point[1], point[2], 0};
  }
#pragma GCC unroll 8
  for (int i = 0; i < 8; ++i) {
    Pack a = at(0, i) - p[0], b = at(1, i) - p[1], c = at(2, i) - p[2], d = at(3, i) - p[3];
    transpose(a, b, c, d);
    result.x[i][0] = a, result.x[i][1] = b, result.x[i][2] = c;
  }
  return result;
}

TENON_KERNEL HexPolynomial hex_polynomial(const HexCorners& at) {
  HexPolynomial p;
#pragma GCC unroll 3
  for (int c = 0; c < 3; ++c) {
    const Pack eighth = broadcast<Pack>(0.125);
    const Pack s01 = at.x[1][c] + at.x[0][c], d01 = at.x[1][c] - at.x[0][c];
    const Pack s32 = at.x[2][c] + at.x[3][c], d32 = at.x[2][c] - at.x[3][c];
    const Pack s45 = at.x[5][c] + at.x[4][c], d45 = at.x[5][c] - at.x[4][c];
    const Pack s76 = at.x[6][c] + at.x[7][c], d76 = at.x[6][c] - at.x[7][c];
    const Pack low = s32 + s01, high = s76 + s45, eta_low = s32 - s01, eta_high = s76 - s45;
    const Pack xi_low = d32 + d01, xi_high = d76 + d45, both_low = d32 - d01, both_high = d76 - d45;
    p.c0[c] = eighth * (high + low), p.cz[c] = eighth * (high - low);
    p.cy[c] = eighth * (eta_high + eta_low), p.cyz[c] = eighth * (eta_high - eta_low);
    p.cx[c] = eighth * (xi_high + xi_low), p.czx[c] = eighth * (xi_high - xi_low);
    p.cxy[c] = eighth * (both_high + both_low), p.cxyz[c] = eighth * (both_high - both_low);
  }
  return p;
}

struct HexLocal {
  Pack xi, eta, zeta;
  PackMask converged;  ///< to round-off, where the map keeps its orientation
};

TENON_KERNEL Pack magnitude(const Pack& x) {
  return x < 0.0 ? -x : x;
}

TENON_KERNEL Pack greatest_of(const Pack& a, const Pack& b, const Pack& c) {
  return greater_of(greater_of(magnitude(a), magnitude(b)), magnitude(c));
}

/// Newton from the centre, with steps no longer than the way from the centre plus 1, as inverse_map goes; a point is
/// left where its own last step was below 1e-8, whatever the others do. Those whose residual grows, that are not there
/// after 14 steps, or that end where the map is folded have not converged: they need more care.
TENON_KERNEL HexLocal hex_newton(const HexPolynomial& p) {
  HexLocal at{Pack{}, Pack{}, Pack{}, PackMask{}};
  PackMask waiting = ~PackMask{};
  Pack before = broadcast<Pack>(std::numeric_limits<double>::max());
  for (int step = 0; step < 14; ++step) {
    const Pack xy = at.xi * at.eta, yz = at.eta * at.zeta, zx = at.zeta * at.xi;
    Pack f[3], jx[3], jy[3], jz[3];
#pragma GCC unroll 3
    for (int c = 0; c < 3; ++c) {
      f[c] = ((p.c0[c] + at.xi * p.cx[c]) + (at.eta * p.cy[c] + at.zeta * p.cz[c])) +
             ((xy * p.cxy[c] + yz * p.cyz[c]) + (zx * p.czx[c] + (xy * at.zeta) * p.cxyz[c]));
      jx[c] = (p.cx[c] + at.eta * p.cxy[c]) + (at.zeta * p.czx[c] + yz * p.cxyz[c]);
      jy[c] = (p.cy[c] + at.xi * p.cxy[c]) + (at.zeta * p.cyz[c] + zx * p.cxyz[c]);
      jz[c] = (p.cz[c] + at.eta * p.cyz[c]) + (at.xi * p.czx[c] + xy * p.cxyz[c]);
    }
    const auto cross = [](const Pack(&a)[3], const Pack(&b)[3], Pack(&to)[3]) {
      to[0] = a[1] * b[2] - a[2] * b[1], to[1] = a[2] * b[0] - a[0] * b[2], to[2] = a[0] * b[1] - a[1] * b[0];
    };
    const auto dot = [](const Pack(&a)[3], const Pack(&b)[3]) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; };
    Pack yz_cross[3], zx_cross[3], xy_cross[3];
    cross(jy, jz, yz_cross), cross(jz, jx, zx_cross), cross(jx, jy, xy_cross);
    const Pack determinant = dot(jx, yz_cross), inverse = 1.0 / determinant;
    const Pack dxi = inverse * dot(f, yz_cross), deta = inverse * dot(f, zx_cross), dzeta = inverse * dot(f, xy_cross);
    const Pack move = greatest_of(dxi, deta, dzeta), reach = 1.0 + greatest_of(at.xi, at.eta, at.zeta);
    const Pack residual = dot(f, f);
    const PackMask arrived = waiting & (move < 1e-8);
    const Pack share = move > reach ? reach / move : broadcast<Pack>(1.0);
    at.xi = waiting ? at.xi - share * dxi : at.xi;
    at.eta = waiting ? at.eta - share * deta : at.eta;
    at.zeta = waiting ? at.zeta - share * dzeta : at.zeta;
    at.converged |= arrived & (determinant > 0.0);
    waiting &= ~arrived & (residual < before);  // false for what is not a number
    before = residual;
    if (!any(waiting)) break;
  }
  return at;
}

/// How far outside, in half widths.
TENON_KERNEL Pack hex_overshoot(const HexLocal& at) {
  return greater_of(greatest_of(at.xi, at.eta, at.zeta) - 1.0, Pack{});
}

/// Local coordinates put within the element; exactly a corner's if the point is that corner.
TENON_KERNEL void put_within(const HexCorners& corners, HexLocal& at) {
  const Pack one = broadcast<Pack>(1.0);
  const auto within = [&](const Pack& v) { return lesser_of(greater_of(v, -one), one); };
  at.xi = within(at.xi), at.eta = within(at.eta), at.zeta = within(at.zeta);
  const Pack least = lesser_of(lesser_of(magnitude(at.xi), magnitude(at.eta)), magnitude(at.zeta));
  if (!any(least > 1 - 1e-9)) return;
  const auto nearest = [&](const Pack& v) { return v < 0.0 ? -one : one; };
  for (int a = 0; a < 8; ++a) {
    const PackMask here = (corners.x[a][0] == 0.0) & (corners.x[a][1] == 0.0) & (corners.x[a][2] == 0.0);
    at.xi = here ? nearest(at.xi) : at.xi;
    at.eta = here ? nearest(at.eta) : at.eta;
    at.zeta = here ? nearest(at.zeta) : at.zeta;
  }
}

}  // namespace tenon::transfer

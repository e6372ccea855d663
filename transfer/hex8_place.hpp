// SPDX-License-Identifier: BSD-3-Clause
// Four points at once in four trilinear hexahedra: local coordinates by Newton's method, and shape functions there.
#pragma once

#include <array>
#include <limits>

#include "framework/base/pack.hpp"
#include "framework/base/types.hpp"

namespace tenon::transfer {

/// A point and the corners of an element, as they lie in memory: eight Vec3, one more double may be read behind them.
struct HexTask {
  const Vec3* corners;
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

TENON_KERNEL HexCorners hex_corners(const std::array<HexTask, 4>& tasks) {
  HexCorners result;
  const auto at = [](const Vec3* v) { return load(v->data()); };
  Pack p[4];
  for (int l = 0; l < 4; ++l) {
    const Vec3& point = *tasks[static_cast<std::size_t>(l)].point;
    p[l] = Pack{point[0], point[1], point[2], 0};
  }
#pragma GCC unroll 8
  for (int i = 0; i < 8; ++i) {
    Pack a = at(tasks[0].corners + i) - p[0], b = at(tasks[1].corners + i) - p[1];
    Pack c = at(tasks[2].corners + i) - p[2], d = at(tasks[3].corners + i) - p[3];
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

/// Shape functions within the element, not negative, their sum 1 to within an ulp; exactly one corner if the point is
/// that corner.
TENON_KERNEL void hex_weights(const HexCorners& corners, const HexLocal& at, Pack (&w)[8]) {
  const Pack one = broadcast<Pack>(1.0), half = broadcast<Pack>(0.5);
  const auto within = [&](const Pack& v) { return lesser_of(greater_of(v, -one), one); };
  const Pack xi = within(at.xi), eta = within(at.eta), zeta = within(at.zeta);
  const Pack xl = half - half * xi, xh = half + half * xi, yl = half - half * eta, yh = half + half * eta;
  const Pack zl = half - half * zeta, zh = half + half * zeta;
  const Pack ll = xl * yl, hl = xh * yl, hh = xh * yh, lh = xl * yh;
  w[0] = ll * zl, w[1] = hl * zl, w[2] = hh * zl, w[3] = lh * zl;
  w[4] = ll * zh, w[5] = hl * zh, w[6] = hh * zh, w[7] = lh * zh;
  Pack greatest = Pack{};
#pragma GCC unroll 8
  for (int a = 0; a < 8; ++a) w[a] = w[a] > 1e-15 ? w[a] : Pack{}, greatest = greater_of(w[a], greatest);
  PackMask is[8], found = PackMask{};
#pragma GCC unroll 8
  for (int a = 0; a < 8; ++a) is[a] = (w[a] == greatest) & ~found, found |= is[a];
  for (int repeat = 0; repeat < 2; ++repeat) {
    Pack sum = Pack{};
    for (int a = 0; a < 8; ++a) sum += w[a];
    for (int a = 0; a < 8; ++a) w[a] = is[a] ? w[a] + (1.0 - sum) : w[a];
  }
#pragma GCC unroll 8
  for (int a = 0; a < 8; ++a) {
    const PackMask here = (corners.x[a][0] == 0.0) & (corners.x[a][1] == 0.0) & (corners.x[a][2] == 0.0);
    if (!any(here)) continue;
    for (int b = 0; b < 8; ++b) w[b] = here ? broadcast<Pack>(a == b ? 1.0 : 0.0) : w[b];
  }
}

}  // namespace tenon::transfer

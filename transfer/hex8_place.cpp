// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/hex8_place.hpp"

#include <cstdint>
#include <limits>

namespace tenon::transfer {

namespace {

using Lanes = double __attribute__((vector_size(8 * hex_lanes)));
using LaneMask = std::int64_t __attribute__((vector_size(8 * hex_lanes)));

TENON_KERNEL bool any_lane(const LaneMask& mask) {
#ifdef __AVX512F__
  const auto low = __builtin_shufflevector(mask, mask, 0, 1, 2, 3),
             high = __builtin_shufflevector(mask, mask, 4, 5, 6, 7);
  return any(low | high);
#else
  return any(mask);
#endif
}

TENON_KERNEL Lanes magnitude(const Lanes& x) {
  return x < 0.0 ? -x : x;
}
TENON_KERNEL Lanes greatest_of(const Lanes& a, const Lanes& b, const Lanes& c) {
  return greater_of(greater_of(a, b), c);
}
TENON_KERNEL Lanes greatest_magnitude(const Lanes& a, const Lanes& b, const Lanes& c) {
  return greatest_of(magnitude(a), magnitude(b), magnitude(c));
}

/// Corners relative to the point, corner by corner.
struct Corners {
  Lanes x[8][3];
};

TENON_KERNEL Corners corners_of(const Vec3* x, const std::array<HexTask, hex_lanes>& tasks) {
  Corners result;
  Pack point[hex_lanes];
  for (std::size_t l = 0; l < hex_lanes; ++l) {
    const Vec3& p = *tasks[l].point;
    point[l] = Pack{p[0], p[1], p[2], 0};
  }
#pragma GCC unroll 8
  for (int i = 0; i < 8; ++i) {
    const auto at = [&](std::size_t l) { return load(x[tasks[l].nodes[i]].data()) - point[l]; };
    Pack a = at(0), b = at(1), c = at(2), d = at(3);
    transpose(a, b, c, d);
#ifdef __AVX512F__
    Pack e = at(4), f = at(5), g = at(6), h = at(7);
    transpose(e, f, g, h);
    const auto joined = [](const Pack& p, const Pack& q) {
      return __builtin_shufflevector(p, q, 0, 1, 2, 3, 4, 5, 6, 7);
    };
    result.x[i][0] = joined(a, e), result.x[i][1] = joined(b, f), result.x[i][2] = joined(c, g);
#else
    result.x[i][0] = a, result.x[i][1] = b, result.x[i][2] = c;
#endif
  }
  return result;
}

/// x(xi) - point = c0 + xi cx + eta cy + zeta cz + xi eta cxy + eta zeta cyz + zeta xi czx + xi eta zeta cxyz, by
/// component.
struct Polynomial {
  Lanes c0[3], cx[3], cy[3], cz[3], cxy[3], cyz[3], czx[3], cxyz[3];
};

TENON_KERNEL Polynomial polynomial_of(const Corners& at) {
  Polynomial p;
#pragma GCC unroll 3
  for (int c = 0; c < 3; ++c) {
    const Lanes eighth = Lanes{} + 0.125;
    const Lanes s01 = at.x[1][c] + at.x[0][c], d01 = at.x[1][c] - at.x[0][c];
    const Lanes s32 = at.x[2][c] + at.x[3][c], d32 = at.x[2][c] - at.x[3][c];
    const Lanes s45 = at.x[5][c] + at.x[4][c], d45 = at.x[5][c] - at.x[4][c];
    const Lanes s76 = at.x[6][c] + at.x[7][c], d76 = at.x[6][c] - at.x[7][c];
    const Lanes low = s32 + s01, high = s76 + s45, eta_low = s32 - s01, eta_high = s76 - s45;
    const Lanes xi_low = d32 + d01, xi_high = d76 + d45, both_low = d32 - d01, both_high = d76 - d45;
    p.c0[c] = eighth * (high + low), p.cz[c] = eighth * (high - low);
    p.cy[c] = eighth * (eta_high + eta_low), p.cyz[c] = eighth * (eta_high - eta_low);
    p.cx[c] = eighth * (xi_high + xi_low), p.czx[c] = eighth * (xi_high - xi_low);
    p.cxy[c] = eighth * (both_high + both_low), p.cxyz[c] = eighth * (both_high - both_low);
  }
  return p;
}

struct Local {
  Lanes xi, eta, zeta;
  LaneMask converged;
};

TENON_KERNEL void cross(const Lanes (&a)[3], const Lanes (&b)[3], Lanes (&to)[3]) {
  to[0] = a[1] * b[2] - a[2] * b[1], to[1] = a[2] * b[0] - a[0] * b[2], to[2] = a[0] * b[1] - a[1] * b[0];
}
TENON_KERNEL Lanes dot(const Lanes (&a)[3], const Lanes (&b)[3]) {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

TENON_KERNEL Local newton(const Polynomial& p) {
  Local at{Lanes{}, Lanes{}, Lanes{}, LaneMask{}};
  LaneMask waiting = ~LaneMask{};
  Lanes before = Lanes{} + std::numeric_limits<double>::max();
  for (int step = 0; step < 14; ++step) {
    const Lanes xy = at.xi * at.eta, yz = at.eta * at.zeta, zx = at.zeta * at.xi;
    Lanes f[3], jx[3], jy[3], jz[3];
#pragma GCC unroll 3
    for (int c = 0; c < 3; ++c) {
      f[c] = ((p.c0[c] + at.xi * p.cx[c]) + (at.eta * p.cy[c] + at.zeta * p.cz[c])) +
             ((xy * p.cxy[c] + yz * p.cyz[c]) + (zx * p.czx[c] + (xy * at.zeta) * p.cxyz[c]));
      jx[c] = (p.cx[c] + at.eta * p.cxy[c]) + (at.zeta * p.czx[c] + yz * p.cxyz[c]);
      jy[c] = (p.cy[c] + at.xi * p.cxy[c]) + (at.zeta * p.cyz[c] + zx * p.cxyz[c]);
      jz[c] = (p.cz[c] + at.eta * p.cyz[c]) + (at.xi * p.czx[c] + xy * p.cxyz[c]);
    }
    Lanes yz_cross[3], zx_cross[3], xy_cross[3];
    cross(jy, jz, yz_cross), cross(jz, jx, zx_cross), cross(jx, jy, xy_cross);
    const Lanes determinant = dot(jx, yz_cross), inverse = 1.0 / determinant;
    Lanes dxi = inverse * dot(f, yz_cross), deta = inverse * dot(f, zx_cross), dzeta = inverse * dot(f, xy_cross);
    const Lanes move = greatest_magnitude(dxi, deta, dzeta), reach = 1.0 + greatest_magnitude(at.xi, at.eta, at.zeta);
    const Lanes residual = dot(f, f);
    const LaneMask arrived = waiting & (move < 1e-8);
    if (any_lane(waiting & (move > reach))) {
      const Lanes share = move > reach ? reach / move : Lanes{} + 1.0;
      dxi *= share, deta *= share, dzeta *= share;
    }
    at.xi = waiting ? at.xi - dxi : at.xi;
    at.eta = waiting ? at.eta - deta : at.eta;
    at.zeta = waiting ? at.zeta - dzeta : at.zeta;
    at.converged |= arrived & (determinant > 0.0);
    waiting &= ~arrived & (residual < 2 * before);  // false for what is not a number
    before = residual;
    if (!any_lane(waiting)) break;
  }
  return at;
}

TENON_KERNEL void put_within(const Corners& corners, Local& at) {
  const Lanes one = Lanes{} + 1.0;
  const auto within = [&](const Lanes& v) { return lesser_of(greater_of(v, -one), one); };
  at.xi = within(at.xi), at.eta = within(at.eta), at.zeta = within(at.zeta);
  const Lanes least = lesser_of(lesser_of(magnitude(at.xi), magnitude(at.eta)), magnitude(at.zeta));
  const LaneMask near = least > 1 - 1e-9;  // a corner
  if (!any_lane(near)) return;
  const auto nearest = [&](const Lanes& v) { return v < 0.0 ? -one : one; };
  for (int a = 0; a < 8; ++a) {
    const LaneMask here = near & (corners.x[a][0] == 0.0) & (corners.x[a][1] == 0.0) & (corners.x[a][2] == 0.0);
    at.xi = here ? nearest(at.xi) : at.xi;
    at.eta = here ? nearest(at.eta) : at.eta;
    at.zeta = here ? nearest(at.zeta) : at.zeta;
  }
}

}  // namespace

void place_in_hexahedra(const Vec3* x, const std::array<HexTask, hex_lanes>& tasks, HexPlaces& places) {
  const Corners corners = corners_of(x, tasks);
  Local at = newton(polynomial_of(corners));
  const Lanes outermost = greatest_magnitude(at.xi, at.eta, at.zeta);
  put_within(corners, at);
  for (std::size_t l = 0; l < hex_lanes; ++l) {
    places.xi[l] = {at.xi[l], at.eta[l], at.zeta[l]};
    places.depth[l] = 1 - outermost[l];
    places.overshoot[l] = outermost[l] > 1 ? outermost[l] - 1 : 0;
    places.converged[l] = at.converged[l] != 0;
  }
}

}  // namespace tenon::transfer

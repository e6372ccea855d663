// SPDX-License-Identifier: BSD-3-Clause
// Geometry and strain rates of a shell element with one integration point in its plane, and the transpose: forces.
#pragma once

#include "components/mechanics/small_tensor.hpp"

namespace tenon {

/// A nodal vector as mean + xi a + eta b + xi eta c, -1 <= xi, eta <= 1. Of a triangle: mean, differences of nodes 1
/// and 2 from node 0, and zero.
template <typename R>
struct ShellModes {
  Vector<R> mean, xi, eta, hourglass;
};

/// What kinds of shell differ in.
struct QuadShell {
  static constexpr int nodes = 4;
  static constexpr int hourglasses = 6;  ///< strains that vary: membrane, bending, transverse shear, two each
  static constexpr int drills = 4;
  static constexpr double area = 4;  ///< of the natural element
  /// Modes of the values 0 (exactly), b, c, d at the nodes, given relative to node 0; `first` is the value there.
  template <typename R>
  TENON_KERNEL static ShellModes<R> modes(const Vector<R>& first, const Vector<R>& b, const Vector<R>& c,
                                          const Vector<R>& d) {
    const R quarter = broadcast<R>(0.25);
    return {first + quarter * (b + c + d), quarter * (b - d + c), quarter * (d - b + c), quarter * (c - b - d)};
  }
  /// Shares of the nodes in what is conjugate to the modes.
  template <typename R>
  TENON_KERNEL static void share(const ShellModes<R>& f, Vector<R> (&to)[4]) {
    const R quarter = broadcast<R>(0.25);
    const Vector<R> even = quarter * (f.mean + f.hourglass), odd = quarter * (f.mean - f.hourglass);
    const Vector<R> rising = quarter * (f.xi + f.eta), falling = quarter * (f.xi - f.eta);
    to[0] = even - rising, to[1] = odd + falling, to[2] = even + rising, to[3] = odd - falling;
  }
};
struct TriShell {
  static constexpr int nodes = 3;
  static constexpr int hourglasses = 1;  ///< transverse shear
  static constexpr int drills = 3;
  static constexpr double area = 0.5;
  template <typename R>
  TENON_KERNEL static ShellModes<R> modes(const Vector<R>& first, const Vector<R>& b, const Vector<R>& c,
                                          const Vector<R>&) {
    return {first + broadcast<R>(1.0 / 3.0) * (b + c), b, c, Vector<R>{}};
  }
  template <typename R>
  TENON_KERNEL static void share(const ShellModes<R>& f, Vector<R> (&to)[4]) {
    const Vector<R> mean = broadcast<R>(1.0 / 3.0) * f.mean;
    to[0] = mean - f.xi - f.eta, to[1] = mean + f.xi, to[2] = mean + f.eta;
  }
};

/// A vector in the plane of the element.
template <typename R>
struct Plane {
  R x, y;
};
template <typename R>
TENON_KERNEL R dot(const Plane<R>& a, const Plane<R>& b) {
  return a.x * b.x + a.y * b.y;
}
template <typename R>
TENON_KERNEL R dot(const Plane<R>& a, const Vector<R>& b) {
  return a.x * b.x + a.y * b.y;
}

/// In the element's own axes: z is the normal at the centre; x and y turn with the material (polar decomposition of the
/// deformation in the plane since the start), so that whatever a material keeps needs no turning.
///
/// The surface is x = a1 xi + a2 eta + h xi eta. Its director is n - (turn of the normal along it), linear: d = n + d1
/// xi
/// + d2 eta with h.z alone, the warping: to first order in it the normal of the surface. That couples membrane and
/// curvature as in [BWC92] and stays bounded on any shape.
template <typename R>
struct ShellGeometry {
  Tensor<R> axes;
  Plane<R> a1, a2;              ///< m
  Vector<R> h;                  ///< m
  Plane<R> g1, g2;              ///< contravariant: g_a . a_b = 1 or 0, 1/m
  Plane<R> along;               ///< h in the plane: along.x a1 + along.y a2
  Plane<R> d1, d2;              ///< 1
  R turn_xx, turn_yy, turn_xy;  ///< d1 = turn a1, d2 = turn a2; symmetric, 1/m
  Plane<R> turned_h;            ///< turn h, 1
  R area;                       ///< m^2
};

/// In-plane components of a1, a2 in the element's axes at the start.
template <typename R>
struct ShellReference {
  R a1x, a1y, a2x, a2y;
};

/// Any x, y axes; z the normal.
template <typename R>
TENON_KERNEL Tensor<R> provisional_axes(const ShellModes<R>& x) {
  const auto unit = [](const Vector<R>& a) { return (1.0 / square_root(dot(a, a))) * a; };
  const Vector<R> n = unit(cross(x.xi, x.eta)), first = unit(x.xi);
  return {first, cross(n, first), n};
}

/// With the deformation F = p_a outer G_a from the plane at the start (p_a now, G_a contravariant then; any factor
/// does) its rotation takes x to the direction of F x + F y cross n, in which the sum of both stretches is greatest.
template <typename S, typename R>
TENON_KERNEL ShellGeometry<R> shell_geometry(const ShellModes<R>& x, const ShellReference<R>& start) {
  const Vector<R> normal = cross(x.xi, x.eta);
  const R jacobian = square_root(dot(normal, normal)), one = 1.0 / jacobian;
  const Vector<R> n = one * normal;
  const Vector<R> along_x = start.a2y * x.xi - start.a1y * x.eta, along_y = start.a1x * x.eta - start.a2x * x.xi;
  const Vector<R> sum = along_x + cross(along_y, n);
  const Vector<R> first = (1.0 / square_root(dot(sum, sum))) * sum;
  ShellGeometry<R> g;
  g.axes = {first, cross(n, first), n};
  const auto plane = [&](const Vector<R>& a) { return Plane<R>{dot(g.axes.x, a), dot(g.axes.y, a)}; };
  g.a1 = plane(x.xi), g.a2 = plane(x.eta);
  g.g1 = {one * g.a2.y, -one * g.a2.x}, g.g2 = {-one * g.a1.y, one * g.a1.x};
  if constexpr (S::nodes == 4) {
    g.h = g.axes * x.hourglass;
    g.along = {dot(g.g1, g.h), dot(g.g2, g.h)};
    const R warp = one * g.h.z, twice = 2.0 * (one * warp);
    g.d1 = {warp * g.a1.y, -warp * g.a1.x}, g.d2 = {-warp * g.a2.y, warp * g.a2.x};
    g.turn_xx = twice * (g.a1.y * g.a2.y), g.turn_yy = twice * (g.a1.x * g.a2.x);
    g.turn_xy = -0.5 * twice * (g.a1.x * g.a2.y + g.a1.y * g.a2.x);
    g.turned_h = {g.turn_xx * g.h.x + g.turn_xy * g.h.y, g.turn_xy * g.h.x + g.turn_yy * g.h.y};
  } else {
    g.h = Vector<R>{}, g.along = g.d1 = g.d2 = g.turned_h = Plane<R>{};
    g.turn_xx = g.turn_yy = g.turn_xy = R{};
  }
  g.area = S::area * jacobian;
  return g;
}

/// Strain rates: constant part in Cartesian components of the element's axes (shear strains as angles, twice the tensor
/// components), varying part and drilling in the natural directions.
template <typename R>
struct ShellRates {
  R membrane[3], curvature[3], shear[2];  ///< xx yy xy; 1/s, 1/(m s), 1/s
  R hourglass[6];                         ///< quad: e11 eta, e22 xi, k11 eta, k22 xi, s1 eta, s2 xi; triangle: shear
  R drill[4];                             ///< spin about the normal against that of the surface, and its differences
};

/// What does work on them, integrated over the element.
template <typename R>
using ShellResultants = ShellRates<R>;

/// Rates of the director field: d = d0 + d1 xi + d2 eta + dh xi eta from omega x d at the nodes; n = (0, 0, 1).
template <typename S, typename R>
TENON_KERNEL ShellModes<R> director_rates(const ShellGeometry<R>& g, const ShellModes<R>& w) {
  const auto n = [](const Vector<R>& a) { return Vector<R>{a.y, -a.x, R{}}; };
  const auto turn = [](const Vector<R>& a, const Plane<R>& d) {
    return Vector<R>{-a.z * d.y, a.z * d.x, a.x * d.y - a.y * d.x};
  };
  if constexpr (S::nodes == 3) return {n(w.mean), n(w.xi), n(w.eta), Vector<R>{}};
  return {n(w.mean) + turn(w.xi, g.d1) + turn(w.eta, g.d2), n(w.xi) + turn(w.mean, g.d1) + turn(w.hourglass, g.d2),
          n(w.eta) + turn(w.hourglass, g.d1) + turn(w.mean, g.d2),
          n(w.hourglass) + turn(w.eta, g.d1) + turn(w.xi, g.d2)};
}
/// Its transpose.
template <typename S, typename R>
TENON_KERNEL ShellModes<R> director_moments(const ShellGeometry<R>& g, const ShellModes<R>& f) {
  const auto n = [](const Vector<R>& a) { return Vector<R>{-a.y, a.x, R{}}; };
  const auto turn = [](const Plane<R>& d, const Vector<R>& a) {
    return Vector<R>{d.y * a.z, -d.x * a.z, d.x * a.y - d.y * a.x};
  };
  if constexpr (S::nodes == 3) return {n(f.mean), n(f.xi), n(f.eta), Vector<R>{}};
  return {n(f.mean) + turn(g.d1, f.xi) + turn(g.d2, f.eta), n(f.xi) + turn(g.d1, f.mean) + turn(g.d2, f.hourglass),
          n(f.eta) + turn(g.d1, f.hourglass) + turn(g.d2, f.mean),
          n(f.hourglass) + turn(g.d1, f.eta) + turn(g.d2, f.xi)};
}

/// Gradient in the plane of a field with modes f: rows d/dx, d/dy.
template <typename R>
TENON_KERNEL Plane<R> slope(const ShellGeometry<R>& g, const R& along_xi, const R& along_eta) {
  return {along_xi * g.g1.x + along_eta * g.g2.x, along_xi * g.g1.y + along_eta * g.g2.y};
}

/// Rates of strain of the surface x + zeta d, in terms that a rigid rotation makes zero: the constant part from the
/// gradients in the plane (L of v, D of d; the curvature also takes `turn` with L), what varies from the natural
/// components e_ab = a_a . v_b. Transverse shear from its values at the middles of the edges [BD85] (triangle: [LB04]),
/// which keeps thin elements free of locking. From what varies the share of the constant strain is taken that varies in
/// natural components only because the element is no parallelogram; what is left are gammas, the parts of v and d that
/// no linear field explains. Constant strain leaves nothing, so that patches of any shape are exact. The shears
/// xi e11 + eta e22 that go with in-plane bending are left out. v and w are in the element's axes.
template <typename S, typename R>
TENON_KERNEL ShellRates<R> shell_rates(const ShellGeometry<R>& g, const ShellModes<R>& v, const ShellModes<R>& w) {
  const ShellModes<R> d = director_rates<S>(g, w);
  ShellRates<R> r;
  const Plane<R> lx = slope(g, v.xi.x, v.eta.x), ly = slope(g, v.xi.y, v.eta.y);
  const Plane<R> dx = slope(g, d.xi.x, d.eta.x), dy = slope(g, d.xi.y, d.eta.y);
  r.membrane[0] = lx.x, r.membrane[1] = ly.y, r.membrane[2] = lx.y + ly.x;
  r.curvature[0] = dx.x, r.curvature[1] = dy.y, r.curvature[2] = dx.y + dy.x;
  R s1 = v.xi.z + dot(g.a1, d.mean), s2 = v.eta.z + dot(g.a2, d.mean);
  if constexpr (S::nodes == 4) {
    r.curvature[0] += g.turn_xx * lx.x + g.turn_xy * ly.x, r.curvature[1] += g.turn_xy * lx.y + g.turn_yy * ly.y;
    r.curvature[2] += (g.turn_xx * lx.y + g.turn_xy * ly.y) + (g.turn_xy * lx.x + g.turn_yy * ly.x);
    s1 += dot(g.h, d.eta) + dot(g.d2, v.hourglass), s2 += dot(g.h, d.xi) + dot(g.d1, v.hourglass);
    const R p = g.along.x, q = g.along.y, common = v.hourglass.z + dot(g.h, d.mean) - p * s1 - q * s2;
    const Plane<R> gamma{v.hourglass.x - p * v.xi.x - q * v.eta.x, v.hourglass.y - p * v.xi.y - q * v.eta.y};
    const Plane<R> delta{d.hourglass.x - p * d.xi.x - q * d.eta.x, d.hourglass.y - p * d.xi.y - q * d.eta.y};
    r.hourglass[0] = dot(g.a1, gamma) + g.h.z * v.xi.z, r.hourglass[1] = dot(g.a2, gamma) + g.h.z * v.eta.z;
    r.hourglass[2] = dot(g.a1, delta) + g.h.z * d.xi.z + dot(g.d1, gamma) - dot(g.turned_h, v.xi);
    r.hourglass[3] = dot(g.a2, delta) + g.h.z * d.eta.z + dot(g.d2, gamma) - dot(g.turned_h, v.eta);
    r.hourglass[4] = common + dot(g.a1, d.eta) + dot(g.d2, v.xi);
    r.hourglass[5] = common + dot(g.a2, d.xi) + dot(g.d1, v.eta);
  } else {
    const R both = dot(g.a1, d.eta) + dot(g.a2, d.xi), sixth = broadcast<R>(1.0 / 6.0);
    s1 += sixth * (dot(g.a1, d.xi) - both), s2 += sixth * (dot(g.a2, d.eta) - both);
    r.hourglass[0] = 0.5 * (dot(g.a1, d.eta) - dot(g.a2, d.xi));
  }
  const Plane<R> shear = slope(g, s1, s2);
  r.shear[0] = shear.x, r.shear[1] = shear.y;
  r.drill[0] = w.mean.z - 0.5 * (ly.x - lx.y), r.drill[1] = w.xi.z, r.drill[2] = w.eta.z, r.drill[3] = w.hourglass.z;
  return r;
}

template <typename R>
struct ShellForces {
  ShellModes<R> force, moment;  ///< N, N m; conjugate to the modes of velocity and spin, in the element's axes
};

/// The transpose of `shell_rates`.
template <typename S, typename R>
TENON_KERNEL ShellForces<R> shell_forces(const ShellGeometry<R>& g, const ShellResultants<R>& q) {
  const R(&n)[3] = q.membrane;
  const R(&m)[3] = q.curvature;
  // Conjugate to the gradients: of v_x along x and y, of v_y along x and y.
  R xx = n[0], xy = n[2] + 0.5 * q.drill[0], yx = n[2] - 0.5 * q.drill[0], yy = n[1];
  R s1 = q.shear[0] * g.g1.x + q.shear[1] * g.g1.y, s2 = q.shear[0] * g.g2.x + q.shear[1] * g.g2.y;
  if constexpr (S::nodes == 4) {
    xx += g.turn_xx * m[0] + g.turn_xy * m[2], xy += g.turn_xy * m[1] + g.turn_xx * m[2];
    yx += g.turn_xy * m[0] + g.turn_yy * m[2], yy += g.turn_yy * m[1] + g.turn_xy * m[2];
    const R both = q.hourglass[4] + q.hourglass[5];
    s1 = s1 - g.along.x * both, s2 = s2 - g.along.y * both;
  }
  const auto in_plane = [](const R& a, const Plane<R>& u, const R& b, const Plane<R>& w) {
    return Vector<R>{a * u.x + b * w.x, a * u.y + b * w.y, R{}};
  };
  ShellForces<R> result;
  ShellModes<R>&f = result.force, &moment = result.moment, d;
  f.mean = Vector<R>{}, f.hourglass = Vector<R>{}, d.hourglass = Vector<R>{};
  f.xi = {xx * g.g1.x + xy * g.g1.y, yx * g.g1.x + yy * g.g1.y, s1};
  f.eta = {xx * g.g2.x + xy * g.g2.y, yx * g.g2.x + yy * g.g2.y, s2};
  d.mean = in_plane(s1, g.a1, s2, g.a2);
  d.xi = {m[0] * g.g1.x + m[2] * g.g1.y, m[2] * g.g1.x + m[1] * g.g1.y, R{}};
  d.eta = {m[0] * g.g2.x + m[2] * g.g2.y, m[2] * g.g2.x + m[1] * g.g2.y, R{}};
  if constexpr (S::nodes == 4) {
    const R(&k)[6] = q.hourglass;
    const R a = g.along.x, b = g.along.y, both = k[4] + k[5], first = k[2] + s2, second = k[3] + s1;
    const Vector<R> gamma = in_plane(k[0], g.a1, k[1], g.a2) + in_plane(k[2], g.d1, k[3], g.d2);
    const Vector<R> delta = in_plane(k[2], g.a1, k[3], g.a2);
    f.xi.x += k[4] * g.d2.x - a * gamma.x - k[2] * g.turned_h.x;
    f.xi.y += k[4] * g.d2.y - a * gamma.y - k[2] * g.turned_h.y;
    f.eta.x += k[5] * g.d1.x - b * gamma.x - k[3] * g.turned_h.x;
    f.eta.y += k[5] * g.d1.y - b * gamma.y - k[3] * g.turned_h.y;
    f.xi.z += g.h.z * k[0], f.eta.z += g.h.z * k[1];
    f.hourglass = gamma + in_plane(s2, g.d1, s1, g.d2);
    f.hourglass.z = both;
    d.mean = d.mean + both * g.h;
    d.xi.x += s2 * g.h.x + k[5] * g.a2.x - a * delta.x, d.xi.y += s2 * g.h.y + k[5] * g.a2.y - a * delta.y;
    d.eta.x += s1 * g.h.x + k[4] * g.a1.x - b * delta.x, d.eta.y += s1 * g.h.y + k[4] * g.a1.y - b * delta.y;
    d.xi.z = first * g.h.z, d.eta.z = second * g.h.z;
    d.hourglass = delta;
  } else {
    const R a = (1.0 / 6.0) * s1, b = (1.0 / 6.0) * s2, c = 0.5 * q.hourglass[0];
    d.xi = d.xi + in_plane(a, g.a1, -(a + b) - c, g.a2), d.eta = d.eta + in_plane(b, g.a2, c - (a + b), g.a1);
  }
  moment = director_moments<S>(g, d);
  moment.mean.z += q.drill[0], moment.xi.z += q.drill[1], moment.eta.z += q.drill[2];
  if constexpr (S::drills == 4) moment.hourglass.z += q.drill[3];
  return result;
}

}  // namespace tenon

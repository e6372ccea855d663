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
  /// Share of node i in what is conjugate to the modes.
  template <typename R>
  TENON_KERNEL static Vector<R> share(const ShellModes<R>& f, int i) {
    const R quarter = broadcast<R>(0.25);
    const Vector<R> x = i == 1 || i == 2 ? f.mean + f.xi : f.mean - f.xi;
    const Vector<R> y = i == 0 || i == 2 ? f.hourglass : broadcast<R>(-1.0) * f.hourglass;
    return quarter * ((i < 2 ? x - f.eta : x + f.eta) + y);
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
  TENON_KERNEL static Vector<R> share(const ShellModes<R>& f, int i) {
    const Vector<R> mean = broadcast<R>(1.0 / 3.0) * f.mean;
    return i == 0 ? mean - f.xi - f.eta : (i == 1 ? mean + f.xi : mean + f.eta);
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
  Plane<R> a1, a2;  ///< m
  Vector<R> h;      ///< m
  Plane<R> g1, g2;  ///< contravariant: g_a . a_b = 1 or 0, 1/m
  Plane<R> d1, d2;  ///< 1
  R area;           ///< m^2
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

template <typename S, typename R>
TENON_KERNEL ShellGeometry<R> shell_geometry(const ShellModes<R>& x, const ShellReference<R>& start) {
  const Tensor<R> axes = provisional_axes(x);
  const auto plane = [&](const Vector<R>& a) { return Plane<R>{dot(axes.x, a), dot(axes.y, a)}; };
  const Plane<R> p1 = plane(x.xi), p2 = plane(x.eta);
  // F = p_a outer G_a with G_a contravariant at the start; its rotation is (trace, skew part), normalised.
  const R along = p1.x * start.a2y - p2.x * start.a1y + (p2.y * start.a1x - p1.y * start.a2x);
  const R across = p1.y * start.a2y - p2.y * start.a1y - (p2.x * start.a1x - p1.x * start.a2x);
  const R inverse = 1.0 / square_root(along * along + across * across);
  const R c = inverse * along, s = inverse * across;
  ShellGeometry<R> g;
  g.axes = {c * axes.x + s * axes.y, c * axes.y - s * axes.x, axes.z};
  const auto turned = [&](const Plane<R>& a) { return Plane<R>{c * a.x + s * a.y, c * a.y - s * a.x}; };
  g.a1 = turned(p1), g.a2 = turned(p2), g.h = g.axes * x.hourglass;
  const R jacobian = g.a1.x * g.a2.y - g.a1.y * g.a2.x, one = 1.0 / jacobian;
  g.g1 = {one * g.a2.y, -one * g.a2.x}, g.g2 = {-one * g.a1.y, one * g.a1.x};
  const R warp = one * g.h.z;
  g.d1 = {warp * g.a1.y, -warp * g.a1.x}, g.d2 = {-warp * g.a2.y, warp * g.a2.x};
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
template <typename R>
TENON_KERNEL ShellModes<R> director_rates(const ShellGeometry<R>& g, const ShellModes<R>& w) {
  const auto n = [](const Vector<R>& a) { return Vector<R>{a.y, -a.x, R{}}; };
  const auto turn = [](const Vector<R>& a, const Plane<R>& d) {
    return Vector<R>{-a.z * d.y, a.z * d.x, a.x * d.y - a.y * d.x};
  };
  return {n(w.mean) + turn(w.xi, g.d1) + turn(w.eta, g.d2), n(w.xi) + turn(w.mean, g.d1) + turn(w.hourglass, g.d2),
          n(w.eta) + turn(w.hourglass, g.d1) + turn(w.mean, g.d2),
          n(w.hourglass) + turn(w.eta, g.d1) + turn(w.xi, g.d2)};
}
/// Its transpose.
template <typename R>
TENON_KERNEL ShellModes<R> director_moments(const ShellGeometry<R>& g, const ShellModes<R>& f) {
  const auto n = [](const Vector<R>& a) { return Vector<R>{-a.y, a.x, R{}}; };
  const auto turn = [](const Plane<R>& d, const Vector<R>& a) {
    return Vector<R>{d.y * a.z, -d.x * a.z, d.x * a.y - d.y * a.x};
  };
  return {n(f.mean) + turn(g.d1, f.xi) + turn(g.d2, f.eta), n(f.xi) + turn(g.d1, f.mean) + turn(g.d2, f.hourglass),
          n(f.eta) + turn(g.d1, f.hourglass) + turn(g.d2, f.mean),
          n(f.hourglass) + turn(g.d1, f.eta) + turn(g.d2, f.xi)};
}

/// 11 and 22 components in the natural base, and twice the 12 component (strains) or it (stresses).
template <typename R>
struct Natural {
  R r11, r22, r12;
};

/// Covariant rates e_ab = a_a . v_b and curvatures e_ab(zeta) of the surface x + zeta d, all in pairs that a rigid
/// rotation makes zero. Transverse shear from its values at the middles of the edges [BD85] (triangle: [LB04]), which
/// keeps thin elements free of locking. From what varies over the element the share of the constant strain is taken
/// that varies in natural components only because the element is no parallelogram (p, q: h = p a1 + q a2 + ...):
/// constant strain leaves nothing, so that patches of any shape are exact. The shears xi e11 + eta e22 that go with
/// in-plane bending are left out. v and w are in the element's axes.
template <typename S, typename R>
TENON_KERNEL ShellRates<R> shell_rates(const ShellGeometry<R>& g, const ShellModes<R>& v, const ShellModes<R>& w) {
  const ShellModes<R> d = director_rates(g, w);
  ShellRates<R> r;
  const auto cartesian = [&](const Natural<R>& c, R(&to)[3]) {
    to[0] = c.r11 * (g.g1.x * g.g1.x) + c.r22 * (g.g2.x * g.g2.x) + c.r12 * (g.g1.x * g.g2.x);
    to[1] = c.r11 * (g.g1.y * g.g1.y) + c.r22 * (g.g2.y * g.g2.y) + c.r12 * (g.g1.y * g.g2.y);
    to[2] = 2.0 * (c.r11 * (g.g1.x * g.g1.y) + c.r22 * (g.g2.x * g.g2.y)) + c.r12 * (g.g1.x * g.g2.y + g.g1.y * g.g2.x);
  };
  const Natural<R> e{dot(g.a1, v.xi), dot(g.a2, v.eta), dot(g.a1, v.eta) + dot(g.a2, v.xi)};
  const Natural<R> k{dot(g.a1, d.xi) + dot(g.d1, v.xi), dot(g.a2, d.eta) + dot(g.d2, v.eta),
                     dot(g.a1, d.eta) + dot(g.a2, d.xi) + dot(g.d1, v.eta) + dot(g.d2, v.xi)};
  cartesian(e, r.membrane), cartesian(k, r.curvature);
  R s1 = v.xi.z + dot(g.a1, d.mean), s2 = v.eta.z + dot(g.a2, d.mean);
  if constexpr (S::nodes == 4) {
    s1 += dot(g.h, d.eta) + dot(g.d2, v.hourglass), s2 += dot(g.h, d.xi) + dot(g.d1, v.hourglass);
    const R p = dot(g.g1, g.h), q = dot(g.g2, g.h), common = v.hourglass.z + dot(g.h, d.mean) - p * s1 - q * s2;
    r.hourglass[0] = dot(g.a1, v.hourglass) + dot(g.h, v.xi) - 2.0 * p * e.r11 - q * e.r12;
    r.hourglass[1] = dot(g.a2, v.hourglass) + dot(g.h, v.eta) - 2.0 * q * e.r22 - p * e.r12;
    r.hourglass[2] = dot(g.a1, d.hourglass) + dot(g.h, d.xi) + dot(g.d1, v.hourglass) - 2.0 * p * k.r11 - q * k.r12;
    r.hourglass[3] = dot(g.a2, d.hourglass) + dot(g.h, d.eta) + dot(g.d2, v.hourglass) - 2.0 * q * k.r22 - p * k.r12;
    r.hourglass[4] = common + dot(g.a1, d.eta) + dot(g.d2, v.xi);
    r.hourglass[5] = common + dot(g.a2, d.xi) + dot(g.d1, v.eta);
  } else {
    const R both = dot(g.a1, d.eta) + dot(g.a2, d.xi), sixth = broadcast<R>(1.0 / 6.0);
    s1 += sixth * (dot(g.a1, d.xi) - both), s2 += sixth * (dot(g.a2, d.eta) - both);
    r.hourglass[0] = 0.5 * (dot(g.a1, d.eta) - dot(g.a2, d.xi));
  }
  r.shear[0] = s1 * g.g1.x + s2 * g.g2.x, r.shear[1] = s1 * g.g1.y + s2 * g.g2.y;
  const R turn = 0.5 * (v.xi.y * g.g1.x + v.eta.y * g.g2.x - v.xi.x * g.g1.y - v.eta.x * g.g2.y);
  r.drill[0] = w.mean.z - turn, r.drill[1] = w.xi.z, r.drill[2] = w.eta.z, r.drill[3] = w.hourglass.z;
  return r;
}

template <typename R>
struct ShellForces {
  ShellModes<R> force, moment;  ///< N, N m; conjugate to the modes of velocity and spin, in the element's axes
};

/// The transpose of `shell_rates`.
template <typename S, typename R>
TENON_KERNEL ShellForces<R> shell_forces(const ShellGeometry<R>& g, const ShellResultants<R>& q) {
  const auto natural = [&](const R(&n)[3]) {
    return Natural<R>{n[0] * (g.g1.x * g.g1.x) + n[1] * (g.g1.y * g.g1.y) + 2.0 * (n[2] * (g.g1.x * g.g1.y)),
                      n[0] * (g.g2.x * g.g2.x) + n[1] * (g.g2.y * g.g2.y) + 2.0 * (n[2] * (g.g2.x * g.g2.y)),
                      n[0] * (g.g1.x * g.g2.x) + n[1] * (g.g1.y * g.g2.y) + n[2] * (g.g1.x * g.g2.y + g.g1.y * g.g2.x)};
  };
  Natural<R> n = natural(q.membrane), m = natural(q.curvature);
  R s1 = q.shear[0] * g.g1.x + q.shear[1] * g.g1.y, s2 = q.shear[0] * g.g2.x + q.shear[1] * g.g2.y;
  if constexpr (S::nodes == 4) {
    const R a = dot(g.g1, g.h), b = dot(g.g2, g.h), both = q.hourglass[4] + q.hourglass[5];
    const auto subtract = [&](Natural<R>& from, const R& first, const R& second) {
      from.r11 = from.r11 - 2.0 * a * first, from.r22 = from.r22 - 2.0 * b * second;
      from.r12 = from.r12 - b * first - a * second;
    };
    subtract(n, q.hourglass[0], q.hourglass[1]), subtract(m, q.hourglass[2], q.hourglass[3]);
    s1 = s1 - a * both, s2 = s2 - b * both;
  }
  const auto in_plane = [](const R& a, const Plane<R>& u, const R& b, const Plane<R>& w) {
    return Vector<R>{a * u.x + b * w.x, a * u.y + b * w.y, R{}};
  };
  ShellModes<R> f, d;
  f.mean = Vector<R>{};
  f.xi = in_plane(n.r11, g.a1, n.r12, g.a2) + in_plane(m.r11, g.d1, m.r12, g.d2);
  f.eta = in_plane(n.r22, g.a2, n.r12, g.a1) + in_plane(m.r22, g.d2, m.r12, g.d1);
  f.xi.z += s1, f.eta.z += s2;
  const R half = 0.5 * q.drill[0];
  f.xi.x += half * g.g1.y, f.xi.y -= half * g.g1.x, f.eta.x += half * g.g2.y, f.eta.y -= half * g.g2.x;
  d.mean = in_plane(s1, g.a1, s2, g.a2);
  d.xi = in_plane(m.r11, g.a1, m.r12, g.a2), d.eta = in_plane(m.r22, g.a2, m.r12, g.a1);
  if constexpr (S::nodes == 4) {
    const R(&k)[6] = q.hourglass;
    f.xi = f.xi + k[0] * g.h + in_plane(k[4], g.d2, R{}, g.d2);
    f.eta = f.eta + k[1] * g.h + in_plane(k[5], g.d1, R{}, g.d1);
    f.hourglass = in_plane(k[0], g.a1, k[1], g.a2) + in_plane(k[2] + s2, g.d1, k[3] + s1, g.d2);
    f.hourglass.z += k[4] + k[5];
    d.mean = d.mean + (k[4] + k[5]) * g.h;
    d.xi = d.xi + (k[2] + s2) * g.h + in_plane(k[5], g.a2, R{}, g.a2);
    d.eta = d.eta + (k[3] + s1) * g.h + in_plane(k[4], g.a1, R{}, g.a1);
    d.hourglass = in_plane(k[2], g.a1, k[3], g.a2);
  } else {
    const R a = (1.0 / 6.0) * s1, b = (1.0 / 6.0) * s2, c = 0.5 * q.hourglass[0];
    f.hourglass = Vector<R>{}, d.hourglass = Vector<R>{};
    d.xi = d.xi + in_plane(a, g.a1, -(a + b) - c, g.a2), d.eta = d.eta + in_plane(b, g.a2, c - (a + b), g.a1);
  }
  ShellModes<R> moment = director_moments(g, d);
  moment.mean.z += q.drill[0], moment.xi.z += q.drill[1], moment.eta.z += q.drill[2];
  if constexpr (S::drills == 4) moment.hourglass.z += q.drill[3];
  return {f, moment};
}

}  // namespace tenon

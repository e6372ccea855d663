// SPDX-License-Identifier: BSD-3-Clause
// A bound on the highest frequency of a shell element, and the rotary inertia that keeps rotations below it.
#pragma once

#include "components/mechanics/shell4_kinematics.hpp"

namespace tenon {

/// Elastic moduli under plane stress, Pa.
template <typename R>
struct PlaneModuli {
  R lambda, shear, young;  ///< lambda = 2 mu lambda3/(lambda3 + 2 mu)
};
template <typename R>
TENON_KERNEL PlaneModuli<R> plane_moduli(const R& lambda, const R& shear) {
  return {2.0 * lambda * shear / (lambda + 2.0 * shear), shear,
          shear * (3.0 * lambda + 2.0 * shear) / (lambda + shear)};
}

/// What a shell element resists with.
template <typename R>
struct ShellStiffness {
  PlaneModuli<R> moduli;
  R thickness;           ///< m
  R second_moment;       ///< mean square of the distance from the middle surface, m^2: t^2/12
  R offset;              ///< of the middle surface from the nodes, m
  R shear_modulus;       ///< of transverse shear, correction included, Pa
  R drilling;            ///< N m
  bool centred = false;  ///< the offset is 0 in all elements
};

/// Spectral norm of the symmetric matrix of two blocks of norms a and b and a coupling of norm c, from above.
template <typename R>
TENON_KERNEL R joined(const R& a, const R& b, const R& coupling_squared) {
  const R half = 0.5 * (a - b);
  return 0.5 * (a + b) + square_root(half * half + coupling_squared);
}

/// Products of the covariant and contravariant base vectors.
template <typename R>
struct ShellMetric {
  R g11, g22, g12;       ///< contravariant, 1/m^2
  R a11, a22, a12;       ///< covariant, m^2
  R trace, determinant;  ///< of the sum over the nodes of grad N outer grad N, times the nodes
};
template <typename S, typename R>
TENON_KERNEL ShellMetric<R> shell_metric(const ShellGeometry<R>& g) {
  ShellMetric<R> m{
      dot(g.g1, g.g1), dot(g.g2, g.g2), dot(g.g1, g.g2), dot(g.a1, g.a1), dot(g.a2, g.a2), dot(g.a1, g.a2), R{}, R{}};
  const R squared = m.g11 * m.g22 - m.g12 * m.g12;
  m.trace = S::nodes == 4 ? m.g11 + m.g22 : 6.0 * (m.g11 + m.g22 + m.g12);
  m.determinant = S::nodes == 4 ? squared : 27.0 * squared;
  return m;
}

/// Eigenvalues of M^-1 K are those of D^1/2 B M^-1 B^T D^1/2, B the strains of `shell_rates`, D their stiffness. In the
/// natural base B B^T is nearly diagonal, so norms of its blocks are known: constant membrane strain exactly; its
/// varying part; bending as membrane by the rotations; shear by both. `joined` puts them together, couplings by h,
/// warping and offset included, so that the bound is safe for any shape and exact for a flat parallelogram whose
/// rotations are slower. `slow` is the mass of a node over its inertia, 1/m^2. 1/s^2. An assembly has no mode faster
/// than its fastest element [HUG87, 7.3].
template <typename S, typename R>
TENON_KERNEL R shell_frequency_squared(const ShellGeometry<R>& g, const ShellStiffness<R>& k, const R& mass,
                                       const R& slow) {
  const ShellMetric<R> m = shell_metric<S>(g);
  const R per_mass = 1.0 / mass, unit = g.area * k.thickness * per_mass;
  const R lambda = k.moduli.lambda, shear = k.moduli.shear, p = lambda + 2.0 * shear;
  const R spread = greater_of(m.trace * m.trace - 4.0 * m.determinant, R{});
  const R constant = 0.5 * unit * (p * m.trace + square_root(p * p * spread + 4.0 * lambda * lambda * m.determinant));
  // Of the metric; the row sums bound it, without a root where the triangle needs it sharp.
  const R steepest =
      S::nodes == 4 ? greater_of(m.g11, m.g22) + greater_of(m.g12, -m.g12) : 0.5 * (m.trace + square_root(spread));
  const R shear_unit = k.shear_modulus * unit, both = m.g11 + m.g22;
  R membrane = constant, transverse, turning{}, warp_shear{}, coupling{};
  if constexpr (S::nodes == 4) {
    const R up = g.h.z * g.h.z, all = up + g.h.x * g.h.x + g.h.y * g.h.y;
    const R k1 = k.moduli.young * (1.0 / 3.0) * m.g11 * m.g11, k2 = k.moduli.young * (1.0 / 3.0) * m.g22 * m.g22;
    // h = along1 a1 + along2 a2 + ..., and the gradient of what that takes from the varying strains.
    const R along1 = g.along.x, along2 = g.along.y, along = along1 * along1 + along2 * along2;
    const R slope = along1 * along1 * m.g11 + along2 * along2 * m.g22 + 2.0 * along1 * along2 * m.g12;
    const R cross = k1 * ((lambda + shear) * along1 * along1 + shear * slope * m.a11) +
                    k2 * ((lambda + shear) * along2 * along2 + shear * slope * m.a22);
    const R tilt = (1.0 / 3.0) * k.moduli.young * m.g11 * m.g22 * greater_of(m.a12, -m.a12);
    const R varying = unit * (1.0 + along) * (greater_of(k1 * (m.a11 + up), k2 * (m.a22 + up)) + tilt);
    membrane = joined(constant, varying, unit * unit * cross);
    const R bent = both * all, round = 2.0 * greater_of(m.g11 * m.a11, m.g22 * m.a22) + 2.0 * along * bent;
    const R shear0 = steepest + slow * (1.0 + bent);
    const R shear1 = (1.0 / 3.0) * ((1.0 + along) * both + slow * round);
    transverse = joined(shear0, shear1, (2.0 / 3.0) * (slope * both + slow * slow * bent * round));
    const R turn = up * greater_of(m.a11, m.a22) * (m.g11 * m.g22 - m.g12 * m.g12);
    turning = 2.0 * turn * both;
    warp_shear = 2.0 * shear_unit * both * turn;
    coupling = (k1 * m.g11 + k2 * m.g22) * up * unit * shear_unit;
  } else {
    const auto squares = [](const Plane<R>& a, const Plane<R>& b, const Plane<R>& c, const Plane<R>& d) {
      const R xx = a.x * b.x - c.x * d.x, xy = a.x * b.y - c.x * d.y;
      const R yx = a.y * b.x - c.y * d.x, yy = a.y * b.y - c.y * d.y;
      return xx * xx + xy * xy + yx * yx + yy * yy;
    };
    const Plane<R> edge{g.a1.x - g.a2.x, g.a1.y - g.a2.y}, back{-edge.x, -edge.y};
    const R mean = (9.0 / 36.0) * (squares(g.g1, edge, g.g2, g.a2) + squares(g.g2, back, g.g1, g.a1));
    transverse = steepest + slow * (1.0 + mean + 9.0 / 72.0 * (both + m.g12) * (m.a11 + m.a22) * 0.01);
  }
  const double most = S::nodes == 4 ? 1.0 : 9.0;
  const R drill_turn = k.drilling * per_mass * (0.25 * m.trace);
  const R warp_bending = membrane * k.second_moment * turning;
  const R bending = membrane * k.second_moment * slow * (1.0 + 3.0 * turning);
  const R rotation = shear_unit * transverse;
  const R second = bending + rotation + warp_bending + warp_shear + drill_turn + most * slow * k.drilling * per_mass;
  if (k.centred) return joined(membrane, second, coupling + membrane * (warp_bending + warp_shear + drill_turn));
  // Off the middle surface, membrane strain takes up a share of the curvature.
  const R squared_offset = k.offset * k.offset, lever = squared_offset * slow * (1.0 + 3.0 * turning);
  const R stretched = 1.0 + square_root(squared_offset * turning), in_plane = membrane * stretched * stretched;
  coupling += in_plane * (warp_bending + warp_shear + drill_turn) + lever * membrane * (bending + rotation);
  return joined(in_plane + membrane * lever, second, coupling);
}

/// Inertia of a node over its mass, m^2: that of the section, and the share of the element's area at which the shear
/// modes of a square are just slower than its membrane modes, with a quarter to spare for thick and distorted elements.
/// It lies near the usual 1/8 [HUG87, 9.4] but is less where it can be (0.09 for Poisson's ratio 0.3).
inline double rotary_inertia(double area, double second_moment, double offset, double poissons_ratio) {
  const double share = 5.0 / 24.0 / (4 * poissons_ratio / (1 - poissons_ratio) + 7.0 / 6.0);
  return second_moment + offset * offset + 1.25 * share * area;
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// How large a step one element allows: bounds on its highest frequency and on its damping.
#pragma once

#include "components/mechanics/hourglass.hpp"

namespace tenon {

/// Greatest eigenvalue of a symmetric, positive tensor, from above: tr/3 + sqrt(2/3) |dev| is never below it, and
/// Newton's iteration on the characteristic polynomial falls towards it without passing it. Exact for equal
/// eigenvalues and for one that exceeds two equal ones; at worst (two equal, one zero) 4 % too high.
template <typename R>
TENON_KERNEL R greatest_eigenvalue_bound(const SymmetricTensor<R>& g) {
  const R sum = trace(g);
  const R mean = sum * (1.0 / 3.0);
  const R xx = g.xx - mean, yy = g.yy - mean, zz = g.zz - mean;
  const R squared = xx * xx + yy * yy + zz * zz + 2.0 * (g.xy * g.xy + g.yz * g.yz + g.zx * g.zx);
  // In units of the trace; dev has the characteristic polynomial t^3 - j2 t - j3, with t = eigenvalue - mean.
  const R inverse = 1.0 / sum;
  const R j2 = 0.5 * squared * inverse * inverse;
  const R j3 = (xx * (yy * zz - g.yz * g.yz) - g.xy * (g.xy * zz - g.yz * g.zx) + g.zx * (g.xy * g.yz - yy * g.zx)) *
               inverse * inverse * inverse;
  const R tiny = broadcast<R>(1e-9), zero = broadcast<R>(0.0);
  R t = square_root((4.0 / 3.0) * j2);
  for (int i = 0; i < 3; ++i) {
    const R value = greater_of(t * (t * t - j2) - j3, zero), slope = greater_of(3.0 * t * t - j2, tiny);
    t = t - value / slope;
  }
  return mean + greater_of(t, zero) * sum;
}

/// omega^2 of the one-point element is at most 8/(m V) (lambda tr G + 2 mu g): G = sum of b_I b_I, g its greatest
/// eigenvalue, the mass m shared equally by 8 nodes; for (b.u)^2 <= tr G |u|^2 and |sym(u b)|^2 <= g |u|^2. Both hold
/// with equality when a cube breathes. An assembly has no mode faster than its fastest element [HUG87, 7.3]. 1/s^2.
template <typename R>
TENON_KERNEL R frequency_squared_bound(const R& trace_g, const R& greatest, const Moduli<R>& moduli, const R& mass,
                                       const R& volume) {
  return 8.0 * (moduli.lambda * trace_g + (2.0 * moduli.shear) * greatest) / (mass * volume);
}

/// Damping forces are taken at the velocity of half a step before, so dt^2/4 omega^2 + dt/2 c <= 1 keeps the step
/// stable, c (1/s) the greatest eigenvalue of M^-1 C: dt = 2/(sqrt(omega^2 + c^2/4) + c/2). Damping of modes that have
/// no stiffness (hourglass) alone asks for dt <= 2/c.
template <typename R>
TENON_KERNEL R damped_step(const R& frequency_squared, const R& damping, const R& hourglass_damping) {
  const R half = 0.5 * damping;
  return 2.0 / greater_of(square_root(frequency_squared + half * half) + half, hourglass_damping);
}

/// The fastest wave along one direction of a mesh of such elements alone, 1/s^2: what an element among its like
/// allows. Not a bound; its change measures how the limit of a mesh changes.
template <typename R>
TENON_KERNEL R wave_frequency_squared(const R& greatest, const Moduli<R>& moduli, const R& mass, const R& volume) {
  return 8.0 * ((moduli.lambda + 2.0 * moduli.shear) * greatest) / (mass * volume);
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// The one-point hexahedron on a batch: from nodal positions and velocities to strain, stress rotation and forces.
#pragma once

#include <cstdint>

#include "components/mechanics/bulk_viscosity.hpp"
#include "components/mechanics/element_group.hpp"
#include "components/mechanics/kinematics.hpp"
#include "components/mechanics/stable_step.hpp"

namespace tenon {

/// Local node numbers of a batch of hexahedra.
struct alignas(64) HexConnectivity {
  std::int32_t node[8][lanes];
};

/// Modes of a nodal vector for four elements of a batch. Values are taken relative to node 0, which keeps digits far
/// from the origin and makes a uniform motion exactly zero.
TENON_KERNEL HexModes<Pack> gather(const double* values, const HexConnectivity& c, int lane) {
  const auto row = [&](int node, int l) {
    return load(values + 3 * static_cast<std::ptrdiff_t>(c.node[node][lane + l]));
  };
  const Pack r0 = row(0, 0), r1 = row(0, 1), r2 = row(0, 2), r3 = row(0, 3);
  Pack x[8], y[8], z[8];
  x[0] = y[0] = z[0] = Pack{};
#pragma GCC unroll 8
  for (int i = 1; i < 8; ++i) {
    Pack a = row(i, 0) - r0, b = row(i, 1) - r1, d = row(i, 2) - r2, e = row(i, 3) - r3;
    transpose(a, b, d, e);
    x[i] = a, y[i] = b, z[i] = d;
  }
  return hex_modes(x, y, z);
}

/// Internal forces of an element, and what is found on the way.
template <typename R>
struct ElementForces {
  ScalarModes<R> x, y, z;                ///< N; nodal forces by from_modes
  R volume;                              ///< m^3
  R step;                                ///< stable step, s, or a code
  R greatest, damping;                   ///< eigenvalue of G, m^4, and of M^-1 C by bulk viscosity, 1/s
  R viscosity_energy, hourglass_energy;  ///< taken up in the step, J
};

/// What a group has in common.
template <typename H>
struct HexParameters {
  BulkViscosity viscosity;
  H hourglass;
};

/// sigma b_I and the hourglass forces Q_alpha, which act through gamma_alpha = h_alpha - 1/V sum_j (h_alpha . x_j) b_j:
/// their b part joins the stress. Only the forces of the result are set.
template <typename R>
TENON_KERNEL ElementForces<R> nodal_forces(const HexModes<R>& x, const MeanGradient<R>& b, const R& inverse_volume,
                                           const SymmetricTensor<R>& s, const HourglassVectors<R>& q) {
  const auto row = [&](const R& sx, const R& sy, const R& sz, const R& q1, const R& q2, const R& q3, const R& q4) {
    const Vector<R> held = (q1 * x.eta_zeta + q2 * x.zeta_xi) + (q3 * x.xi_eta + q4 * x.xi_eta_zeta);
    const Vector<R> t = Vector<R>{sx, sy, sz} - inverse_volume * held;
    const Vector<R> scaled = broadcast<R>(1.0 / 64.0) * t;
    return ScalarModes<R>{dot(scaled, b.xi),
                          dot(scaled, b.eta),
                          dot(scaled, b.zeta),
                          q1 + dot(scaled, b.eta_zeta),
                          q2 + dot(scaled, b.zeta_xi),
                          q3 + dot(scaled, b.xi_eta),
                          q4};
  };
  ElementForces<R> result;
  result.x = row(s.xx, s.xy, s.zx, q.eta_zeta.x, q.zeta_xi.x, q.xi_eta.x, q.xi_eta_zeta.x);
  result.y = row(s.xy, s.yy, s.yz, q.eta_zeta.y, q.zeta_xi.y, q.xi_eta.y, q.xi_eta_zeta.y);
  result.z = row(s.zx, s.yz, s.zz, q.eta_zeta.z, q.zeta_xi.z, q.xi_eta.z, q.xi_eta_zeta.z);
  return result;
}

/// f_I = sigma b_I + viscous pressure + hourglass forces at the step's end; dt is the step's length for energies.
template <typename R, typename H, typename HourglassState>
TENON_KERNEL ElementForces<R> element_forces(const HexModes<R>& x, const HexModes<R>& v,
                                             const SymmetricTensor<R>& stress, const ElementReference<R>& reference,
                                             const Moduli<R>& moduli, const HexParameters<H>& p, HourglassState& state,
                                             int lane, double dt) {
  const MeanGradient<R> b = mean_gradient(x);
  const Tensor<R> l = velocity_gradient(v, b);
  const R volume = (1.0 / 192.0) * b.volume_192, inverse_volume = 192.0 / b.volume_192;
  const SymmetricTensor<R> g = gradient_products(b);
  const ElementScale<R> scale = element_scale(reference, volume, trace(g), moduli);

  const R rate = l.x.x + l.y.y + l.z.z;
  const R intensity = p.viscosity.intensity(scale, rate);
  const R viscous = p.viscosity.stress(scale, intensity, rate);
  const HourglassResult<R> hourglass =
      p.hourglass.template step<R>(x, hourglass_rates(x, v, l), scale, state, lane, dt);

  const R greatest = greatest_eigenvalue_bound(g);
  const R frequency = frequency_squared_bound(scale.trace_g, greatest, moduli, reference.mass, volume);
  const R step = damped_step(frequency, p.viscosity.damping(intensity), p.hourglass.damping(scale));
  const SymmetricTensor<R> d{l.x.x, l.y.y, l.z.z, 0.5 * (l.x.y + l.y.x), 0.5 * (l.y.z + l.z.y), 0.5 * (l.z.x + l.x.z)};
  const R bad = broadcast<R>(exploding_element), inverted = broadcast<R>(inverted_element);
  const R checked = (dt * dt) * squared_norm(d) < greatest_strain * greatest_strain ? step : bad;

  ElementForces<R> result = nodal_forces(x, b, inverse_volume,
                                         SymmetricTensor<R>{stress.xx + viscous, stress.yy + viscous,
                                                            stress.zz + viscous, stress.xy, stress.yz, stress.zx},
                                         hourglass.force);
  result.volume = volume;
  result.greatest = greatest;
  result.damping = p.viscosity.damping(intensity);
  result.step = volume > 0.0 ? checked : (volume <= 0.0 ? inverted : bad);
  result.viscosity_energy = dt * (viscous * rate * volume);
  result.hourglass_energy = hourglass.energy;
  return result;
}

/// (stiffness K + damping C) u: what the displacement u adds to the stress by the elastic moduli, its viscous pressure
/// at the present rate, and its hourglass forces. Forces due to the present stress (geometric stiffness) are left out.
template <typename R, typename H>
TENON_KERNEL ElementForces<R> tangent_forces(const HexModes<R>& x, const HexModes<R>& v, const HexModes<R>& u,
                                             const ElementReference<R>& reference, const Moduli<R>& moduli,
                                             const HexParameters<H>& p, double stiffness, const R& damping) {
  const MeanGradient<R> b = mean_gradient(x);
  const Tensor<R> l = velocity_gradient(v, b), e = velocity_gradient(u, b);
  const R volume = (1.0 / 192.0) * b.volume_192, inverse_volume = 192.0 / b.volume_192;
  const ElementScale<R> scale = element_scale(reference, volume, trace(gradient_products(b)), moduli);
  const R intensity = p.viscosity.intensity(scale, l.x.x + l.y.y + l.z.z);
  const R volumetric = e.x.x + e.y.y + e.z.z;
  const R mean = stiffness * (moduli.lambda * volumetric) + damping * p.viscosity.stress(scale, intensity, volumetric);
  const R shear = stiffness * moduli.shear, twice = shear + shear;
  const HourglassVectors<R> q = p.hourglass.template tangent<R>(x, hourglass_rates(x, u, e), scale, stiffness, damping);
  return nodal_forces(x, b, inverse_volume,
                      SymmetricTensor<R>{mean + twice * e.x.x, mean + twice * e.y.y, mean + twice * e.z.z,
                                         shear * (e.x.y + e.y.x), shear * (e.y.z + e.z.y), shear * (e.z.x + e.x.z)},
                      q);
}

/// Nodal forces of four elements, one row of x y z 0 per element and node.
TENON_KERNEL void store_rows(const ElementForces<Pack>& f, double (*rows)[8][pack_width]) {
  Pack x[8], y[8], z[8];
  from_modes(f.x, x);
  from_modes(f.y, y);
  from_modes(f.z, z);
#pragma GCC unroll 8
  for (int i = 0; i < 8; ++i) {
    Pack a = x[i], b = y[i], c = z[i], d = Pack{};
    transpose(a, b, c, d);
    store(rows[0][i], a), store(rows[1][i], b), store(rows[2][i], c), store(rows[3][i], d);
  }
}

/// Adds the forces of the first `count` elements of a batch to the nodes, element after element: the canonical order.
TENON_KERNEL void scatter(const double (*rows)[8][pack_width], const HexConnectivity& c, int count, double* force) {
  for (int l = 0; l < count; ++l) {
#pragma GCC unroll 8
    for (int i = 0; i < 8; ++i) {
      double* to = force + 4 * static_cast<std::ptrdiff_t>(c.node[i][l]);
      store(to, load(to) + load(rows[l][i]));
    }
  }
}

}  // namespace tenon

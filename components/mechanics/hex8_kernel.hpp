// SPDX-License-Identifier: BSD-3-Clause
// The one-point hexahedron on a batch: from nodal positions and velocities to strain, stress rotation and forces.
#pragma once

#include <cstdint>

#include "components/mechanics/bulk_viscosity.hpp"
#include "components/mechanics/kinematics.hpp"
#include "components/mechanics/stable_step.hpp"

namespace tenon {

/// Local node numbers of a batch of hexahedra.
struct alignas(64) HexConnectivity {
  std::int32_t node[8][lanes];
};

/// Nodal arrays of a rank. Vectors lie three doubles apart with one double of padding after the last; forces four
/// apart.
struct NodeArrays {
  const double* position;  ///< m
  const double* velocity;  ///< m/s
  double* force;           ///< internal, resisting: N
};

/// Codes in place of a stable step.
inline constexpr double inverted_element = -1;   ///< volume not positive
inline constexpr double exploding_element = -2;  ///< not a number, or strained beyond `greatest_strain` in one step
/// Far above what the step before an inversion shows (about 1), so that an inversion is called one.
inline constexpr double greatest_strain = 100;

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

TENON_KERNEL SymmetricTensor<Pack> load_tensor(const Batch<6>& s, int lane) {
  return {load(s[0] + lane), load(s[1] + lane), load(s[2] + lane),
          load(s[3] + lane), load(s[4] + lane), load(s[5] + lane)};
}
TENON_KERNEL void store_tensor(const SymmetricTensor<Pack>& t, Batch<6>& s, int lane) {
  store(s[0] + lane, t.xx), store(s[1] + lane, t.yy), store(s[2] + lane, t.zz);
  store(s[3] + lane, t.xy), store(s[4] + lane, t.yz), store(s[5] + lane, t.zx);
}

/// Internal forces of an element, and what is found on the way.
template <typename R>
struct ElementForces {
  ScalarModes<R> x, y, z;                ///< N; nodal forces by from_modes
  R volume;                              ///< m^3
  R step;                                ///< stable step, s, or a code
  R viscosity_energy, hourglass_energy;  ///< taken up in the step, J
};

/// What a block has in common.
template <typename H>
struct HexParameters {
  double lambda, shear;  ///< Lame constants, Pa
  BulkViscosity viscosity;
  H hourglass;
};

/// f_I = sigma b_I + viscous pressure + hourglass forces at the step's end; dt is the step's length for energies.
/// Hourglass forces Q_alpha act through gamma_alpha = h_alpha - 1/V sum_j (h_alpha . x_j) b_j, so the b part joins the
/// stress.
template <typename R, typename H, typename HourglassState>
TENON_KERNEL ElementForces<R> element_forces(const HexModes<R>& x, const HexModes<R>& v,
                                             const SymmetricTensor<R>& stress, const ElementReference<R>& reference,
                                             const HexParameters<H>& p, HourglassState& state, int lane, double dt) {
  const MeanGradient<R> b = mean_gradient(x);
  const Tensor<R> l = velocity_gradient(v, b);
  const R volume = (1.0 / 192.0) * b.volume_192, inverse_volume = 192.0 / b.volume_192;
  const SymmetricTensor<R> g = gradient_products(b);
  const ElementScale<R> scale = element_scale(reference, volume, trace(g), p.lambda + 2 * p.shear);

  const R rate = l.x.x + l.y.y + l.z.z;
  const R intensity = p.viscosity.intensity(scale, rate);
  const R viscous = p.viscosity.stress(scale, intensity, rate);
  const HourglassResult<R> hourglass = p.hourglass.template step<R>(hourglass_rates(x, v, l), scale, state, lane, dt);

  const R frequency = frequency_squared_bound(g, p.lambda, p.shear, reference.mass, volume);
  const R step = damped_step(frequency, p.viscosity.damping(intensity), p.hourglass.damping(scale));
  const SymmetricTensor<R> d{l.x.x, l.y.y, l.z.z, 0.5 * (l.x.y + l.y.x), 0.5 * (l.y.z + l.z.y), 0.5 * (l.z.x + l.x.z)};
  const R bad = broadcast<R>(exploding_element), inverted = broadcast<R>(inverted_element);
  const R checked = (dt * dt) * squared_norm(d) < greatest_strain * greatest_strain ? step : bad;

  const HourglassVectors<R>& q = hourglass.force;
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
  result.x = row(stress.xx + viscous, stress.xy, stress.zx, q.eta_zeta.x, q.zeta_xi.x, q.xi_eta.x, q.xi_eta_zeta.x);
  result.y = row(stress.xy, stress.yy + viscous, stress.yz, q.eta_zeta.y, q.zeta_xi.y, q.xi_eta.y, q.xi_eta_zeta.y);
  result.z = row(stress.zx, stress.yz, stress.zz + viscous, q.eta_zeta.z, q.zeta_xi.z, q.xi_eta.z, q.xi_eta_zeta.z);
  result.volume = volume;
  result.step = volume > 0.0 ? checked : (volume <= 0.0 ? inverted : bad);
  result.viscosity_energy = dt * (viscous * rate * volume);
  result.hourglass_energy = hourglass.energy;
  return result;
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

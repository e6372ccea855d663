// SPDX-License-Identifier: BSD-3-Clause
// Geometry of the one-point hexahedron: modes of nodal values, volume, volume-averaged gradient.
#pragma once

#include "components/mechanics/small_tensor.hpp"

namespace tenon {

/// Nodal values of a hexahedron as signed sums over its nodes: three linear modes (xi, eta, zeta), and the hourglass
/// modes eta zeta, zeta xi, xi eta, xi eta zeta ([FB81] gamma base vectors before projection). The sums are not
/// divided by 8. The mean is left out: nothing here depends on it.
template <typename R>
struct HexModes {
  Vector<R> xi, eta, zeta, eta_zeta, zeta_xi, xi_eta, xi_eta_zeta;
};

/// Modes of one component of nodal values in the node order of VTK: 23 additions.
template <typename R>
struct ScalarModes {
  R xi, eta, zeta, eta_zeta, zeta_xi, xi_eta, xi_eta_zeta;
};
template <typename R>
TENON_KERNEL ScalarModes<R> scalar_modes(const R (&u)[8]) {
  const R sum_01 = u[1] + u[0], sum_32 = u[2] + u[3], sum_45 = u[5] + u[4], sum_76 = u[6] + u[7];
  const R dif_01 = u[1] - u[0], dif_32 = u[2] - u[3], dif_45 = u[5] - u[4], dif_76 = u[6] - u[7];
  const R xi_low = dif_32 + dif_01, xi_high = dif_76 + dif_45;
  const R eta_low = sum_32 - sum_01, eta_high = sum_76 - sum_45;
  const R both_low = dif_32 - dif_01, both_high = dif_76 - dif_45;
  return {xi_high + xi_low,    eta_high + eta_low, (sum_76 + sum_45) - (sum_32 + sum_01),
          eta_high - eta_low,  xi_high - xi_low,   both_high + both_low,
          both_high - both_low};
}

/// The transpose: nodal values whose share of each mode is given.
template <typename R>
TENON_KERNEL void from_modes(const ScalarModes<R>& m, R (&u)[8]) {
  const R plain_low = -m.zeta, plain_high = m.zeta;
  const R xi_low = m.xi - m.zeta_xi, xi_high = m.xi + m.zeta_xi;
  const R eta_low = m.eta - m.eta_zeta, eta_high = m.eta + m.eta_zeta;
  const R both_low = m.xi_eta - m.xi_eta_zeta, both_high = m.xi_eta + m.xi_eta_zeta;
  const R even_0 = plain_low - eta_low, even_1 = plain_low + eta_low;
  const R even_2 = plain_high - eta_high, even_3 = plain_high + eta_high;
  const R odd_0 = xi_low - both_low, odd_1 = xi_low + both_low;
  const R odd_2 = xi_high - both_high, odd_3 = xi_high + both_high;
  u[0] = even_0 - odd_0, u[1] = even_0 + odd_0, u[2] = even_1 + odd_1, u[3] = even_1 - odd_1;
  u[4] = even_2 - odd_2, u[5] = even_2 + odd_2, u[6] = even_3 + odd_3, u[7] = even_3 - odd_3;
}

template <typename R>
TENON_KERNEL HexModes<R> hex_modes(const R (&x)[8], const R (&y)[8], const R (&z)[8]) {
  const ScalarModes<R> mx = scalar_modes(x), my = scalar_modes(y), mz = scalar_modes(z);
  return {{mx.xi, my.xi, mz.xi},
          {mx.eta, my.eta, mz.eta},
          {mx.zeta, my.zeta, mz.zeta},
          {mx.eta_zeta, my.eta_zeta, mz.eta_zeta},
          {mx.zeta_xi, my.zeta_xi, mz.zeta_xi},
          {mx.xi_eta, my.xi_eta, mz.xi_eta},
          {mx.xi_eta_zeta, my.xi_eta_zeta, mz.xi_eta_zeta}};
}

/// b_I = integral of grad N_I over the trilinear hexahedron, exact for any shape (the B matrix of [FB81]), by modes:
/// b_I = 1/64 (xi_I b.xi + eta_I b.eta + zeta_I b.zeta + eta_I zeta_I b.eta_zeta + ...). It follows from integrating
/// the cofactors of dx/dxi against dN_I/dxi; the mode xi eta zeta has no share.
template <typename R>
struct MeanGradient {
  Vector<R> xi, eta, zeta, eta_zeta, zeta_xi, xi_eta;
  R volume_192;  ///< 192 times the volume
};

template <typename R>
TENON_KERNEL MeanGradient<R> mean_gradient(const HexModes<R>& x) {
  const R third = broadcast<R>(1.0 / 3.0);
  const Vector<R> c1 = third * x.eta_zeta, c2 = third * x.zeta_xi, c3 = third * x.xi_eta;
  MeanGradient<R> b;
  b.xi = cross(x.eta, x.zeta) - cross(x.zeta_xi, c3);
  b.eta = cross(x.zeta, x.xi) - cross(x.xi_eta, c1);
  b.zeta = cross(x.xi, x.eta) - cross(x.eta_zeta, c2);
  b.eta_zeta = cross(x.zeta, c2) - cross(x.eta, c3);
  b.zeta_xi = cross(x.xi, c3) - cross(x.zeta, c1);
  b.xi_eta = cross(x.eta, c1) - cross(x.xi, c2);
  // 3 V = sum over nodes of x_I . b_I
  b.volume_192 = ((dot(x.xi, b.xi) + dot(x.eta, b.eta)) + dot(x.zeta, b.zeta)) +
                 ((dot(x.eta_zeta, b.eta_zeta) + dot(x.zeta_xi, b.zeta_xi)) + dot(x.xi_eta, b.xi_eta));
  return b;
}

/// L_ij = 1/V sum over nodes of v_iI b_jI, 1/s.
template <typename R>
TENON_KERNEL Tensor<R> velocity_gradient(const HexModes<R>& v, const MeanGradient<R>& b) {
  const R scale = 3.0 / b.volume_192;
  const auto row = [&](const R& xi, const R& eta, const R& zeta, const R& eta_zeta, const R& zeta_xi, const R& xi_eta) {
    const Vector<R> sum = ((xi * b.xi + eta * b.eta) + zeta * b.zeta) +
                          ((eta_zeta * b.eta_zeta + zeta_xi * b.zeta_xi) + xi_eta * b.xi_eta);
    return scale * sum;
  };
  return {row(v.xi.x, v.eta.x, v.zeta.x, v.eta_zeta.x, v.zeta_xi.x, v.xi_eta.x),
          row(v.xi.y, v.eta.y, v.zeta.y, v.eta_zeta.y, v.zeta_xi.y, v.xi_eta.y),
          row(v.xi.z, v.eta.z, v.zeta.z, v.eta_zeta.z, v.zeta_xi.z, v.xi_eta.z)};
}

/// G_ij = sum over nodes of b_iI b_jI, m^4.
template <typename R>
TENON_KERNEL SymmetricTensor<R> gradient_products(const MeanGradient<R>& b) {
  const auto sum = [&](auto component_1, auto component_2) {
    const auto term = [&](const Vector<R>& a) { return component_1(a) * component_2(a); };
    return (1.0 / 512.0) *
           (((term(b.xi) + term(b.eta)) + term(b.zeta)) + ((term(b.eta_zeta) + term(b.zeta_xi)) + term(b.xi_eta)));
  };
  const auto x = [](const Vector<R>& a) { return a.x; };
  const auto y = [](const Vector<R>& a) { return a.y; };
  const auto z = [](const Vector<R>& a) { return a.z; };
  return {sum(x, x), sum(y, y), sum(z, z), sum(x, y), sum(y, z), sum(z, x)};
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Hourglass control from the elastic energy of an assumed strain field: no coefficient to choose.
#pragma once

#include "components/mechanics/hourglass.hpp"

namespace tenon {

/// Assumed-strain stabilisation in the manner of [BB93] and [Pus00], in axes that turn with the element. What the
/// hourglass modes add to the strain of a parallelepiped, taken linear in one natural coordinate d, is the bending and
/// twisting of a plate normal to d: strains ii and kk and the shear ik. They get the stress of such a plate (normal
/// stress along d relaxed: modulus E/(1 - nu^2)), so bending is neither too stiff in shear nor locked in volume, and is
/// exact for a rectangular element. The shear between i and d that the same modes carry, which is what locks, is left
/// out, as are the shears of the mode xi eta zeta; its normal strains get Young's modulus.
///
/// Under plastic flow the stresses relax as the return mapping shrinks the trial deviator at the element's point: a
/// small deviation from the mean stress then flows as the mean does, transverse to it exactly so. Materials that do not
/// flow keep it all. Where moduli vary (rubber under strain, locking foam) it takes those that bound the stable step,
/// which are never too soft; orthotropic ones, whose bound is far off in bending, are refused.
struct PhysicalHourglass {
  static constexpr int state_size = 12;
  static constexpr bool uses_relaxation = true;

  /// Stresses, Pa: for each coordinate d the plate's ii, kk, ik with (d, i, k) cyclic; then ii of the mode xi eta zeta.
  template <typename R>
  struct Stresses {
    R plate[3][3];
    R last[3];
  };
  /// Axes of the element, and half its lengths along them.
  template <typename R>
  struct Frame {
    Tensor<R> axes;  ///< rows: unit vectors
    R inverse_half[3];
  };

  /// Orthonormal axes nearest to the natural ones (polar decomposition of their directions, by Newton's iteration
  /// [Hig86], exact from the start in a rectangular element).
  template <typename R>
  TENON_KERNEL static Frame<R> frame(const HexModes<R>& x) {
    const auto unit = [](const Vector<R>& a) { return (1.0 / square_root(dot(a, a))) * a; };
    Tensor<R> q{unit(x.xi), unit(x.eta), unit(x.zeta)};
    for (int i = 0; i < 4; ++i) {
      const Vector<R> cx = cross(q.y, q.z), cy = cross(q.z, q.x), cz = cross(q.x, q.y);
      const R inverse = 1.0 / dot(q.x, cx), half = broadcast<R>(0.5);
      q = {half * (q.x + inverse * cx), half * (q.y + inverse * cy), half * (q.z + inverse * cz)};
    }
    return {q, {8.0 / dot(x.xi, q.x), 8.0 / dot(x.eta, q.y), 8.0 / dot(x.zeta, q.z)}};
  }

  /// Strains of the hourglass part u of a displacement, as Stresses lists them.
  template <typename R>
  TENON_KERNEL static Stresses<R> strains(const Frame<R>& f, const HourglassVectors<R>& u) {
    const R eighth = broadcast<R>(0.125);
    // q[alpha][i]: component i of mode alpha, alpha the coordinate that the mode lacks.
    const Vector<R> modes[4] = {eighth * (f.axes * u.eta_zeta), eighth * (f.axes * u.zeta_xi),
                                eighth * (f.axes * u.xi_eta), eighth * (f.axes * u.xi_eta_zeta)};
    const auto q = [&](int i, int alpha) -> const R& {
      return i == 0 ? modes[alpha].x : (i == 1 ? modes[alpha].y : modes[alpha].z);
    };
    Stresses<R> e;
#pragma GCC unroll 3
    for (int d = 0; d < 3; ++d) {
      const int i = (d + 1) % 3, k = (d + 2) % 3;
      e.plate[d][0] = f.inverse_half[i] * q(i, k);
      e.plate[d][1] = f.inverse_half[k] * q(k, i);
      e.plate[d][2] = f.inverse_half[k] * q(i, i) + f.inverse_half[i] * q(k, k);
      e.last[d] = f.inverse_half[d] * q(d, 3);
    }
    return e;
  }

  template <typename R>
  TENON_KERNEL static Stresses<R> elastic(const Moduli<R>& m, const Stresses<R>& e) {
    const R young = m.shear * (3.0 * m.lambda + 2.0 * m.shear) / (m.lambda + m.shear);
    // E/(1 - nu^2) and nu E/(1 - nu^2).
    const R plate = 4.0 * m.shear * (m.lambda + m.shear) / (m.lambda + 2.0 * m.shear);
    const R cross_plate = 2.0 * m.shear * m.lambda / (m.lambda + 2.0 * m.shear);
    Stresses<R> s;
#pragma GCC unroll 3
    for (int d = 0; d < 3; ++d) {
      s.plate[d][0] = plate * e.plate[d][0] + cross_plate * e.plate[d][1];
      s.plate[d][1] = plate * e.plate[d][1] + cross_plate * e.plate[d][0];
      s.plate[d][2] = m.shear * e.plate[d][2];
      s.last[d] = young * e.last[d];
    }
    return s;
  }

  /// The transpose of `strains`, with the integrals of the squared coordinates, V/3, and of their products, V/9.
  template <typename R>
  TENON_KERNEL static HourglassVectors<R> forces(const Frame<R>& f, const Stresses<R>& s, const R& volume) {
    const R third = volume * (0.125 / 3.0), ninth = volume * (0.125 / 9.0);
    R q[4][3];
#pragma GCC unroll 3
    for (int d = 0; d < 3; ++d) {
      const int i = (d + 1) % 3, k = (d + 2) % 3;
      q[k][i] = third * f.inverse_half[i] * s.plate[d][0];
      q[i][k] = third * f.inverse_half[k] * s.plate[d][1];
      q[3][d] = ninth * f.inverse_half[d] * s.last[d];
      // Twist of the plates normal to i and to k.
      q[d][d] = third * (f.inverse_half[i] * s.plate[k][2] + f.inverse_half[k] * s.plate[i][2]);
    }
    const auto global = [&](const R(&local)[3]) {
      return local[0] * f.axes.x + local[1] * f.axes.y + local[2] * f.axes.z;
    };
    return {global(q[0]), global(q[1]), global(q[2]), global(q[3])};
  }

  template <typename R>
  TENON_KERNEL static Stresses<R> read(const Batch<12>& state, int lane) {
    Stresses<R> s;
    for (int d = 0; d < 3; ++d) {
      for (int c = 0; c < 3; ++c) s.plate[d][c] = load_as<R>(state[3 * d + c] + lane);
      s.last[d] = load_as<R>(state[9 + d] + lane);
    }
    return s;
  }
  template <typename R>
  TENON_KERNEL static void write(const Stresses<R>& s, Batch<12>& state, int lane) {
    for (int d = 0; d < 3; ++d) {
      for (int c = 0; c < 3; ++c) store_as(state[3 * d + c] + lane, s.plate[d][c]);
      store_as(state[9 + d] + lane, s.last[d]);
    }
  }

  /// Nothing: the stresses are those in the element's own axes.
  template <typename R>
  TENON_KERNEL void rotate(const Tensor<R>&, Batch<12>&, int) const {}

  template <typename R>
  TENON_KERNEL HourglassResult<R> step(const HexModes<R>& x, const HourglassVectors<R>& rate, const ElementScale<R>& s,
                                       Batch<12>& state, int lane, double dt) const {
    const Frame<R> f = frame(x);
    const Stresses<R> old = read<R>(state, lane), more = elastic(s.moduli, strains(f, rate));
    Stresses<R> now;
    for (int d = 0; d < 3; ++d) {
      for (int c = 0; c < 3; ++c) now.plate[d][c] = s.relaxation * (old.plate[d][c] + dt * more.plate[d][c]);
      now.last[d] = s.relaxation * (old.last[d] + dt * more.last[d]);
    }
    write(now, state, lane);
    const HourglassVectors<R> before = forces(f, old, s.volume), after = forces(f, now, s.volume);
    return {after, (0.5 * dt) * (product(before, rate) + product(after, rate))};
  }
  template <typename R>
  TENON_KERNEL HourglassVectors<R> tangent(const HexModes<R>& x, const HourglassVectors<R>& u, const ElementScale<R>& s,
                                           double stiffness, const R&) const {
    const Frame<R> f = frame(x);
    return scaled(broadcast<R>(stiffness), forces(f, elastic(s.moduli, strains(f, u)), s.volume));
  }
  template <typename R>
  TENON_KERNEL R damping(const ElementScale<R>&) const {
    return R{};
  }
};

}  // namespace tenon

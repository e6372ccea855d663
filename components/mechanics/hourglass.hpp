// SPDX-License-Identifier: BSD-3-Clause
// Resistance to the hourglass modes of the one-point hexahedron. A form is a type; more can be added beside these.
#pragma once

#include <concepts>

#include "components/mechanics/hex8_mean_gradient.hpp"

namespace tenon {

/// One vector for each of the hourglass modes eta zeta, zeta xi, xi eta, xi eta zeta.
template <typename R>
struct HourglassVectors {
  Vector<R> eta_zeta, zeta_xi, xi_eta, xi_eta_zeta;
};

/// Rates gamma_alpha . v of [FB81]: the part of the velocity that no linear field explains, so any linear field
/// gives zero on any shape. Here gamma . v = h . v - L (h . x). Not divided by 8, m/s.
template <typename R>
TENON_KERNEL HourglassVectors<R> hourglass_rates(const HexModes<R>& x, const HexModes<R>& v, const Tensor<R>& l) {
  return {v.eta_zeta - l * x.eta_zeta, v.zeta_xi - l * x.zeta_xi, v.xi_eta - l * x.xi_eta,
          v.xi_eta_zeta - l * x.xi_eta_zeta};
}

template <typename R>
TENON_KERNEL R product(const HourglassVectors<R>& a, const HourglassVectors<R>& b) {
  return (dot(a.eta_zeta, b.eta_zeta) + dot(a.zeta_xi, b.zeta_xi)) +
         (dot(a.xi_eta, b.xi_eta) + dot(a.xi_eta_zeta, b.xi_eta_zeta));
}

template <typename R>
TENON_KERNEL HourglassVectors<R> scaled(const R& s, const HourglassVectors<R>& a) {
  return {s * a.eta_zeta, s * a.zeta_xi, s * a.xi_eta, s * a.xi_eta_zeta};
}

/// Lame constants, Pa.
template <typename R>
struct Moduli {
  R lambda, shear;
};

/// What a form may need to know of the element.
template <typename R>
struct ElementScale {
  R mass;       ///< kg
  R volume;     ///< m^3
  R trace_g;    ///< sum of b_I . b_I, m^4
  R wave_rate;  ///< c/L: dilatational wave speed over the shortest length of the element, 1/s
  R size_rate;  ///< c/V0^(1/3): the same over its size before deformation, 1/s
  R modulus;    ///< lambda + 2 mu, Pa
  Moduli<R> moduli;
  R relaxation;  ///< what the step's plastic flow left of the elastic trial deviator, 1 if it was elastic
};

/// What an element keeps of its undeformed state.
template <typename R>
struct ElementReference {
  R mass;        ///< kg
  R size;        ///< V0^(1/3), m
  R relaxation;  ///< of the step, for ElementScale
};

/// L^2 = 3 V^2/(2 tr G): the harmonic mean of the squared edges of a box, so the shortest edge rules; h for a cube.
/// c/L = sqrt((lambda + 2 mu)/rho)/L = sqrt(2 (lambda + 2 mu) tr G/(3 m V)).
template <typename R>
TENON_KERNEL ElementScale<R> element_scale(const ElementReference<R>& reference, const R& volume, const R& trace_g,
                                           const Moduli<R>& moduli) {
  const R modulus = moduli.lambda + 2.0 * moduli.shear;
  const R stiffness = modulus / reference.mass;
  return {reference.mass,
          volume,
          trace_g,
          square_root((2.0 / 3.0) * stiffness * trace_g / volume),
          square_root(stiffness * volume) / reference.size,
          modulus,
          moduli,
          reference.relaxation};
}

/// Generalised forces Q_alpha, and the energy that they took up in the step, J.
template <typename R>
struct HourglassResult {
  HourglassVectors<R> force;
  R energy;
};

/// A form of hourglass control. `state_size` values per element are kept; `rotate` turns them with the material. `step`
/// gives the forces at the end of a step of length dt (0: as they are, nothing changes), for the modes x of the present
/// geometry. `damping` is the greatest eigenvalue of M^-1 C, 1/s, that it adds to the hourglass modes. `tangent` gives
/// the forces that u, taken as displacement, would add: (stiffness K + damping C) u, from the moduli alone.
/// `uses_relaxation` says whether ElementScale::relaxation must be found.
template <typename H>
concept HourglassForm = requires(const H form, const HexModes<double>& x, const HourglassVectors<double>& rates,
                                 const ElementScale<double>& scale,
                                 Batch<(H::state_size > 0 ? H::state_size : 1)>& state,
                                 const Tensor<double>& rotation) {
  { H::state_size } -> std::convertible_to<int>;
  { H::uses_relaxation } -> std::convertible_to<bool>;
  form.template rotate<double>(rotation, state, 0);
  { form.template step<double>(x, rates, scale, state, 0, 0.0) } -> std::same_as<HourglassResult<double>>;
  { form.damping(scale) } -> std::same_as<double>;
  { form.template tangent<double>(x, rates, scale, 1.0, 1.0) } -> std::same_as<HourglassVectors<double>>;
};

template <typename R>
TENON_KERNEL R load_as(const double* from) {
  if constexpr (sizeof(R) == sizeof(double))
    return *from;
  else
    return load(from);
}
TENON_KERNEL void store_as(double* to, double value) {
  *to = value;
}
TENON_KERNEL void store_as(double* to, const Pack& value) {
  store(to, value);
}

/// No control: for tests, and for motions that have no hourglass part.
struct NoHourglass {
  static constexpr int state_size = 0;
  static constexpr bool uses_relaxation = false;
  template <typename R>
  TENON_KERNEL void rotate(const Tensor<R>&, Batch<1>&, int) const {}
  template <typename R>
  TENON_KERNEL HourglassResult<R> step(const HexModes<R>&, const HourglassVectors<R>&, const ElementScale<R>&,
                                       Batch<1>&, int, double) const {
    const Vector<R> zero{R{}, R{}, R{}};
    return {{zero, zero, zero, zero}, R{}};
  }
  template <typename R>
  TENON_KERNEL HourglassVectors<R> tangent(const HexModes<R>&, const HourglassVectors<R>&, const ElementScale<R>&,
                                           double, const R&) const {
    const Vector<R> zero{R{}, R{}, R{}};
    return {zero, zero, zero, zero};
  }
  template <typename R>
  TENON_KERNEL R damping(const ElementScale<R>&) const {
    return R{};
  }
};

/// [FB81] viscous form: Q = coefficient m c/(4 V0^(1/3)) gamma . v, that is rho c V^(2/3)/4 as usual while the volume
/// changes little. With the shortest length instead, elements flattened by plastic flow would be held three times too
/// hard. It has no memory, so it cannot store what plastic flow should have dissipated: right for plasticity.
struct ViscousHourglass {
  static constexpr int state_size = 0;
  static constexpr bool uses_relaxation = false;
  double coefficient = 0.03;

  template <typename R>
  TENON_KERNEL void rotate(const Tensor<R>&, Batch<1>&, int) const {}
  template <typename R>
  TENON_KERNEL HourglassResult<R> step(const HexModes<R>&, const HourglassVectors<R>& rate, const ElementScale<R>& s,
                                       Batch<1>&, int, double dt) const {
    const R c = (0.25 * coefficient) * s.mass * s.size_rate;
    return {scaled(c, rate), dt * (c * product(rate, rate))};
  }
  template <typename R>
  TENON_KERNEL HourglassVectors<R> tangent(const HexModes<R>&, const HourglassVectors<R>& u, const ElementScale<R>& s,
                                           double, const R& damping) const {
    return scaled((0.25 * coefficient) * damping * s.mass * s.size_rate, u);
  }
  /// 8 nodes of mass m/8, |gamma|^2 = 8: 64 c/m.
  template <typename R>
  TENON_KERNEL R damping(const ElementScale<R>& s) const {
    return (16.0 * coefficient) * s.size_rate;
  }
};

/// [FB81] stiffness form: dQ/dt = coefficient (lambda + 2 mu) tr G/(64 V) gamma . v in a frame that rotates with the
/// element; coefficient is that of gamma vectors of length one, as usual. For elastic bodies; under plastic flow it
/// stores what should be dissipated (the foot of a Taylor bar stays too small).
struct StiffnessHourglass {
  static constexpr int state_size = 12;
  static constexpr bool uses_relaxation = false;
  double coefficient = 0.05;

  template <typename R>
  TENON_KERNEL static HourglassVectors<R> read(const Batch<12>& state, int lane) {
    const auto vector = [&](int i) {
      return Vector<R>{load_as<R>(state[3 * i] + lane), load_as<R>(state[3 * i + 1] + lane),
                       load_as<R>(state[3 * i + 2] + lane)};
    };
    return {vector(0), vector(1), vector(2), vector(3)};
  }
  template <typename R>
  TENON_KERNEL static void write(const HourglassVectors<R>& q, Batch<12>& state, int lane) {
    const auto vector = [&](int i, const Vector<R>& a) {
      store_as(state[3 * i] + lane, a.x), store_as(state[3 * i + 1] + lane, a.y),
          store_as(state[3 * i + 2] + lane, a.z);
    };
    vector(0, q.eta_zeta), vector(1, q.zeta_xi), vector(2, q.xi_eta), vector(3, q.xi_eta_zeta);
  }
  template <typename R>
  TENON_KERNEL void rotate(const Tensor<R>& r, Batch<12>& state, int lane) const {
    const HourglassVectors<R> q = read<R>(state, lane);
    write<R>({r * q.eta_zeta, r * q.zeta_xi, r * q.xi_eta, r * q.xi_eta_zeta}, state, lane);
  }
  template <typename R>
  TENON_KERNEL HourglassResult<R> step(const HexModes<R>&, const HourglassVectors<R>& rate, const ElementScale<R>& s,
                                       Batch<12>& state, int lane, double dt) const {
    const HourglassVectors<R> old = read<R>(state, lane);
    const R k = (coefficient * dt / 64.0) * s.modulus * s.trace_g / s.volume;
    const HourglassVectors<R> now{old.eta_zeta + k * rate.eta_zeta, old.zeta_xi + k * rate.zeta_xi,
                                  old.xi_eta + k * rate.xi_eta, old.xi_eta_zeta + k * rate.xi_eta_zeta};
    write<R>(now, state, lane);
    return {now, (0.5 * dt) * (product(old, rate) + product(now, rate))};
  }
  template <typename R>
  TENON_KERNEL HourglassVectors<R> tangent(const HexModes<R>&, const HourglassVectors<R>& u, const ElementScale<R>& s,
                                           double stiffness, const R&) const {
    return scaled((coefficient * stiffness / 64.0) * s.modulus * s.trace_g / s.volume, u);
  }
  template <typename R>
  TENON_KERNEL R damping(const ElementScale<R>&) const {
    return R{};
  }
};

}  // namespace tenon

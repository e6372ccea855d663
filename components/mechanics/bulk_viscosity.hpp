// SPDX-License-Identifier: BSD-3-Clause
// Artificial pressure that spreads shocks over a few elements and damps ringing behind them.
#pragma once

#include "components/mechanics/hourglass.hpp"

namespace tenon {

/// Mean stress rho L (linear c r + quadratic L r |r|), r = rate of volume strain; the quadratic part in compression
/// only. The coefficients are those of LS-DYNA (*CONTROL_BULK_VISCOSITY Q2 and Q1; [vNR50], [Lan55]); the linear part
/// acts in expansion as well, as in Abaqus/Explicit, so that it damps and does not rectify.
struct BulkViscosity {
  double linear = 0.06;
  double quadratic = 1.5;

  /// linear c/L + quadratic max(-r, 0), 1/s.
  template <typename R>
  TENON_KERNEL R intensity(const ElementScale<R>& s, const R& rate) const {
    return linear * s.wave_rate + quadratic * greater_of(-rate, broadcast<R>(0.0));
  }
  /// Mean stress rho L^2 intensity r, Pa, tension positive; rho L^2 = 3 m V/(2 tr G).
  template <typename R>
  TENON_KERNEL R stress(const ElementScale<R>& s, const R& intensity, const R& rate) const {
    return (1.5 * s.mass * s.volume / s.trace_g) * (intensity * rate);
  }
  /// Greatest eigenvalue of M^-1 C: 8 eta tr G/(m V) with eta = rho L^2 intensity, 1/s.
  template <typename R>
  TENON_KERNEL R damping(const R& intensity) const {
    return 12.0 * intensity;
  }
};

}  // namespace tenon

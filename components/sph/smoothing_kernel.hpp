// SPDX-License-Identifier: BSD-3-Clause
// Smoothing kernels: W(r, h) = sigma/h^d w(q), q = r/h.
#pragma once

#include <concepts>
#include <numbers>

#include "framework/base/wide_pack.hpp"

namespace tenon {

/// A kernel by its shape: `support` is where it ends, in h; `w(q)` its value and `slope(q)` w'(q)/q, finite at q = 0;
/// both zero beyond the support. R is double or a pack. `sigma(d)` makes its integral over d dimensions one.
template <typename K>
concept SphKernel = requires(const WidePack& q, int dimension) {
  { K::support } -> std::convertible_to<double>;
  { K::sigma(dimension) } -> std::convertible_to<double>;
  { K::template w<3>(q) } -> std::convertible_to<WidePack>;
  { K::template slope<3>(q) } -> std::convertible_to<WidePack>;
};

namespace kernel_detail {
template <typename R>
TENON_KERNEL R above_zero(const R& x) {
  return greater_of<R>(x, R{});
}
template <typename R>
TENON_KERNEL R squared(const R& x) {
  return x * x;
}
}  // namespace kernel_detail

/// Cubic B-spline [ML85].
struct CubicSpline {
  static constexpr double support = 2;
  static constexpr double sigma(int d) {
    return d == 1 ? 2.0 / 3 : d == 2 ? 10 / (7 * std::numbers::pi) : 1 / std::numbers::pi;
  }
  // w = 1/4 (2-q)^3 - (1-q)^3, each where it is positive.
  template <int, typename R>
  TENON_KERNEL static R w(const R& q) {
    const R a = kernel_detail::above_zero<R>(2.0 - q), b = kernel_detail::above_zero<R>(1.0 - q);
    return 0.25 * a * a * a - b * b * b;
  }
  template <int, typename R>
  TENON_KERNEL static R slope(const R& q) {
    const R a = kernel_detail::above_zero<R>(2.0 - q);
    return q < 1.0 ? 2.25 * q - 3.0 : -0.75 * a * a / greater_of<R>(q, R{} + 1.0);
  }
};

/// Wendland's C2 function [Wen95]; in one dimension the one that is positive definite there.
struct WendlandC2 {
  static constexpr double support = 2;
  static constexpr double sigma(int d) {
    return d == 1 ? 5.0 / 8 : d == 2 ? 7 / (4 * std::numbers::pi) : 21 / (16 * std::numbers::pi);
  }
  template <int d, typename R>
  TENON_KERNEL static R w(const R& q) {
    const R t = kernel_detail::above_zero<R>(1.0 - 0.5 * q);
    if constexpr (d == 1)
      return t * t * t * (1.5 * q + 1.0);
    else
      return kernel_detail::squared<R>(t * t) * (2.0 * q + 1.0);
  }
  template <int d, typename R>
  TENON_KERNEL static R slope(const R& q) {
    const R t = kernel_detail::above_zero<R>(1.0 - 0.5 * q);
    if constexpr (d == 1)
      return -3.0 * t * t;
    else
      return -5.0 * t * t * t;
  }
};

/// Wendland's C4 function [Wen95].
struct WendlandC4 {
  static constexpr double support = 2;
  static constexpr double sigma(int d) {
    return d == 1 ? 3.0 / 4 : d == 2 ? 9 / (4 * std::numbers::pi) : 495 / (256 * std::numbers::pi);
  }
  template <int d, typename R>
  TENON_KERNEL static R w(const R& q) {
    const R t = kernel_detail::above_zero<R>(1.0 - 0.5 * q), t2 = t * t;
    if constexpr (d == 1)
      return t2 * t2 * t * ((2.0 * q + 2.5) * q + 1.0);
    else
      return t2 * t2 * t2 * ((35.0 / 12 * q + 3.0) * q + 1.0);
  }
  template <int d, typename R>
  TENON_KERNEL static R slope(const R& q) {
    const R t = kernel_detail::above_zero<R>(1.0 - 0.5 * q), t2 = t * t;
    if constexpr (d == 1)
      return -3.5 * t2 * t2 * (2.0 * q + 1.0);
    else
      return -14.0 / 3 * t2 * t2 * t * (2.5 * q + 1.0);
  }
};

/// Quintic B-spline [MFZ97].
struct QuinticSpline {
  static constexpr double support = 3;
  static constexpr double sigma(int d) {
    return d == 1 ? 1.0 / 120 : d == 2 ? 7 / (478 * std::numbers::pi) : 1 / (120 * std::numbers::pi);
  }
  template <int, typename R>
  TENON_KERNEL static R w(const R& q) {
    const R a = kernel_detail::above_zero<R>(3.0 - q), b = kernel_detail::above_zero<R>(2.0 - q),
            c = kernel_detail::above_zero<R>(1.0 - q);
    const R a2 = a * a, b2 = b * b, c2 = c * c;
    return a2 * a2 * a - 6.0 * (b2 * b2 * b) + 15.0 * (c2 * c2 * c);
  }
  // Within the first interval the polynomial divided by q, so that nothing is lost near zero.
  template <int, typename R>
  TENON_KERNEL static R slope(const R& q) {
    const R a = kernel_detail::above_zero<R>(3.0 - q), b = kernel_detail::above_zero<R>(2.0 - q);
    const R a2 = a * a, b2 = b * b;
    return q < 1.0 ? (-50.0 * q + 120.0) * (q * q) - 120.0
                   : -5.0 * (a2 * a2 - 6.0 * (b2 * b2)) / greater_of<R>(q, R{} + 1.0);
  }
};

static_assert(SphKernel<CubicSpline> && SphKernel<WendlandC2> && SphKernel<WendlandC4> && SphKernel<QuinticSpline>);

}  // namespace tenon

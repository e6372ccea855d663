// SPDX-License-Identifier: BSD-3-Clause
// Where a point lies in an element, by brute force in extended precision: Newton from many places, with shape functions
// of its own.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/mesh/topology.hpp"

namespace tenon::transfer::testing {

using Extended = long double;  ///< 64 binary digits at least: 2,000 times finer than double
using Extended3 = std::array<Extended, 3>;

/// A value and its derivatives by three variables.
struct Dual {
  Extended v = 0;
  Extended3 d{};
  Dual(Extended value = 0) : v(value) {}

  friend Dual operator+(Dual a, const Dual& b) {
    a.v += b.v;
    for (std::size_t i = 0; i < 3; ++i) a.d[i] += b.d[i];
    return a;
  }
  friend Dual operator-(Dual a, const Dual& b) {
    a.v -= b.v;
    for (std::size_t i = 0; i < 3; ++i) a.d[i] -= b.d[i];
    return a;
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual p(a.v * b.v);
    for (std::size_t i = 0; i < 3; ++i) p.d[i] = a.v * b.d[i] + a.d[i] * b.v;
    return p;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    Dual q(a.v / b.v);
    for (std::size_t i = 0; i < 3; ++i) q.d[i] = (a.d[i] - q.v * b.d[i]) / b.v;
    return q;
  }
};

/// The solution of x(xi) = point that lies deepest in the element, and how sure double precision can be of it.
struct OraclePlace {
  Extended3 xi{};
  Extended overshoot = 0;  ///< half widths outside; below 0: depth inside
  Extended stretch = 0;    ///< greatest row sum of |d xi / d x|, 1/m
};

class ExtendedOracle {
 public:
  ExtendedOracle(ElementKind kind, std::span<const Vec3> nodes);
  Extended3 position(const Extended3& xi) const;
  Extended determinant(const Extended3& xi) const;
  /// Half widths outside, below 0 within.
  static Extended overshoot(ElementKind kind, const Extended3& xi);
  /// From one place; empty if it does not converge.
  std::optional<OraclePlace> from(const Vec3& point, const Extended3& start) const;
  /// From a lattice of n places in every direction all over the element, until one is inside; empty if none converges.
  std::optional<OraclePlace> find(const Vec3& point, int n) const;

 private:
  std::array<Dual, 3> map(const Extended3& xi) const;
  ElementKind kind_;
  std::vector<Extended3> x_;
  Extended size_ = 0;
};

}  // namespace tenon::transfer::testing

// SPDX-License-Identifier: BSD-3-Clause
// The weights by which values at scattered points give that of the moving least squares fit at one point.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "framework/base/types.hpp"

namespace tenon::transfer {

/// How a fit is kept in bounds.
struct FitRules {
  /// The sum of the absolute weights (the Lebesgue constant) is at most 1 + this. Where the full fit needs more, as far
  /// outside the points or off a nearly flat cloud, it is evaluated at the nearest place where it does not.
  double trust = 6;
  /// No weight below zero: the slope is reduced as far as that needs, so values stay within those of the neighbours.
  bool non_negative = false;
};

/// What became of a fit.
struct FitOutcome {
  double distance = 0;     ///< to the nearest point, m
  double spacing = 0;      ///< of the points around, m; 0 if all neighbours coincide
  bool exact = false;      ///< linear fields are reproduced in all three directions
  bool deficient = false;  ///< they could not be, for want of points in some direction
  bool among = false;      ///< t lies among the points, which extend in all directions
};

inline constexpr std::size_t max_neighbours = 64;

/// A linear fit by least squares about a point t with weights that fall to zero at the farthest neighbour [LS81],
/// [Lev98]. With the weighted mean m and covariance C of the neighbours (relative to t, in units of their radius) the
/// weight of neighbour i is w_i (1 - m . C^-1 (y_i - m)); so the sum of the weights is 1 and sum w_i y_i = 0 whatever
/// C^-1 stands for, as long as it inverts C on the directions in which the points extend. In others (points on a line,
/// in a plane, at one place) the fit is constant. |C^-1/2 m| bounds the sum of the absolute weights: that is `trust`.
///
/// `neighbours`: relative to t, m, at most max_neighbours of them and at least one, in an order that depends on nothing
/// but the points; `all`: whether there are no others. Writes a weight for each; their sum is 1 to an ulp.
FitOutcome linear_fit(std::span<const Vec3> neighbours, bool all, const FitRules& rules, std::span<double> weights);

}  // namespace tenon::transfer

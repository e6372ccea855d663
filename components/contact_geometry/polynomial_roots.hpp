// SPDX-License-Identifier: BSD-3-Clause
// Real roots of a polynomial in the unit interval.
#pragma once

#include <array>

namespace tenon::contact {

inline constexpr int quintic_coefficients = 6;

/// Roots in [0, 1] of the polynomial sum c[i] x^i of degree five, ascending; returns how many. Isolated by the signs of
/// Bernstein coefficients and halving [LR81], so none is missed; one of even multiplicity may be found or not.
int roots_in_unit_interval(const std::array<double, quintic_coefficients>& c,
                           std::array<double, quintic_coefficients - 1>& roots);

}  // namespace tenon::contact

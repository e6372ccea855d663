// SPDX-License-Identifier: BSD-3-Clause
// Cross section of a block of shells: thickness, integration points and the place of the nodes in it.
#pragma once

#include <functional>
#include <vector>

#include "framework/base/types.hpp"

namespace tenon {

struct ShellSection {
  enum class Rule { gauss, lobatto };
  /// Where the nodes lie.
  enum class Reference { middle, top, bottom, at };

  double thickness = 0;                                         ///< m
  std::function<double(const Vec3& position)> thickness_field;  ///< instead, at the centre of each element, m
  int points = 0;                                               ///< through the thickness, 1..10; 0: 3 elastic, else 5
  Rule rule = Rule::gauss;
  Reference reference = Reference::middle;
  double offset = 0;  ///< of the middle surface from the nodes along the normal if `at`, m

  bool given() const { return thickness > 0 || thickness_field; }
};

/// A rule on -1 <= z <= 1 with weights of sum 1, ascending.
struct ThroughThickness {
  std::vector<double> place, weight;
  /// Integral of (z/2)^2: 1/12 from two Gauss or three Lobatto points on, 0 for one point.
  double second_moment() const;
};

/// Exact for polynomials of degree 2 n - 1 (Gauss, n >= 1) and 2 n - 3 (Lobatto, n >= 3: both faces are points).
ThroughThickness through_thickness(ShellSection::Rule rule, int points);

}  // namespace tenon

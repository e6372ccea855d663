// SPDX-License-Identifier: BSD-3-Clause
// Shape functions, quadrature and polynomial maps of hex20 (serendipity) and tet10. Private to the room.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/mesh/shape_functions.hpp"

namespace tenon::second_order {

/// Local coordinates of the nodes.
extern const std::array<Vec3, 20> hex20_nodes;
extern const std::array<Vec3, 10> tet10_nodes;

void hex20_values(const Vec3& xi, std::span<double> values);
void hex20_gradients(const Vec3& xi, std::span<Vec3> gradients);
void tet10_values(const Vec3& xi, std::span<double> values);
void tet10_gradients(const Vec3& xi, std::span<Vec3> gradients);

/// 3 x 3 x 3 Gauss-Legendre: exact to degree 5 in each coordinate.
std::vector<QuadraturePoint> hex20_rule();
/// 14 points, degree 5 [Wal00].
std::vector<QuadraturePoint> tet10_rule();

/// Box of the control points of the element in Bezier form: it holds every point of it.
Box bezier_box(ElementKind kind, std::span<const Vec3> nodes);

/// The map of an element as a polynomial in s = xi - centre, seen from a point: zero where x(xi) = point.
class Map {
 public:
  Map(ElementKind kind, std::span<const Vec3> nodes, const Vec3& point);
  Vec3 value(const Vec3& xi) const;
  std::array<Vec3, 3> jacobian(const Vec3& xi) const;
  /// Whether the map is proven one-to-one for all |xi - centre| <= reach in each coordinate: preconditioned with the
  /// Jacobian at the centre, it differs from the identity by a contraction.
  bool is_injective_within(double reach) const;

  double noise = 0;  ///< residual that is round-off, m

 private:
  /// The powers of the monomials: 1, then the three of first degree, then the others.
  static constexpr std::size_t most_terms = 20;
  Vec3 centre_{};
  std::size_t terms_;
  std::array<Vec3, most_terms> coefficient_;
};

}  // namespace tenon::second_order

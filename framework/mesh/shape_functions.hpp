// SPDX-License-Identifier: BSD-3-Clause
// Shape functions, their gradients, quadrature and the inverse map of the element kinds.
#pragma once

#include <array>
#include <span>

#include "framework/base/box.hpp"
#include "framework/base/types.hpp"
#include "framework/mesh/topology.hpp"

namespace tenon {

/// Values N_a and derivatives dN_a/dxi_j at local coordinates xi. hex8: xi in [-1,1]^3; tet4: xi >= 0, sum <= 1.
/// wedge6: (xi,eta) a triangle as tet4, zeta in [-1,1]; quad4: [-1,1]^2; tri3 as tet4. pyramid5: base [-1,1]^2, zeta in
/// [0,1], |xi| and |eta| <= 1 - zeta, rational functions that fit hex8 and tet4 beside it [Bed92]. hex20 (serendipity)
/// and tet10 as hex8 and tet4, complete to the second degree; nodes in the middle of the reference element's edges.
void shape_values(ElementKind kind, const Vec3& xi, std::span<double> values);
void shape_gradients(ElementKind kind, const Vec3& xi, std::span<Vec3> gradients);

/// Local coordinates of the nodes.
std::span<const Vec3> local_nodes(ElementKind kind);
/// Local coordinates of the centre, where all solids are evaluated with one point.
Vec3 element_centre(ElementKind kind);

/// Quadrature points and weights that integrate the mass matrix of an undistorted element exactly.
struct QuadraturePoint {
  Vec3 xi;
  double weight;
};
std::span<const QuadraturePoint> quadrature(ElementKind kind);

/// x(xi), m.
Vec3 map_to_space(ElementKind kind, std::span<const Vec3> corners, const Vec3& xi);
/// det(dx/dxi) of a solid, m^3.
double jacobian_determinant(ElementKind kind, std::span<const Vec3> corners, const Vec3& xi);
/// Exact volume of a solid (trilinear for hex8), area of a surface element.
double element_measure(ElementKind kind, std::span<const Vec3> corners);
/// A box that holds the element: that of the nodes, but for hex20 and tet10, whose sides bulge beyond their nodes, that
/// of the Bezier control points.
Box element_box(ElementKind kind, std::span<const Vec3> nodes);

/// Result of inverting x(xi) = point.
struct InverseMap {
  Vec3 xi{};               ///< where the point is; outside the reference element if the point is outside
  bool converged = false;  ///< Newton reached round-off
};
/// Safeguarded Newton from the centre, with restarts should it end on a folded branch of the map, or, with curved
/// edges, outside the element where that may not be the only solution. Solids only (never converges on surfaces).
/// Deterministic: the same input gives the same bits.
InverseMap inverse_map(ElementKind kind, std::span<const Vec3> corners, const Vec3& point);
/// How far xi lies outside the reference element (0 inside), in units of half its width.
double overshoot(ElementKind kind, const Vec3& xi);
/// The nearest point of the element to `point`: local coordinates within it, and the distance (m; 0 within a solid).
struct NearestPoint {
  Vec3 xi{};
  double distance = 0;
};
NearestPoint nearest_point(ElementKind kind, std::span<const Vec3> corners, const Vec3& point);

}  // namespace tenon

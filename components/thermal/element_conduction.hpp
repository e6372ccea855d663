// SPDX-License-Identifier: BSD-3-Clause
// Conductivity of a batch of elements, from shape functions: one code for all solid kinds.
#pragma once

#include <array>
#include <span>

#include "components/materials/batch.hpp"
#include "framework/base/types.hpp"
#include "framework/mesh/topology.hpp"

namespace tenon::thermal {

inline constexpr int max_pairs = max_linear_nodes * (max_linear_nodes - 1) / 2;

/// Shape functions of a kind at its quadrature points. A tet4 has a constant gradient, so one point is enough for
/// conduction.
struct ElementTable {
  explicit ElementTable(ElementKind element_kind);
  ElementKind kind;
  int nodes, pairs;
  int points = 0;
  std::array<double, max_linear_nodes> weight{};
  std::array<std::array<Vec3, max_linear_nodes>, max_linear_nodes> gradient{};  ///< dN_a/dxi at each point
  std::array<Vec3, max_linear_nodes> centre_gradient{};
};

/// Node positions (m): [node][direction][lane].
struct CornerBatch {
  alignas(64) double x[max_linear_nodes][3][lanes];
};

/// Links between the nodes of each element.
struct ConductionBatch {
  /// Off-diagonal entries of the matrix of -div(k grad T), W/K, for a < b in the order (0,1) (0,2) ... (1,2) ...; the
  /// diagonal is minus the sum of the row, so that a constant temperature conducts nothing, exactly.
  alignas(64) double link[max_pairs][lanes];
  /// Least det(dx/dxi) over the points, m^3; not positive where an element is inverted.
  alignas(64) double least_jacobian[lanes];
};

void conduction(const ElementTable& table, const CornerBatch& corners, const double (&conductivity)[lanes],
                ConductionBatch& result);
/// The same with a symmetric conductivity tensor, W/(m K).
void conduction(const ElementTable& table, const CornerBatch& corners, const std::array<Vec3, 3>& conductivity,
                ConductionBatch& result);

/// Upper bound of the greatest eigenvalue of C^-1 K of each element, 1/s: the root of order 128 of the trace of its
/// 128th power, at most 8^(1/128) = 1.6 % too high. `capacity` (J/K): [node][lane], lumped. The greatest eigenvalue of
/// a mesh is not above that of its elements [HPT79].
void eigenvalue_bound(const ElementTable& table, const ConductionBatch& links,
                      const double (&capacity)[max_linear_nodes][lanes], double (&bound)[lanes]);

/// Volume of an element shared out to its nodes: integrals of N_a, m^3.
void nodal_volumes(ElementKind kind, std::span<const Vec3> corners, std::span<double> volumes);

/// Area of a side with 3 or 4 corners shared out to them: integrals of N_a, m^2.
void nodal_areas(std::span<const Vec3> corners, std::span<double> areas);

/// Integral of N_a N_b over a side with 3 or 4 corners, m^2, for a < b: [a][b].
using SideLinks = std::array<std::array<double, max_side_nodes>, max_side_nodes>;
SideLinks side_links(std::span<const Vec3> corners);

/// Gradient of a nodal quantity at the centre of an element.
Vec3 centre_gradient(const ElementTable& table, std::span<const Vec3> corners, std::span<const double> values);

}  // namespace tenon::thermal

// SPDX-License-Identifier: BSD-3-Clause
// Points inside reference elements with their shape functions tabulated, and what is integrated with them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "framework/fields/field.hpp"
#include "framework/mesh/mesh.hpp"
#include "framework/mesh/shape_functions.hpp"
#include "transfer/mesh_items.hpp"

namespace tenon::transfer {

struct TabulatedPoint {
  Vec3 xi{};
  double weight = 0;  ///< volume (area) of the reference element that the point stands for
  std::array<double, max_nodes> value{};
  std::array<Vec3, max_nodes> gradient{};  ///< with respect to xi
};

/// The quadrature rule of an element kind.
std::vector<TabulatedPoint> quadrature_points(ElementKind kind);
/// Midpoints of about n^3 (surfaces: n^2) equal sub-cells of the reference element.
std::vector<TabulatedPoint> subdivision_points(ElementKind kind, int n);

/// Volume over that of the reference element, det(dx/dxi), m^3; of a surface its area, |dx/dxi x dx/deta|, m^2.
double measure(const TabulatedPoint& point, ElementKind kind, const Corners& corners);
/// The same for all points of a table at once, eight at a time.
class PointTable {
 public:
  PointTable() = default;
  PointTable(ElementKind kind, std::vector<TabulatedPoint> points);
  ElementKind kind() const { return kind_; }
  const std::vector<TabulatedPoint>& points() const { return points_; }
  /// Volume (area) that each point stands for: its weight times `measure`.
  void volumes(const Corners& corners, std::span<double> volumes) const;

 private:
  static constexpr std::size_t lanes = 8;
  ElementKind kind_ = ElementKind::hex8;
  std::vector<TabulatedPoint> points_;
  std::size_t padded_ = 0;        ///< number of points, to a multiple of lanes
  std::vector<double> gradient_;  ///< [node][direction][point]
  std::vector<double> weight_;
};

/// Edge of the cube (square) that is as large as the element, m.
double edge_of(ElementKind kind, double measure);
/// x, m.
Vec3 position(const TabulatedPoint& point, int nodes, const Corners& corners);

/// Collective. Mean of edge_of all elements, m.
double mean_edge(const Mesh& mesh, std::span<const Vec3> coordinates);

/// Collective. Volume of every local item, m^3 (area, m^2, of surfaces): of an element, or the integral of a node's
/// shape function over all elements around it (the consistent mass matrix summed by rows).
std::vector<double> item_volumes(const Mesh& mesh, std::span<const Vec3> coordinates, Location location);

}  // namespace tenon::transfer

// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/rigid_inertia.hpp"

#include <array>
#include <cmath>

#include "framework/mesh/shape_functions.hpp"

namespace tenon {

namespace {

/// Corner of the element at each corner of the hexahedron.
std::array<int, 8> as_hexahedron(ElementKind kind) {
  switch (kind) {
    case ElementKind::tet4:
      return {0, 1, 2, 2, 3, 3, 3, 3};
    case ElementKind::wedge6:
      return {0, 1, 2, 2, 3, 4, 5, 5};
    case ElementKind::pyramid5:
      return {0, 1, 2, 3, 4, 4, 4, 4};
    default:
      return {0, 1, 2, 3, 4, 5, 6, 7};
  }
}

using Visit = std::function<void(double, const Vec3&, std::span<const double>)>;

/// The area vector x,xi x x,eta of a quadrilateral or triangle.
Vec3 area_vector(ElementKind kind, std::span<const Vec3> corners, const Vec3& xi) {
  std::array<Vec3, max_side_nodes> gradient{};
  shape_gradients(kind, xi, std::span(gradient).first(corners.size()));
  Vec3 along{}, across{};
  for (std::size_t a = 0; a < corners.size(); ++a)
    along = along + gradient[a][0] * corners[a], across = across + gradient[a][1] * corners[a];
  return cross(along, across);
}

// The rules on the surface integrate the squares of places exactly where it is plane, and so do two points through the
// thickness: m t^2/12 about the surface.
void visit_shell(const ElementGroup& group, LocalIndex element, std::span<const Vec3> coordinates, const Visit& visit) {
  const ElementKind kind = group.elements().kind;
  const std::span<const LocalIndex> nodes = group.elements().nodes(element);
  std::array<Vec3, max_side_nodes> all;
  for (std::size_t a = 0; a < nodes.size(); ++a) all[a] = coordinates[static_cast<std::size_t>(nodes[a])];
  const std::span<const Vec3> corners = std::span(all).first(nodes.size());
  double area = 0;
  for (const QuadraturePoint& q : quadrature(kind)) area += q.weight * norm(area_vector(kind, corners, q.xi));
  const double density = value_of(group.mass, element) / area, out = group.thickness(element) / std::sqrt(12.0);
  for (const QuadraturePoint& q : quadrature(kind)) {
    std::array<double, max_side_nodes> shape{};
    const std::span<double> values = std::span(shape).first(nodes.size());
    shape_values(kind, q.xi, values);
    const Vec3 normal = area_vector(kind, corners, q.xi), place = map_to_space(kind, corners, q.xi);
    const double size = norm(normal), mass = density * q.weight * size;
    for (const double z : {-out, out}) visit(0.5 * mass, place + (z / size) * normal, values);
  }
}

}  // namespace

void for_mass_points(const ElementGroup& group, LocalIndex element, std::span<const Vec3> coordinates,
                     const Visit& visit) {
  const ElementKind kind = group.elements().kind;
  if (topology(kind).dimension == 2) return visit_shell(group, element, coordinates, visit);
  const std::span<const LocalIndex> nodes = group.elements().nodes(element);
  const std::array<int, 8> corner = as_hexahedron(kind);
  std::array<Vec3, 8> x;
  for (std::size_t i = 0; i < 8; ++i)
    x[i] = coordinates[static_cast<std::size_t>(nodes[static_cast<std::size_t>(corner[i])])];
  const double density = group.material().density, far = std::sqrt(0.6);
  const std::array<double, 3> place{-far, 0, far}, weight{5.0 / 9, 8.0 / 9, 5.0 / 9};
  for (std::size_t i = 0; i < 27; ++i) {
    const std::size_t a = i % 3, b = i / 3 % 3, c = i / 9;
    const Vec3 xi{place[a], place[b], place[c]};
    std::array<double, 8> hex{};
    std::array<double, max_linear_nodes> shape{};
    shape_values(ElementKind::hex8, xi, hex);
    for (std::size_t k = 0; k < 8; ++k) shape[static_cast<std::size_t>(corner[k])] += hex[k];
    const double volume = weight[a] * weight[b] * weight[c] * jacobian_determinant(ElementKind::hex8, x, xi);
    visit(density * volume, map_to_space(ElementKind::hex8, x, xi), std::span(shape).first(nodes.size()));
  }
}

void add_consistent_masses(const ElementGroup& group, std::span<const Vec3> coordinates, std::span<double> mass) {
  for (LocalIndex e = 0; e < group.size(); ++e) {
    const std::span<const LocalIndex> nodes = group.elements().nodes(e);
    for_mass_points(group, e, coordinates, [&](double m, const Vec3&, std::span<const double> shape) {
      for (std::size_t a = 0; a < nodes.size(); ++a) mass[static_cast<std::size_t>(nodes[a])] += m * shape[a];
    });
  }
}

}  // namespace tenon

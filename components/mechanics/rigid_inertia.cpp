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

void visit_nodes(const ElementGroup& group, LocalIndex element, std::span<const Vec3> coordinates, const Visit& visit) {
  const std::span<const LocalIndex> nodes = group.elements().nodes(element);
  const double share = value_of(group.mass, element) / static_cast<double>(nodes.size());
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    std::array<double, max_element_nodes> shape{};
    shape[a] = 1;
    visit(share, coordinates[static_cast<std::size_t>(nodes[a])], std::span(shape).first(nodes.size()));
  }
}

}  // namespace

void for_mass_points(const ElementGroup& group, LocalIndex element, std::span<const Vec3> coordinates,
                     const Visit& visit) {
  const ElementKind kind = group.elements().kind;
  if (topology(kind).dimension == 2) return visit_nodes(group, element, coordinates, visit);
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
    std::array<double, max_element_nodes> shape{};
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

// SPDX-License-Identifier: BSD-3-Clause
// Values, gradients and quadrature of the element kinds, and what follows from them: maps, Jacobians, volumes.
#include "framework/mesh/shape_functions.hpp"

#include <cmath>
#include <vector>

#include "framework/mesh/second_order.hpp"
#include "framework/mesh/trilinear.hpp"

namespace tenon {

namespace {

constexpr std::array<Vec3, 8> hex_corner{
    {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};

double triple(const Vec3& a, const Vec3& b, const Vec3& c) {
  return dot(a, cross(b, c));
}

/// xi eta / (1 - zeta), the rational term of the pyramid [Bed92]; 0 at the apex, its limit from inside.
double pyramid_term(const Vec3& xi) {
  const double height = 1 - xi[2];
  return height == 0 ? 0.0 : xi[0] * xi[1] / height;
}

void hex_values(const Vec3& xi, std::span<double> n) {
  for (std::size_t a = 0; a < 8; ++a) {
    const Vec3& c = hex_corner[a];
    n[a] = 0.125 * (1 + c[0] * xi[0]) * (1 + c[1] * xi[1]) * (1 + c[2] * xi[2]);
  }
}

void pyramid_values(const Vec3& xi, std::span<double> n) {
  const double t = pyramid_term(xi);
  for (std::size_t a = 0; a < 4; ++a) {
    const double x = hex_corner[a][0], y = hex_corner[a][1];
    n[a] = 0.25 * (1 + x * xi[0] + y * xi[1] + x * y * t - xi[2]);
  }
  n[4] = xi[2];
}

void wedge_values(const Vec3& xi, std::span<double> n) {
  const Vec3 l{1 - xi[0] - xi[1], xi[0], xi[1]};
  for (std::size_t a = 0; a < 3; ++a) {
    n[a] = 0.5 * l[a] * (1 - xi[2]);
    n[a + 3] = 0.5 * l[a] * (1 + xi[2]);
  }
}

void hex_gradients(const Vec3& xi, std::span<Vec3> g) {
  for (std::size_t a = 0; a < 8; ++a) {
    const Vec3& c = hex_corner[a];
    const double x = 1 + c[0] * xi[0], y = 1 + c[1] * xi[1], z = 1 + c[2] * xi[2];
    g[a] = {0.125 * c[0] * y * z, 0.125 * c[1] * x * z, 0.125 * c[2] * x * y};
  }
}

void pyramid_gradients(const Vec3& xi, std::span<Vec3> g) {
  const double height = 1 - xi[2];
  const double x_term = height == 0 ? 0.0 : xi[1] / height, y_term = height == 0 ? 0.0 : xi[0] / height;
  const double z_term = x_term * y_term;
  for (std::size_t a = 0; a < 4; ++a) {
    const double x = hex_corner[a][0], y = hex_corner[a][1];
    g[a] = {0.25 * (x + x * y * x_term), 0.25 * (y + x * y * y_term), 0.25 * (x * y * z_term - 1)};
  }
  g[4] = {0, 0, 1};
}

void wedge_gradients(const Vec3& xi, std::span<Vec3> g) {
  constexpr std::array<std::array<double, 2>, 3> slope{{{-1, -1}, {1, 0}, {0, 1}}};
  const Vec3 l{1 - xi[0] - xi[1], xi[0], xi[1]};
  for (std::size_t a = 0; a < 3; ++a) {
    const double low = 0.5 * (1 - xi[2]), high = 0.5 * (1 + xi[2]);
    g[a] = {slope[a][0] * low, slope[a][1] * low, -0.5 * l[a]};
    g[a + 3] = {slope[a][0] * high, slope[a][1] * high, 0.5 * l[a]};
  }
}

using Rule = std::vector<QuadraturePoint>;

constexpr double gauss = 0.57735026918962576451;  // 1/sqrt(3), 2-point Gauss-Legendre, exact to degree 3

/// Degree 2 on the triangle and on the tetrahedron [HMS56].
constexpr std::array<std::array<double, 2>, 3> triangle_point{{{1. / 6, 1. / 6}, {2. / 3, 1. / 6}, {1. / 6, 2. / 3}}};

Rule hex_rule() {
  Rule rule;
  for (const Vec3& c : hex_corner) rule.push_back({gauss * c, 1.0});
  return rule;
}

Rule tet_rule() {
  const double b = (5 - std::sqrt(5.0)) / 20, a = 1 - 3 * b;
  return {{{b, b, b}, 1. / 24}, {{a, b, b}, 1. / 24}, {{b, a, b}, 1. / 24}, {{b, b, a}, 1. / 24}};
}

Rule wedge_rule() {
  Rule rule;
  for (const double z : {-gauss, gauss})
    for (const auto& p : triangle_point) rule.push_back({{p[0], p[1], z}, 1. / 6});
  return rule;
}

/// Gauss-Legendre over the base times Gauss-Jacobi with the weight t^2 of the section, t = 1 - zeta in [0, 1]: the
/// roots of t^2 - 4/3 t + 2/5, whose weights sum to 1/3 and have the first moment 1/4.
Rule pyramid_rule() {
  Rule rule;
  const double half = std::sqrt(8.0 / 45) / 2;
  const double t1 = 2. / 3 - half, t2 = 2. / 3 + half;
  const double w2 = (0.25 - t1 / 3) / (t2 - t1), w1 = 1. / 3 - w2;
  for (const auto& [t, w] : {std::array{t1, w1}, std::array{t2, w2}})
    for (std::size_t a = 0; a < 4; ++a)
      rule.push_back({{hex_corner[a][0] * gauss * t, hex_corner[a][1] * gauss * t, 1 - t}, w});
  return rule;
}

Rule quad_rule() {
  Rule rule;
  for (std::size_t a = 0; a < 4; ++a) rule.push_back({{gauss * hex_corner[a][0], gauss * hex_corner[a][1], 0}, 1.0});
  return rule;
}

Rule tri_rule() {
  Rule rule;
  for (const auto& p : triangle_point) rule.push_back({{p[0], p[1], 0}, 1. / 6});
  return rule;
}

/// Columns dx/dxi_j.
std::array<Vec3, 3> jacobian(ElementKind kind, std::span<const Vec3> corners, const Vec3& xi) {
  std::array<Vec3, max_element_nodes> gradient;
  shape_gradients(kind, xi, gradient);
  std::array<Vec3, 3> column{};
  const auto nodes = static_cast<std::size_t>(topology(kind).nodes);
  for (std::size_t a = 0; a < nodes; ++a)
    for (std::size_t j = 0; j < 3; ++j) column[j] = column[j] + gradient[a][j] * corners[a];
  return column;
}

}  // namespace

void shape_values(ElementKind kind, const Vec3& xi, std::span<double> values) {
  switch (kind) {
    case ElementKind::hex8:
      hex_values(xi, values);
      return;
    case ElementKind::tet4:
      values[0] = 1 - xi[0] - xi[1] - xi[2], values[1] = xi[0], values[2] = xi[1], values[3] = xi[2];
      return;
    case ElementKind::wedge6:
      wedge_values(xi, values);
      return;
    case ElementKind::pyramid5:
      pyramid_values(xi, values);
      return;
    case ElementKind::quad4:
      for (std::size_t a = 0; a < 4; ++a)
        values[a] = 0.25 * (1 + hex_corner[a][0] * xi[0]) * (1 + hex_corner[a][1] * xi[1]);
      return;
    case ElementKind::tri3:
      values[0] = 1 - xi[0] - xi[1], values[1] = xi[0], values[2] = xi[1];
      return;
    case ElementKind::hex20:
      second_order::hex20_values(xi, values);
      return;
    case ElementKind::tet10:
      second_order::tet10_values(xi, values);
      return;
    case ElementKind::particle:
      values[0] = 1;
      return;
  }
}

void shape_gradients(ElementKind kind, const Vec3& xi, std::span<Vec3> gradients) {
  switch (kind) {
    case ElementKind::hex8:
      hex_gradients(xi, gradients);
      return;
    case ElementKind::tet4:
      gradients[0] = {-1, -1, -1}, gradients[1] = {1, 0, 0}, gradients[2] = {0, 1, 0}, gradients[3] = {0, 0, 1};
      return;
    case ElementKind::wedge6:
      wedge_gradients(xi, gradients);
      return;
    case ElementKind::pyramid5:
      pyramid_gradients(xi, gradients);
      return;
    case ElementKind::quad4:
      for (std::size_t a = 0; a < 4; ++a) {
        const double x = hex_corner[a][0], y = hex_corner[a][1];
        gradients[a] = {0.25 * x * (1 + y * xi[1]), 0.25 * y * (1 + x * xi[0]), 0};
      }
      return;
    case ElementKind::tri3:
      gradients[0] = {-1, -1, 0}, gradients[1] = {1, 0, 0}, gradients[2] = {0, 1, 0};
      return;
    case ElementKind::hex20:
      second_order::hex20_gradients(xi, gradients);
      return;
    case ElementKind::tet10:
      second_order::tet10_gradients(xi, gradients);
      return;
    case ElementKind::particle:
      gradients[0] = {0, 0, 0};
      return;
  }
}

std::span<const Vec3> local_nodes(ElementKind kind) {
  static constexpr std::array<Vec3, 6> wedge{{{0, 0, -1}, {1, 0, -1}, {0, 1, -1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
  static constexpr std::array<Vec3, 5> pyramid{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}}};
  static constexpr std::array<Vec3, 4> quad{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}};
  static constexpr std::array<Vec3, 3> tri{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  static constexpr std::array<Vec3, 1> particle{{{0, 0, 0}}};
  switch (kind) {
    case ElementKind::hex8:
      return hex_corner;
    case ElementKind::tet4:
      return std::span(second_order::tet10_nodes).first(4);
    case ElementKind::wedge6:
      return wedge;
    case ElementKind::pyramid5:
      return pyramid;
    case ElementKind::quad4:
      return quad;
    case ElementKind::tri3:
      return tri;
    case ElementKind::hex20:
      return second_order::hex20_nodes;
    case ElementKind::particle:
      return particle;
    case ElementKind::tet10:
      break;
  }
  return second_order::tet10_nodes;
}

Vec3 element_centre(ElementKind kind) {
  switch (kind) {
    case ElementKind::tet4:
    case ElementKind::tet10:
      return {0.25, 0.25, 0.25};
    case ElementKind::wedge6:
    case ElementKind::tri3:
      return {1. / 3, 1. / 3, 0};
    case ElementKind::pyramid5:
      return {0, 0, 0.25};
    case ElementKind::hex8:
    case ElementKind::quad4:
    case ElementKind::hex20:
    case ElementKind::particle:
      break;
  }
  return {0, 0, 0};
}

std::span<const QuadraturePoint> quadrature(ElementKind kind) {
  static const std::array<Rule, element_kinds> rules{hex_rule(),
                                                     tet_rule(),
                                                     wedge_rule(),
                                                     pyramid_rule(),
                                                     quad_rule(),
                                                     tri_rule(),
                                                     second_order::hex20_rule(),
                                                     second_order::tet10_rule(),
                                                     Rule{{{0, 0, 0}, 1.0}}};
  return rules[static_cast<std::size_t>(kind)];
}

Vec3 map_to_space(ElementKind kind, std::span<const Vec3> corners, const Vec3& xi) {
  std::array<double, max_element_nodes> value;
  shape_values(kind, xi, value);
  Vec3 x{};
  const auto nodes = static_cast<std::size_t>(topology(kind).nodes);
  for (std::size_t a = 0; a < nodes; ++a) x = x + value[a] * corners[a];
  return x;
}

double jacobian_determinant(ElementKind kind, std::span<const Vec3> corners, const Vec3& xi) {
  const std::array<Vec3, 3> j = jacobian(kind, corners, xi);
  return triple(j[0], j[1], j[2]);
}

double element_measure(ElementKind kind, std::span<const Vec3> corners) {
  if (kind == ElementKind::hex8) return Trilinear::hex(corners, corners[0]).volume();
  if (kind == ElementKind::tet4)
    return triple(corners[1] - corners[0], corners[2] - corners[0], corners[3] - corners[0]) / 6;
  if (kind == ElementKind::tri3) return 0.5 * norm(cross(corners[1] - corners[0], corners[2] - corners[0]));
  // The determinants of wedge, pyramid, hex20 and tet10 are polynomials that these rules integrate exactly; the area of
  // a quad4 is exact where it is plane.
  double sum = 0;
  for (const QuadraturePoint& q : quadrature(kind)) {
    const std::array<Vec3, 3> j = jacobian(kind, corners, q.xi);
    sum += q.weight * (kind == ElementKind::quad4 ? norm(cross(j[0], j[1])) : triple(j[0], j[1], j[2]));
  }
  return sum;
}

Box element_box(ElementKind kind, std::span<const Vec3> nodes) {
  if (!middle_nodes(kind).empty()) return second_order::bezier_box(kind, nodes);
  Box box;
  for (const Vec3& x : nodes) box.add(x);
  return box;
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
#include "framework/mesh/second_order.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::second_order {

const std::array<Vec3, 20> hex20_nodes{{{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1},
                                        {1, -1, 1},   {1, 1, 1},   {-1, 1, 1}, {0, -1, -1}, {1, 0, -1},
                                        {0, 1, -1},   {-1, 0, -1}, {0, -1, 1}, {1, 0, 1},   {0, 1, 1},
                                        {-1, 0, 1},   {-1, -1, 0}, {1, -1, 0}, {1, 1, 0},   {-1, 1, 0}}};
const std::array<Vec3, 10> tet10_nodes{{{0, 0, 0},
                                        {1, 0, 0},
                                        {0, 1, 0},
                                        {0, 0, 1},
                                        {0.5, 0, 0},
                                        {0.5, 0.5, 0},
                                        {0, 0.5, 0},
                                        {0, 0, 0.5},
                                        {0.5, 0, 0.5},
                                        {0, 0.5, 0.5}}};

namespace {

constexpr std::array<Vec3, 4> tet_slope{{{-1, -1, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

std::array<double, 4> volume_coordinates(const Vec3& xi) {
  return {1 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]};
}

/// The coordinate along which a middle node of a hex20 lies in the middle.
std::size_t middle_axis(const Vec3& node) {
  return node[0] == 0 ? 0 : node[1] == 0 ? 1 : 2;
}

}  // namespace

void hex20_values(const Vec3& xi, std::span<double> values) {
  for (std::size_t a = 0; a < 20; ++a) {
    const Vec3& c = hex20_nodes[a];
    Vec3 f;
    for (std::size_t i = 0; i < 3; ++i) f[i] = 1 + c[i] * xi[i];
    if (a < 8) {
      values[a] = 0.125 * f[0] * f[1] * f[2] * (f[0] + f[1] + f[2] - 5);
    } else {
      const std::size_t m = middle_axis(c);
      f[m] = (1 - xi[m]) * (1 + xi[m]);
      values[a] = 0.25 * f[0] * f[1] * f[2];
    }
  }
}

void hex20_gradients(const Vec3& xi, std::span<Vec3> gradients) {
  for (std::size_t a = 0; a < 20; ++a) {
    const Vec3& c = hex20_nodes[a];
    Vec3 f;
    for (std::size_t i = 0; i < 3; ++i) f[i] = 1 + c[i] * xi[i];
    if (a < 8) {
      const double last = f[0] + f[1] + f[2] - 5;
      for (std::size_t i = 0; i < 3; ++i)
        gradients[a][i] = 0.125 * c[i] * f[(i + 1) % 3] * f[(i + 2) % 3] * (last + f[i]);
    } else {
      const std::size_t m = middle_axis(c);
      f[m] = (1 - xi[m]) * (1 + xi[m]);
      for (std::size_t i = 0; i < 3; ++i)
        gradients[a][i] = 0.25 * (i == m ? -2 * xi[i] : c[i]) * f[(i + 1) % 3] * f[(i + 2) % 3];
    }
  }
}

void tet10_values(const Vec3& xi, std::span<double> values) {
  const std::array<double, 4> l = volume_coordinates(xi);
  for (std::size_t a = 0; a < 4; ++a) values[a] = l[a] * (2 * l[a] - 1);
  std::size_t a = 4;
  for (const auto& [p, q] : middle_nodes(ElementKind::tet10))
    values[a++] = 4 * l[static_cast<std::size_t>(p)] * l[static_cast<std::size_t>(q)];
}

void tet10_gradients(const Vec3& xi, std::span<Vec3> gradients) {
  const std::array<double, 4> l = volume_coordinates(xi);
  for (std::size_t a = 0; a < 4; ++a) gradients[a] = (4 * l[a] - 1) * tet_slope[a];
  std::size_t a = 4;
  for (const CornerPair& edge : middle_nodes(ElementKind::tet10)) {
    const auto p = static_cast<std::size_t>(edge[0]), q = static_cast<std::size_t>(edge[1]);
    gradients[a++] = (4 * l[q]) * tet_slope[p] + (4 * l[p]) * tet_slope[q];
  }
}

std::vector<QuadraturePoint> hex20_rule() {
  const double far = std::sqrt(0.6);
  const std::array<double, 3> place{-far, 0, far}, weight{5. / 9, 8. / 9, 5. / 9};
  std::vector<QuadraturePoint> rule;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i)
        rule.push_back({{place[i], place[j], place[k]}, weight[i] * weight[j] * weight[k]});
  return rule;
}

std::vector<QuadraturePoint> tet10_rule() {
  std::vector<QuadraturePoint> rule;
  constexpr double a1 = 0.31088591926330060980, a2 = 0.092735250310891226402, a3 = 0.045503704125649649492;
  constexpr double w1 = 0.018781320953002641800, w2 = 0.012248840519393658257, w3 = 0.0070910034628469110730;
  for (const auto& [a, w] : {std::array{a1, w1}, std::array{a2, w2}})
    for (std::size_t i = 0; i < 4; ++i) {
      Vec3 xi{a, a, a};
      if (i < 3) xi[i] = 1 - 3 * a;
      rule.push_back({xi, w});
    }
  constexpr double b3 = 0.5 - a3;
  for (const CornerPair& edge : middle_nodes(ElementKind::tet10)) {
    std::array<double, 4> l{a3, a3, a3, a3};
    l[static_cast<std::size_t>(edge[0])] = l[static_cast<std::size_t>(edge[1])] = b3;
    rule.push_back({{l[1], l[2], l[3]}, w3});
  }
  return rule;
}

namespace {

/// Along the edge a, m, b of a parabola: its control point.
Vec3 control_point(const Vec3& a, const Vec3& middle, const Vec3& b) {
  return 2.0 * middle - 0.5 * (a + b);
}

}  // namespace

Box bezier_box(ElementKind kind, std::span<const Vec3> nodes) {
  Box box;
  if (kind == ElementKind::tet10) {
    for (std::size_t a = 0; a < 4; ++a) box.add(nodes[a]);
    std::size_t a = 4;
    for (const auto& [p, q] : middle_nodes(kind))
      box.add(control_point(nodes[static_cast<std::size_t>(p)], nodes[a++], nodes[static_cast<std::size_t>(q)]));
    return box;
  }
  // The serendipity element is one of the triquadratic ones: its values on a lattice of 27 determine the rest.
  std::array<Vec3, 27> net;
  for (std::size_t n = 0; n < 27; ++n) {
    const Vec3 xi{static_cast<double>(n % 3) - 1, static_cast<double>(n / 3 % 3) - 1, static_cast<double>(n / 9) - 1};
    net[n] = map_to_space(kind, nodes, xi);
  }
  for (const std::size_t stride : {1, 3, 9})
    for (std::size_t n = 0; n < 27; ++n)
      if (n / stride % 3 == 1) net[n] = control_point(net[n - stride], net[n], net[n + stride]);
  for (const Vec3& x : net) box.add(x);
  return box;
}

namespace {

using Powers = std::array<std::int8_t, 3>;

constexpr std::array<Powers, 20> hex_powers{
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2},
     {1, 1, 1}, {2, 1, 0}, {2, 0, 1}, {1, 2, 0}, {0, 2, 1}, {1, 0, 2}, {0, 1, 2}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}}};

/// Coefficients of the monomials in the shape functions: shape[a][t].
using ShapeTerms = std::array<std::array<double, 20>, 20>;

/// Product of three polynomials of degree 2, one per coordinate, times `factor`, added to the terms.
void add_product(const std::array<std::array<double, 3>, 3>& f, double factor, std::array<double, 20>& terms) {
  for (std::size_t t = 0; t < hex_powers.size(); ++t) {
    const Powers& p = hex_powers[t];
    terms[t] += factor * f[0][static_cast<std::size_t>(p[0])] * f[1][static_cast<std::size_t>(p[1])] *
                f[2][static_cast<std::size_t>(p[2])];
  }
}

ShapeTerms hex_shape_terms() {
  ShapeTerms shape{};
  for (std::size_t a = 0; a < 20; ++a) {
    const Vec3& c = hex20_nodes[a];
    std::array<std::array<double, 3>, 3> f;
    for (std::size_t i = 0; i < 3; ++i) f[i] = {1, c[i], 0};
    if (a >= 8) {
      f[middle_axis(c)] = {1, 0, -1};
      add_product(f, 0.25, shape[a]);
      continue;
    }
    add_product(f, -0.25, shape[a]);
    for (std::size_t i = 0; i < 3; ++i) {  // times c_i xi_i, of which c_i^2 = 1
      auto g = f;
      g[i] = {0, c[i], 1};
      add_product(g, 0.125, shape[a]);
    }
  }
  return shape;
}

/// The quadratic is determined by value, gradient and second derivatives at the centre.
ShapeTerms tet_shape_terms(const Vec3& centre) {
  ShapeTerms shape{};
  std::array<double, 10> value;
  std::array<Vec3, 10> slope;
  tet10_values(centre, value);
  tet10_gradients(centre, slope);
  for (std::size_t a = 0; a < 10; ++a) {
    shape[a][0] = value[a];
    for (std::size_t i = 0; i < 3; ++i) shape[a][1 + i] = slope[a][i];
    Vec3 u, v;
    double factor = 2;
    if (a < 4) {
      u = v = tet_slope[a];
    } else {
      const CornerPair edge = middle_nodes(ElementKind::tet10)[a - 4];
      u = tet_slope[static_cast<std::size_t>(edge[0])], v = tet_slope[static_cast<std::size_t>(edge[1])], factor = 4;
    }
    for (std::size_t t = 4; t < 10; ++t) {  // factor (u.s)(v.s)
      const Powers& p = hex_powers[t];
      std::array<std::size_t, 2> at{};
      std::size_t n = 0;
      for (std::size_t i = 0; i < 3; ++i)
        for (int k = 0; k < p[i]; ++k) at[n++] = i;
      shape[a][t] = factor * (at[0] == at[1] ? u[at[0]] * v[at[0]] : u[at[0]] * v[at[1]] + u[at[1]] * v[at[0]]);
    }
  }
  return shape;
}

/// Values of 1, s and s^2.
using PowersOf = std::array<std::array<double, 3>, 3>;

PowersOf powers_of(const Vec3& s) {
  return {{{1, s[0], s[0] * s[0]}, {1, s[1], s[1] * s[1]}, {1, s[2], s[2] * s[2]}}};
}

/// Of the derivatives of the powers: 0, 1 and 2 s.
std::array<double, 3> slopes_of(double s) {
  return {0, 1, 2 * s};
}

double term(const PowersOf& f, const Powers& p) {
  return f[0][static_cast<std::size_t>(p[0])] * f[1][static_cast<std::size_t>(p[1])] *
         f[2][static_cast<std::size_t>(p[2])];
}

double greatest(const Vec3& v) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

}  // namespace

Map::Map(ElementKind kind, std::span<const Vec3> nodes, const Vec3& point) : centre_(element_centre(kind)) {
  static const ShapeTerms of_hex = hex_shape_terms(), of_tet = tet_shape_terms(element_centre(ElementKind::tet10));
  const ShapeTerms& shape = kind == ElementKind::hex20 ? of_hex : of_tet;
  terms_ = static_cast<std::size_t>(topology(kind).nodes);
  coefficient_.fill({0, 0, 0});
  double farthest = 0;
  for (std::size_t a = 0; a < terms_; ++a) {
    const Vec3 seen = nodes[a] - point;
    farthest = std::max(farthest, greatest(seen));
    for (std::size_t t = 0; t < terms_; ++t)
      for (std::size_t i = 0; i < 3; ++i) coefficient_[t][i] += shape[a][t] * seen[i];
  }
  noise = 4 * std::numeric_limits<double>::epsilon() * farthest;
}

Vec3 Map::value(const Vec3& xi) const {
  const PowersOf f = powers_of(xi - centre_);
  Vec3 sum{};
  for (std::size_t t = 0; t < terms_; ++t) sum = sum + term(f, hex_powers[t]) * coefficient_[t];
  return sum;
}

std::array<Vec3, 3> Map::jacobian(const Vec3& xi) const {
  const Vec3 s = xi - centre_;
  std::array<Vec3, 3> column{};
  for (std::size_t j = 0; j < 3; ++j) {
    PowersOf f = powers_of(s);
    f[j] = slopes_of(s[j]);
    for (std::size_t t = 1; t < terms_; ++t) column[j] = column[j] + term(f, hex_powers[t]) * coefficient_[t];
  }
  return column;
}

bool Map::is_injective_within(double reach) const {
  const Vec3 &a = coefficient_[1], &b = coefficient_[2], &c = coefficient_[3];
  const std::array<Vec3, 3> cofactor{cross(b, c), cross(c, a), cross(a, b)};
  const double determinant = dot(a, cofactor[0]);
  if (!(std::abs(determinant) > 0)) return false;
  // Row sums of |J_centre^-1 J - 1|.
  Vec3 row{};
  PowersOf powers = powers_of({reach, reach, reach});
  for (std::size_t t = 4; t < terms_; ++t) {
    double slopes = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      PowersOf f = powers;
      f[j] = slopes_of(reach);
      slopes += term(f, hex_powers[t]);
    }
    for (std::size_t i = 0; i < 3; ++i) row[i] += slopes * std::abs(dot(cofactor[i], coefficient_[t]) / determinant);
  }
  return greatest(row) < 1;
}

}  // namespace tenon::second_order

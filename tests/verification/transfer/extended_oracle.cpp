// SPDX-License-Identifier: BSD-3-Clause
#include "extended_oracle.hpp"

#include <algorithm>
#include <limits>

namespace tenon::transfer::testing {

namespace {

using Shape = std::array<Dual, max_element_nodes>;

Dual one_plus(Extended sign, const Dual& s) {
  return Dual(1) + Dual(sign) * s;
}

constexpr int hex_sign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

void hex8(const Dual& x, const Dual& y, const Dual& z, Shape& n) {
  for (std::size_t a = 0; a < 8; ++a)
    n[a] = Dual(0.125L) * one_plus(hex_sign[a][0], x) * one_plus(hex_sign[a][1], y) * one_plus(hex_sign[a][2], z);
}

/// Serendipity as bubbles on the edges, which the corners give half of to each: N_corner = N_hex8 - sum of halves.
void hex20(const Dual& x, const Dual& y, const Dual& z, Shape& n) {
  hex8(x, y, z, n);
  const Dual one(1), bx = (one - x) * (one + x), by = (one - y) * (one + y), bz = (one - z) * (one + z);
  constexpr int edge[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                               {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  for (std::size_t e = 0; e < 12; ++e) {
    const auto p = static_cast<std::size_t>(edge[e][0]), q = static_cast<std::size_t>(edge[e][1]);
    const int* s = hex_sign[p];
    const Dual quarter(0.25L);
    if (s[0] != hex_sign[q][0]) n[8 + e] = quarter * bx * one_plus(s[1], y) * one_plus(s[2], z);
    if (s[1] != hex_sign[q][1]) n[8 + e] = quarter * one_plus(s[0], x) * by * one_plus(s[2], z);
    if (s[2] != hex_sign[q][2]) n[8 + e] = quarter * one_plus(s[0], x) * one_plus(s[1], y) * bz;
    n[p] = n[p] - Dual(0.5L) * n[8 + e];
    n[q] = n[q] - Dual(0.5L) * n[8 + e];
  }
}

void tet10(const std::array<Dual, 4>& l, Shape& n) {
  constexpr int edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  for (std::size_t a = 0; a < 4; ++a) n[a] = l[a] * (Dual(2) * l[a] - Dual(1));
  for (std::size_t e = 0; e < 6; ++e)
    n[4 + e] = Dual(4) * l[static_cast<std::size_t>(edge[e][0])] * l[static_cast<std::size_t>(edge[e][1])];
}

Shape shape(ElementKind kind, const Dual& x, const Dual& y, const Dual& z) {
  Shape n;
  const Dual one(1), half(0.5L), rest = one - x - y;
  switch (kind) {
    case ElementKind::hex8:
      hex8(x, y, z, n);
      break;
    case ElementKind::hex20:
      hex20(x, y, z, n);
      break;
    case ElementKind::tet4:
      n[0] = rest - z, n[1] = x, n[2] = y, n[3] = z;
      break;
    case ElementKind::tet10:
      tet10({rest - z, x, y, z}, n);
      break;
    case ElementKind::wedge6: {
      const std::array<Dual, 3> l{rest, x, y};
      for (std::size_t a = 0; a < 3; ++a) n[a] = half * l[a] * (one - z), n[a + 3] = half * l[a] * (one + z);
      break;
    }
    default: {  // pyramid5
      const Dual height = one - z, twist = height.v == 0 ? Dual(0) : x * y / height;
      for (std::size_t a = 0; a < 4; ++a) {
        const int* s = hex_sign[a];
        n[a] = Dual(0.25L) * (one_plus(s[0], x) + Dual(s[1]) * y + Dual(s[0] * s[1]) * twist - z);
      }
      n[4] = z;
    }
  }
  return n;
}

Extended3 cross(const Extended3& a, const Extended3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Extended dot(const Extended3& a, const Extended3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Extended greatest(const Extended3& a) {
  return std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])});
}

bool simplex(ElementKind kind) {
  return kind == ElementKind::tet4 || kind == ElementKind::tet10;
}

}  // namespace

ExtendedOracle::ExtendedOracle(ElementKind kind, std::span<const Vec3> nodes) : kind_(kind) {
  for (const Vec3& p : nodes) {
    x_.push_back({p[0], p[1], p[2]});
    for (std::size_t c = 0; c < 3; ++c) size_ = std::max(size_, std::abs(x_.back()[c] - x_.front()[c]));
  }
}

std::array<Dual, 3> ExtendedOracle::map(const Extended3& xi) const {
  std::array<Dual, 3> s{xi[0], xi[1], xi[2]};
  for (std::size_t i = 0; i < 3; ++i) s[i].d[i] = 1;
  const Shape n = shape(kind_, s[0], s[1], s[2]);
  std::array<Dual, 3> x;
  for (std::size_t a = 0; a < x_.size(); ++a)
    for (std::size_t c = 0; c < 3; ++c) {
      x[c].v += n[a].v * x_[a][c];
      for (std::size_t i = 0; i < 3; ++i) x[c].d[i] += n[a].d[i] * x_[a][c];
    }
  return x;
}

Extended3 ExtendedOracle::position(const Extended3& xi) const {
  const std::array<Dual, 3> x = map(xi);
  return {x[0].v, x[1].v, x[2].v};
}

Extended ExtendedOracle::determinant(const Extended3& xi) const {
  const std::array<Dual, 3> x = map(xi);
  return dot(x[0].d, cross(x[1].d, x[2].d));
}

Extended ExtendedOracle::overshoot(ElementKind kind, const Extended3& xi) {
  const Extended x = std::abs(xi[0]), y = std::abs(xi[1]), z = std::abs(xi[2]);
  switch (kind) {
    case ElementKind::tet4:
    case ElementKind::tet10:
      return 2 * std::max({-xi[0], -xi[1], -xi[2], xi[0] + xi[1] + xi[2] - 1});
    case ElementKind::wedge6:
      return std::max(2 * std::max({-xi[0], -xi[1], xi[0] + xi[1] - 1}), z - 1);
    case ElementKind::pyramid5:
      return std::max(-2 * xi[2], std::max(x, y) + xi[2] - 1);
    default:
      return std::max({x, y, z}) - 1;
  }
}

std::optional<OraclePlace> ExtendedOracle::from(const Vec3& point, const Extended3& start) const {
  Extended3 xi = start;
  for (int i = 0; i < 60; ++i) {
    const std::array<Dual, 3> x = map(xi);
    const Extended3 r{x[0].v - point[0], x[1].v - point[1], x[2].v - point[2]};
    // Rows of the Jacobian are x[c].d; the columns of its inverse are crosses of rows.
    const std::array<Extended3, 3> column{cross(x[1].d, x[2].d), cross(x[2].d, x[0].d), cross(x[0].d, x[1].d)};
    const Extended determinant = dot(x[0].d, column[0]);
    if (!(std::abs(determinant) > 0)) return std::nullopt;
    Extended3 step{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t c = 0; c < 3; ++c) step[k] += column[c][k] * r[c] / determinant;
    const Extended length = greatest(step), reach = 1 + greatest(xi);
    if (!std::isfinite(length)) return std::nullopt;
    const Extended damp = length > reach ? reach / length : 1;
    for (std::size_t k = 0; k < 3; ++k) xi[k] -= damp * step[k];
    if (length > 1e-12L * reach) continue;
    // The step is below the square root of round-off: what follows it is round-off.
    OraclePlace place{xi, overshoot(kind_, xi), 0};
    for (std::size_t k = 0; k < 3; ++k) {
      Extended row = 0;
      for (std::size_t c = 0; c < 3; ++c) row += std::abs(column[c][k] / determinant);
      place.stretch = std::max(place.stretch, row);
    }
    return place;
  }
  return std::nullopt;
}

std::optional<OraclePlace> ExtendedOracle::find(const Vec3& point, int n) const {
  std::optional<OraclePlace> best;
  // Coordinates that go from 0 to 1 instead of -1 to 1.
  const bool pyramid = kind_ == ElementKind::pyramid5, triangle = simplex(kind_) || kind_ == ElementKind::wedge6;
  const std::array<bool, 3> from_zero{triangle, triangle, simplex(kind_) || pyramid};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        Extended3 start{(2 * i + 1.0L) / n - 1, (2 * j + 1.0L) / n - 1, (2 * k + 1.0L) / n - 1};
        for (std::size_t c = 0; c < 3; ++c)
          if (from_zero[c]) start[c] = (start[c] + 1) / 2;
        if (overshoot(kind_, start) > 0) continue;
        const std::optional<OraclePlace> found = from(point, start);
        if (found && (!best || found->overshoot < best->overshoot)) best = found;
        if (best && best->overshoot <= 0) return best;
      }
  return best;
}

}  // namespace tenon::transfer::testing

// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/element_points.hpp"

#include <algorithm>
#include <cmath>

namespace tenon::transfer {

namespace {

TabulatedPoint tabulated(ElementKind kind, const Vec3& xi, double weight) {
  TabulatedPoint point;
  point.xi = xi;
  point.weight = weight;
  const auto nodes = static_cast<std::size_t>(topology(kind).nodes);
  shape_values(kind, xi, std::span(point.value).first(nodes));
  shape_gradients(kind, xi, std::span(point.gradient).first(nodes));
  return point;
}

/// Visits all (i, j, k) of a lattice of n^3 cells.
template <typename Visit>
void lattice(int n, Visit&& visit) {
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) visit(i, j, k);
}

/// Visits all (i, j) of a lattice of n^2 cells.
template <typename Visit>
void flat_lattice(int n, Visit&& visit) {
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) visit(i, j);
}

/// A tetrahedron cut by planes parallel to its faces: upright tetrahedra, octahedra (four times their volume) and
/// inverted tetrahedra, each by its centroid.
void subdivide_tet(ElementKind kind, int n, std::vector<TabulatedPoint>& points) {
  const double cell = 1.0 / (6.0 * n * n * n);
  const auto at = [&](int i, int j, int k, double shift, double weight) {
    points.push_back(tabulated(kind, {(i + shift) / n, (j + shift) / n, (k + shift) / n}, weight));
  };
  lattice(n, [&](int i, int j, int k) {
    const int level = i + j + k;
    if (level <= n - 1) at(i, j, k, 0.25, cell);
    if (level <= n - 2) at(i, j, k, 0.5, 4 * cell);
    if (level <= n - 3) at(i, j, k, 0.75, cell);
  });
}

void subdivide_wedge(int n, std::vector<TabulatedPoint>& points) {
  const double cell = 1.0 / (n * n) * (1.0 / n);
  const auto at = [&](int i, int j, int k, double shift) {
    points.push_back(tabulated(ElementKind::wedge6, {(i + shift) / n, (j + shift) / n, -1 + (2 * k + 1.0) / n}, cell));
  };
  lattice(n, [&](int i, int j, int k) {
    if (i + j <= n - 1) at(i, j, k, 1.0 / 3.0);
    if (i + j <= n - 2) at(i, j, k, 2.0 / 3.0);
  });
}

void subdivide_tri(int n, std::vector<TabulatedPoint>& points) {
  const double cell = 0.5 / (n * n);
  const auto at = [&](int i, int j, double shift) {
    points.push_back(tabulated(ElementKind::tri3, {(i + shift) / n, (j + shift) / n, 0}, cell));
  };
  flat_lattice(n, [&](int i, int j) {
    if (i + j <= n - 1) at(i, j, 1.0 / 3.0);
    if (i + j <= n - 2) at(i, j, 2.0 / 3.0);
  });
}

/// Layers of equal height; the section at zeta is the square |xi|, |eta| <= 1 - zeta.
void subdivide_pyramid(int n, std::vector<TabulatedPoint>& points) {
  lattice(n, [&](int i, int j, int k) {
    const double zeta = (k + 0.5) / n, width = 1 - zeta;
    const Vec3 xi{width * (-1 + (2 * i + 1.0) / n), width * (-1 + (2 * j + 1.0) / n), zeta};
    points.push_back(tabulated(ElementKind::pyramid5, xi, 4 * width * width / (n * n) * (1.0 / n)));
  });
}

}  // namespace

std::vector<TabulatedPoint> quadrature_points(ElementKind kind) {
  std::vector<TabulatedPoint> points;
  for (const QuadraturePoint& q : quadrature(kind)) points.push_back(tabulated(kind, q.xi, q.weight));
  return points;
}

std::vector<TabulatedPoint> subdivision_points(ElementKind kind, int n) {
  std::vector<TabulatedPoint> points;
  const auto mid = [n](int i) { return -1 + (2 * i + 1.0) / n; };
  const double cell = 1.0 / n * (1.0 / n) * (1.0 / n);
  switch (kind) {
    case ElementKind::tet4:
    case ElementKind::tet10:
      subdivide_tet(kind, n, points);
      break;
    case ElementKind::wedge6:
      subdivide_wedge(n, points);
      break;
    case ElementKind::pyramid5:
      subdivide_pyramid(n, points);
      break;
    case ElementKind::tri3:
      subdivide_tri(n, points);
      break;
    case ElementKind::quad4:
      flat_lattice(n, [&](int i, int j) { points.push_back(tabulated(kind, {mid(i), mid(j), 0}, 4.0 / (n * n))); });
      break;
    default:
      lattice(n, [&](int i, int j, int k) { points.push_back(tabulated(kind, {mid(i), mid(j), mid(k)}, 8 * cell)); });
  }
  return points;
}

double measure(const TabulatedPoint& point, ElementKind kind, const Corners& corners) {
  Vec3 x_xi{}, x_eta{}, x_zeta{};
  const auto nodes = static_cast<std::size_t>(topology(kind).nodes);
  for (std::size_t a = 0; a < nodes; ++a) {
    x_xi = x_xi + point.gradient[a][0] * corners[a];
    x_eta = x_eta + point.gradient[a][1] * corners[a];
    x_zeta = x_zeta + point.gradient[a][2] * corners[a];
  }
  const Vec3 normal = cross(x_xi, x_eta);
  return topology(kind).dimension == 3 ? dot(normal, x_zeta) : norm(normal);
}

PointTable::PointTable(ElementKind kind, std::vector<TabulatedPoint> points)
    : kind_(kind), points_(std::move(points)), padded_((points_.size() + lanes - 1) / lanes * lanes) {
  const auto nodes = static_cast<std::size_t>(topology(kind).nodes);
  gradient_.assign(nodes * 3 * padded_, 0.0);
  weight_.assign(padded_, 0.0);
  for (std::size_t q = 0; q < points_.size(); ++q) {
    weight_[q] = points_[q].weight;
    for (std::size_t a = 0; a < nodes; ++a)
      for (std::size_t j = 0; j < 3; ++j) gradient_[(3 * a + j) * padded_ + q] = points_[q].gradient[a][j];
  }
}

void PointTable::volumes(const Corners& corners, std::span<double> volumes) const {
  const auto nodes = static_cast<std::size_t>(topology(kind_).nodes);
  const bool solid = topology(kind_).dimension == 3;
  using Lanes = std::array<double, lanes>;
  for (std::size_t first = 0; first < points_.size(); first += lanes) {
    std::array<Lanes, 9> j{};  // dx_c/dxi_i at 3 i + c
    for (std::size_t a = 0; a < nodes; ++a)
      for (std::size_t i = 0; i < 3; ++i) {
        const double* const g = gradient_.data() + (3 * a + i) * padded_ + first;
        for (std::size_t c = 0; c < 3; ++c)
          for (std::size_t l = 0; l < lanes; ++l) j[3 * i + c][l] += g[l] * corners[a][c];
      }
    Lanes result;
    for (std::size_t l = 0; l < lanes; ++l) {
      const double x = j[1][l] * j[5][l] - j[2][l] * j[4][l], y = j[2][l] * j[3][l] - j[0][l] * j[5][l],
                   z = j[0][l] * j[4][l] - j[1][l] * j[3][l];
      const double measure = solid ? (x * j[6][l] + y * j[7][l]) + z * j[8][l] : std::sqrt((x * x + y * y) + z * z);
      result[l] = weight_[first + l] * measure;
    }
    const std::size_t count = std::min(lanes, points_.size() - first);
    std::copy_n(result.begin(), count, volumes.begin() + static_cast<std::ptrdiff_t>(first));
  }
}

double edge_of(ElementKind kind, double measure) {
  return topology(kind).dimension == 3 ? std::cbrt(measure) : std::sqrt(measure);
}

Vec3 position(const TabulatedPoint& point, int nodes, const Corners& corners) {
  Vec3 x{};
  for (int n = 0; n < nodes; ++n) {
    const auto a = static_cast<std::size_t>(n);
    x = x + point.value[a] * corners[a];
  }
  return x;
}

std::vector<double> item_volumes(const Mesh& mesh, std::span<const Vec3> coordinates, Location location) {
  std::vector<double> volumes(static_cast<std::size_t>(item_count(mesh, location)), 0.0);
  std::size_t item = 0;
  for (const ElementBlock& block : mesh.blocks) {
    const PointTable table(block.kind, quadrature_points(block.kind));
    std::vector<double> weights(table.points().size());
    for (LocalIndex e = 0; e < block.size(); ++e, ++item) {
      const Corners corners = corners_of(block, e, coordinates);
      const auto connectivity = block.nodes(e);
      std::array<double, max_nodes> share{};
      double volume = 0;
      table.volumes(corners, weights);
      for (std::size_t q = 0; q < weights.size(); ++q) {
        volume += weights[q];
        // To the end of what linear kinds have: of fixed length, with zeros behind.
        for (std::size_t a = 0; a < max_linear_nodes; ++a) share[a] += weights[q] * table.points()[q].value[a];
        for (std::size_t a = max_linear_nodes; a < connectivity.size(); ++a)
          share[a] += weights[q] * table.points()[q].value[a];
      }
      if (location == Location::element) {
        volumes[item] = volume;
      } else {
        for (std::size_t a = 0; a < connectivity.size(); ++a)
          volumes[static_cast<std::size_t>(connectivity[a])] += share[a];
      }
    }
  }
  // Around a ghost node some elements may be missing here: its owner knows.
  if (location == Location::node && mesh.comm.size() > 1)
    mesh.node_halo.forward(std::span<const double>(volumes), std::span<double>(volumes));
  return volumes;
}

double mean_edge(const Mesh& mesh, std::span<const Vec3> coordinates) {
  ExactSum edges;
  for_each_element(mesh, [&](LocalIndex, const ElementBlock& block, LocalIndex e) {
    if (block.owners[static_cast<std::size_t>(e)] != mesh.comm.rank()) return;
    const Corners corners = corners_of(block, e, coordinates);
    const double size = element_measure(block.kind, std::span(corners).first(block.nodes(e).size()));
    edges.add(edge_of(block.kind, std::max(0.0, size)));
  });
  const double total = mesh.comm.sum(edges);
  return mesh.global_elements > 0 ? total / static_cast<double>(mesh.global_elements) : 0.0;
}

}  // namespace tenon::transfer

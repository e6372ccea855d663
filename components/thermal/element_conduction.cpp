// SPDX-License-Identifier: BSD-3-Clause
#include "components/thermal/element_conduction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/mesh/shape_functions.hpp"

namespace tenon::thermal {
namespace {

/// Values of eight elements, one per lane.
struct alignas(64) Lane {
  double v[lanes];
};

/// dx_c/dxi_d of each lane.
void jacobian(const ElementTable& table, const std::array<Vec3, max_linear_nodes>& gradient, const CornerBatch& corners,
              Lane (&j)[3][3]) {
  for (int c = 0; c < 3; ++c)
    for (int d = 0; d < 3; ++d) {
      Lane sum{};
      for (int a = 0; a < table.nodes; ++a) {
        const double g = gradient[static_cast<std::size_t>(a)][static_cast<std::size_t>(d)];
        for (int l = 0; l < lanes; ++l) sum.v[l] += corners.x[a][c][l] * g;
      }
      j[c][d] = sum;
    }
}

/// Cofactors of j (inverse = cofactors / determinant, transposed) and its determinant.
void cofactors(const Lane (&j)[3][3], Lane (&cof)[3][3], Lane& det) {
  for (int c = 0; c < 3; ++c)
    for (int d = 0; d < 3; ++d) {
      const Lane &p = j[(c + 1) % 3][(d + 1) % 3], &q = j[(c + 2) % 3][(d + 2) % 3];
      const Lane &r = j[(c + 1) % 3][(d + 2) % 3], &s = j[(c + 2) % 3][(d + 1) % 3];
      for (int l = 0; l < lanes; ++l) cof[c][d].v[l] = p.v[l] * q.v[l] - r.v[l] * s.v[l];
    }
  for (int l = 0; l < lanes; ++l)
    det.v[l] = j[0][0].v[l] * cof[0][0].v[l] + j[0][1].v[l] * cof[0][1].v[l] + j[0][2].v[l] * cof[0][2].v[l];
}

}  // namespace

ElementTable::ElementTable(ElementKind element_kind)
    : kind(element_kind), nodes(topology(element_kind).nodes), pairs(nodes * (nodes - 1) / 2) {
  const auto add_point = [this](const Vec3& xi, double w) {
    const auto p = static_cast<std::size_t>(points++);
    weight[p] = w;
    shape_gradients(kind, xi, gradient[p]);
  };
  if (kind == ElementKind::tet4)
    add_point(element_centre(kind), 1.0 / 6);
  else
    for (const QuadraturePoint& point : quadrature(kind)) add_point(point.xi, point.weight);
  shape_gradients(kind, element_centre(kind), centre_gradient);
}

namespace {

/// The integral, where `flux(b, l, kb)` gives k b of lane l.
template <typename Flux>
void integrate(const ElementTable& table, const CornerBatch& corners, ConductionBatch& result, const Flux& flux) {
  for (int p = 0; p < table.pairs; ++p)
    for (int l = 0; l < lanes; ++l) result.link[p][l] = 0;
  for (int l = 0; l < lanes; ++l) result.least_jacobian[l] = std::numeric_limits<double>::infinity();

  Lane j[3][3], cof[3][3], det, factor;
  Lane b[max_linear_nodes][3];  // det times the gradient of N_a in space
  Lane q_of[3];                 // the flux that it drives
  for (std::size_t q = 0; q < static_cast<std::size_t>(table.points); ++q) {
    jacobian(table, table.gradient[q], corners, j);
    cofactors(j, cof, det);
    for (int l = 0; l < lanes; ++l) {
      const double least = result.least_jacobian[l];
      result.least_jacobian[l] = det.v[l] < least || det.v[l] != det.v[l] ? det.v[l] : least;
      factor.v[l] = table.weight[q] / det.v[l];
    }
    for (int a = 0; a < table.nodes; ++a) {
      const Vec3& g = table.gradient[q][static_cast<std::size_t>(a)];
      for (int c = 0; c < 3; ++c)
        for (int l = 0; l < lanes; ++l)
          b[a][c].v[l] = cof[c][0].v[l] * g[0] + cof[c][1].v[l] * g[1] + cof[c][2].v[l] * g[2];
    }
    for (int i = 0, pair = 0; i < table.nodes; ++i) {
      flux(b[i], factor, q_of);
      for (int k = i + 1; k < table.nodes; ++k, ++pair)
        for (int l = 0; l < lanes; ++l)
          result.link[pair][l] +=
              q_of[0].v[l] * b[k][0].v[l] + q_of[1].v[l] * b[k][1].v[l] + q_of[2].v[l] * b[k][2].v[l];
    }
  }
}

}  // namespace

void conduction(const ElementTable& table, const CornerBatch& corners, const double (&conductivity)[lanes],
                ConductionBatch& result) {
  integrate(table, corners, result, [&conductivity](const Lane(&b)[3], const Lane& factor, Lane(&q)[3]) {
    for (int c = 0; c < 3; ++c)
      for (int l = 0; l < lanes; ++l) q[c].v[l] = factor.v[l] * conductivity[l] * b[c].v[l];
  });
}

void conduction(const ElementTable& table, const CornerBatch& corners, const std::array<Vec3, 3>& conductivity,
                ConductionBatch& result) {
  integrate(table, corners, result, [&conductivity](const Lane(&b)[3], const Lane& factor, Lane(&q)[3]) {
    for (std::size_t c = 0; c < 3; ++c)
      for (int l = 0; l < lanes; ++l)
        q[c].v[l] = factor.v[l] *
                    (conductivity[c][0] * b[0].v[l] + conductivity[c][1] * b[1].v[l] + conductivity[c][2] * b[2].v[l]);
  });
}

void eigenvalue_bound(const ElementTable& table, const ConductionBatch& links,
                      const double (&capacity)[max_linear_nodes][lanes], double (&bound)[lanes]) {
  constexpr int squarings = 7;
  const int n = table.nodes;
  // S = C^-1/2 K C^-1/2 has the eigenvalues of C^-1 K.
  Lane s[max_linear_nodes][max_linear_nodes] = {}, square[max_linear_nodes][max_linear_nodes];
  Lane root[max_linear_nodes];
  for (int i = 0; i < n; ++i)
    for (int l = 0; l < lanes; ++l) root[i].v[l] = 1 / std::sqrt(capacity[i][l]);
  for (int i = 0, pair = 0; i < n; ++i)
    for (int k = i + 1; k < n; ++k, ++pair)
      for (int l = 0; l < lanes; ++l) {
        const double link = links.link[pair][l], ri = root[i].v[l], rk = root[k].v[l];
        s[i][i].v[l] -= link * ri * ri;
        s[k][k].v[l] -= link * rk * rk;
        s[i][k].v[l] = s[k][i].v[l] = link * ri * rk;
      }
  // Scaled to the trace 1, so that no power can overflow, and none underflows: the greatest eigenvalue is 1/8 or more.
  Lane trace{}, inverse, last{};
  for (int i = 0; i < n; ++i)
    for (int l = 0; l < lanes; ++l) trace.v[l] += s[i][i].v[l];
  for (int l = 0; l < lanes; ++l) inverse.v[l] = 1 / trace.v[l];
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k)
      for (int l = 0; l < lanes; ++l) s[i][k].v[l] *= inverse.v[l];
  for (int squaring = 0; squaring < squarings; ++squaring) {
    for (int i = 0; i < n; ++i)
      for (int k = i; k < n; ++k) {
        Lane sum{};
        for (int m = 0; m < n; ++m)
          for (int l = 0; l < lanes; ++l) sum.v[l] += s[i][m].v[l] * s[m][k].v[l];
        square[i][k] = square[k][i] = sum;
      }
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) s[i][k] = square[i][k];
  }
  for (int i = 0; i < n; ++i)
    for (int l = 0; l < lanes; ++l) last.v[l] += s[i][i].v[l];
  for (int i = 0; i < squarings; ++i)
    for (int l = 0; l < lanes; ++l) last.v[l] = std::sqrt(last.v[l]);
  for (int l = 0; l < lanes; ++l) bound[l] = trace.v[l] * last.v[l] * (1 + 1e-12);
}

void nodal_volumes(ElementKind kind, std::span<const Vec3> corners, std::span<double> volumes) {
  std::ranges::fill(volumes, 0.0);
  std::array<double, max_linear_nodes> shape{};
  for (const QuadraturePoint& point : quadrature(kind)) {
    shape_values(kind, point.xi, shape);
    const double volume = point.weight * jacobian_determinant(kind, corners, point.xi);
    for (std::size_t a = 0; a < volumes.size(); ++a) volumes[a] += shape[a] * volume;
  }
}

namespace {

/// Calls use(N, dA) at the quadrature points of a side.
template <typename Use>
void integrate_side(std::span<const Vec3> corners, const Use& use) {
  const ElementKind kind = corners.size() == 3 ? ElementKind::tri3 : ElementKind::quad4;
  std::array<double, max_linear_nodes> shape{};
  std::array<Vec3, max_linear_nodes> gradient{};
  for (const QuadraturePoint& point : quadrature(kind)) {
    shape_values(kind, point.xi, shape);
    shape_gradients(kind, point.xi, gradient);
    Vec3 u{}, v{};
    for (std::size_t a = 0; a < corners.size(); ++a) {
      u = u + gradient[a][0] * corners[a];
      v = v + gradient[a][1] * corners[a];
    }
    use(shape, point.weight * norm(cross(u, v)));
  }
}

}  // namespace

void nodal_areas(std::span<const Vec3> corners, std::span<double> areas) {
  std::ranges::fill(areas, 0.0);
  integrate_side(corners, [&](const auto& shape, double area) {
    for (std::size_t a = 0; a < areas.size(); ++a) areas[a] += shape[a] * area;
  });
}

SideLinks side_links(std::span<const Vec3> corners) {
  SideLinks links{};
  integrate_side(corners, [&](const auto& shape, double area) {
    for (std::size_t a = 0; a < corners.size(); ++a)
      for (std::size_t b = a + 1; b < corners.size(); ++b) links[a][b] += shape[a] * shape[b] * area;
  });
  return links;
}

Vec3 centre_gradient(const ElementTable& table, std::span<const Vec3> corners, std::span<const double> values) {
  Vec3 column[3]{}, slope{};  // dx/dxi_d and dT/dxi_d
  for (std::size_t a = 0; a < corners.size(); ++a)
    for (std::size_t d = 0; d < 3; ++d) {
      column[d] = column[d] + table.centre_gradient[a][d] * corners[a];
      slope[d] += table.centre_gradient[a][d] * (values[a] - values[0]);
    }
  const double det = dot(column[0], cross(column[1], column[2]));
  const Vec3 sum = slope[0] * cross(column[1], column[2]) + slope[1] * cross(column[2], column[0]) +
                   slope[2] * cross(column[0], column[1]);
  return (1 / det) * sum;
}

}  // namespace tenon::thermal

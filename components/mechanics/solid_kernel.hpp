// SPDX-License-Identifier: BSD-3-Clause
// Fully integrated solids of any shape: geometry at all points, and strains whose volume part is the element's mean.
#pragma once

#include <cstddef>
#include <cstdint>

#include "components/mechanics/kinematics.hpp"
#include "components/mechanics/nodal_state.hpp"
#include "framework/mesh/shape_functions.hpp"

namespace tenon {

/// Quadrature of one kind of element with N nodes and P points.
template <int N, int P>
struct SolidTable {
  explicit SolidTable(ElementKind kind) {
    const auto add = [&](int p, const Vec3& xi, double w) {
      weight[p] = w;
      shape_gradients(kind, xi, gradient[static_cast<std::size_t>(p)]);
    };
    if constexpr (P == 1) {
      add(0, element_centre(kind), 1.0 / 6);  // tet4
    } else {
      const std::span<const QuadraturePoint> rule = quadrature(kind);
      for (int p = 0; p < P; ++p)
        add(p, rule[static_cast<std::size_t>(p)].xi, rule[static_cast<std::size_t>(p)].weight);
    }
  }
  double weight[P];
  std::array<std::array<Vec3, N>, P> gradient;  ///< dN_a/dxi
};

/// Local node numbers of a batch of elements of N nodes.
template <int N>
struct alignas(64) SolidConnectivity {
  std::int32_t node[N][lanes];
};

/// A nodal vector at the nodes of four elements, relative to node 0: a uniform motion is exactly zero.
template <typename R, int N>
struct NodeVectors {
  Vector<R> at[N];
};

template <int N>
TENON_KERNEL NodeVectors<Pack, N> gather(const double* values, const SolidConnectivity<N>& c, int lane) {
  NodeVectors<Pack, N> result;
  const auto row = [&](int node, int l) {
    return load(values + 3 * static_cast<std::ptrdiff_t>(c.node[node][lane + l]));
  };
  const Pack r0 = row(0, 0), r1 = row(0, 1), r2 = row(0, 2), r3 = row(0, 3);
  result.at[0] = {Pack{}, Pack{}, Pack{}};
  for (int i = 1; i < N; ++i) {
    Pack a = row(i, 0) - r0, b = row(i, 1) - r1, d = row(i, 2) - r2, e = row(i, 3) - r3;
    transpose(a, b, d, e);
    result.at[i] = {a, b, d};
  }
  return result;
}

/// Gradients of the shape functions in space at all points, and their mean over the volume.
template <typename R, int N, int P>
struct SolidGeometry {
  Vector<R> gradient[P][N];  ///< 1/m
  R share[P];                ///< of the volume, m^3
  Vector<R> mean[N];         ///< 1/m
  R volume;                  ///< m^3
  R least;                   ///< least Jacobian determinant of all points; not a number if one is
};

template <typename R, int N, int P>
TENON_KERNEL SolidGeometry<R, N, P> solid_geometry(const SolidTable<N, P>& table, const NodeVectors<R, N>& x) {
  SolidGeometry<R, N, P> g;
  g.volume = R{};
  for (int p = 0; p < P; ++p) {
    Vector<R> j[3] = {{R{}, R{}, R{}}, {R{}, R{}, R{}}, {R{}, R{}, R{}}};  // dx/dxi_d
    for (int a = 0; a < N; ++a)
      for (std::size_t d = 0; d < 3; ++d)
        j[d] =
            j[d] + broadcast<R>(table.gradient[static_cast<std::size_t>(p)][static_cast<std::size_t>(a)][d]) * x.at[a];
    const Vector<R> c0 = cross(j[1], j[2]), c1 = cross(j[2], j[0]), c2 = cross(j[0], j[1]);
    const R determinant = dot(j[0], c0), inverse = 1.0 / determinant;
    g.least = p == 0 ? determinant : (g.least < determinant ? g.least : determinant);
    g.share[p] = table.weight[p] * determinant;
    g.volume = g.volume + g.share[p];
    for (int a = 0; a < N; ++a) {
      const Vec3& n = table.gradient[static_cast<std::size_t>(p)][static_cast<std::size_t>(a)];
      g.gradient[p][a] = inverse * ((broadcast<R>(n[0]) * c0 + broadcast<R>(n[1]) * c1) + broadcast<R>(n[2]) * c2);
    }
  }
  const R inverse_volume = 1.0 / g.volume;
  for (int a = 0; a < N; ++a) {
    Vector<R> sum = g.share[0] * g.gradient[0][a];
    for (int p = 1; p < P; ++p) sum = sum + g.share[p] * g.gradient[p][a];
    g.mean[a] = inverse_volume * sum;
  }
  return g;
}

/// Gradient of the nodal vector u at point p: rows u_i,j.
template <typename R, int N>
TENON_KERNEL Tensor<R> gradient_of(const NodeVectors<R, N>& u, const Vector<R> (&gradient)[N]) {
  Tensor<R> l{{R{}, R{}, R{}}, {R{}, R{}, R{}}, {R{}, R{}, R{}}};
  for (int a = 1; a < N; ++a) {
    l.x = l.x + u.at[a].x * gradient[a];
    l.y = l.y + u.at[a].y * gradient[a];
    l.z = l.z + u.at[a].z * gradient[a];
  }
  return l;
}

/// Its mean divergence over the volume.
template <typename R, int N>
TENON_KERNEL R divergence(const NodeVectors<R, N>& u, const Vector<R> (&mean)[N]) {
  R sum{};
  for (int a = 1; a < N; ++a) sum = sum + dot(u.at[a], mean[a]);
  return sum;
}

/// l with its trace replaced.
template <typename R>
TENON_KERNEL Tensor<R> with_trace(const Tensor<R>& l, const R& trace) {
  const R more = (1.0 / 3.0) * (trace - (l.x.x + l.y.y + l.z.z));
  return {{l.x.x + more, l.x.y, l.x.z}, {l.y.x, l.y.y + more, l.y.z}, {l.z.x, l.z.y, l.z.z + more}};
}

/// Forces of the points' deviators (xx yy zz xy yz zx of each) and of the mean stress of the element: the transpose of
/// strains by `with_trace` of `divergence`, so the power is that of the stresses [Hug80].
template <typename R, int N, int P>
TENON_KERNEL void solid_forces(const SolidGeometry<R, N, P>& g, const SymmetricTensor<R> (&deviator)[P], const R& mean,
                               NodeVectors<R, N>& f) {
  const R pressure = mean * g.volume;
  for (int a = 0; a < N; ++a) {
    f.at[a] = pressure * g.mean[a];
    for (int p = 0; p < P; ++p) {
      const SymmetricTensor<R>& s = deviator[p];
      const Vector<R> b = g.share[p] * g.gradient[p][a];
      f.at[a] = f.at[a] + Vector<R>{s.xx * b.x + s.xy * b.y + s.zx * b.z, s.xy * b.x + s.yy * b.y + s.yz * b.z,
                                    s.zx * b.x + s.yz * b.y + s.zz * b.z};
    }
  }
}

}  // namespace tenon

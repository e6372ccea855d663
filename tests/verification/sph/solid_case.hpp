// SPDX-License-Identifier: BSD-3-Clause
// What cases of particles of solids share: bodies of given points, and materials.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <vector>

#include "sph_case.hpp"

namespace tenon::testing {

struct Points {
  std::vector<Vec3> at;
  std::vector<double> volume;
};

inline MeshData body_of_points(const Points& points) {
  MeshData mesh;
  mesh.source = "points";
  mesh.coordinates = points.at, mesh.volumes = points.volume;
  BlockData block;
  block.name = "points", block.label = 1, block.kind = ElementKind::particle;
  for (std::size_t n = 0; n < points.at.size(); ++n) {
    block.connectivity.push_back(static_cast<GlobalId>(n));
    block.labels.push_back(static_cast<std::int64_t>(n) + 1);
    mesh.node_labels.push_back(static_cast<std::int64_t>(n) + 1);
  }
  mesh.blocks.push_back(std::move(block));
  return mesh;
}

/// Concentric rows of particles around a centre, each as far apart along its row as the rows are.
inline Points ring(const Vec3& centre, double inner, double outer, int rows) {
  Points points;
  const double spacing = (outer - inner) / rows;
  for (int r = 0; r < rows; ++r) {
    const double radius = inner + (r + 0.5) * spacing;
    const int count = static_cast<int>(std::lround(2 * std::numbers::pi * radius / spacing));
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.5 * (r % 2)) / count;
      points.at.push_back(centre + radius * Vec3{std::cos(angle), std::sin(angle), 0});
      points.volume.push_back(2 * std::numbers::pi * radius * spacing / count);
    }
  }
  return points;
}

/// A cubic lattice within the quarter x, y >= 0 of a cylinder on z = 0; all together of its volume.
inline Points quarter_cylinder(double radius, double length, int across) {
  Points points;
  const double spacing = radius / across;
  const int along = static_cast<int>(std::lround(length / spacing));
  for (int k = 0; k < along; ++k)
    for (int j = 0; j < across; ++j)
      for (int i = 0; i < across; ++i) {
        const Vec3 x{(i + 0.5) * spacing, (j + 0.5) * spacing, (k + 0.5) * length / along};
        if (std::hypot(x[0], x[1]) < radius) points.at.push_back(x);
      }
  points.volume.assign(points.at.size(),
                       0.25 * std::numbers::pi * radius * radius * length / static_cast<double>(points.at.size()));
  return points;
}

inline MaterialDescription elastic_solid(double density, double E, double nu) {
  MaterialDescription material;
  material.name = "elastic", material.density = density, material.elastic = Elasticity{E, nu, 0};
  return material;
}

/// How many groups of points hang together by steps of at most `reach`; x, y, z of each point.
inline int clusters(const std::vector<double>& x, double reach) {
  const std::size_t n = x.size() / 3;
  std::vector<std::size_t> parent(n);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double a = x[3 * i] - x[3 * j], b = x[3 * i + 1] - x[3 * j + 1], c = x[3 * i + 2] - x[3 * j + 2];
      if (a * a + b * b + c * c < reach * reach) parent[root(i)] = root(j);
    }
  int count = 0;
  for (std::size_t i = 0; i < n; ++i) count += parent[i] == i ? 1 : 0;
  return count;
}

}  // namespace tenon::testing

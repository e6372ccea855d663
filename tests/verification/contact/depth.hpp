// SPDX-License-Identifier: BSD-3-Clause
// How deep nodes lie under faces, found by trying all pairs: an oracle that shares nothing with contact.
#pragma once

#include <algorithm>

#include "contact_case.hpp"

namespace tenon::testing {

using Triangle = std::array<Vec3, 3>;

/// Present triangles of sides or shells of this rank: each quadrilateral gives four about its middle.
inline std::vector<Triangle> triangles_of(const Mechanics& body, const std::string& side_set,
                                          const std::string& shells = "") {
  std::vector<Triangle> triangles;
  const std::span<const Vec3> x = body.current_coordinates();
  const auto add = [&](std::vector<Vec3> corners) {
    Vec3 middle{};
    for (const Vec3& c : corners) middle = middle + (1.0 / static_cast<double>(corners.size())) * c;
    for (std::size_t k = 0; k < corners.size(); ++k)
      triangles.push_back({corners[k], corners[(k + 1) % corners.size()], middle});
  };
  const Mesh& mesh = body.mesh();
  if (const SideSet* set = mesh.find_side_set(side_set))
    for (const Side& side : set->sides) {
      const ElementBlock& block = mesh.blocks[static_cast<std::size_t>(side.block)];
      const Topology& t = topology(block.kind);
      std::vector<Vec3> corners;
      for (const int k : t.side[static_cast<std::size_t>(side.side)])
        if (k >= 0)
          corners.push_back(x[static_cast<std::size_t>(block.nodes(side.element)[static_cast<std::size_t>(k)])]);
      add(std::move(corners));
    }
  if (const ElementBlock* block = mesh.find_block(shells))
    for (LocalIndex e = 0; e < block->size(); ++e) {
      std::vector<Vec3> corners;
      for (const LocalIndex n : block->nodes(e)) corners.push_back(x[static_cast<std::size_t>(n)]);
      add(std::move(corners));
    }
  return triangles;
}

inline std::vector<Vec3> nodes_of(const Mechanics& body, const std::string& node_set) {
  std::vector<Vec3> places;
  for (const LocalIndex n : body.mesh().find_node_set(node_set)->nodes)
    places.push_back(body.current_coordinates()[static_cast<std::size_t>(n)]);
  return places;
}

/// Greatest depth along z of points below the triangles that lie over or under them as seen along z, m; on one rank.
/// Negative: all are above.
inline double depth_below(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  double deepest = -1e300;
  for (const Vec3& p : points)
    for (const Triangle& t : triangles) {
      const double area = (t[1][0] - t[0][0]) * (t[2][1] - t[0][1]) - (t[1][1] - t[0][1]) * (t[2][0] - t[0][0]);
      if (area == 0) continue;
      double height = 0;
      bool inside = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &a = t[(k + 1) % 3], &b = t[(k + 2) % 3];
        const double share = ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) / area;
        inside = inside && share >= 0;
        height += share * t[k][2];
      }
      if (inside) deepest = std::max(deepest, height - p[2]);
    }
  return deepest;
}

/// Present corners of the shells of this rank.
inline std::vector<std::array<Vec3, 4>> shells_of(const Mechanics& body, const std::string& shells) {
  std::vector<std::array<Vec3, 4>> faces;
  const ElementBlock& block = *body.mesh().find_block(shells);
  for (LocalIndex e = 0; e < block.size(); ++e)
    for (std::size_t k = 0; k < 4; ++k) {
      if (k == 0) faces.emplace_back();
      faces.back()[k] = body.current_coordinates()[static_cast<std::size_t>(block.nodes(e)[k])];
    }
  return faces;
}

/// The same below bilinear faces, however warped: where the vertical through a point meets the face, by Newton from
/// nine places.
inline double depth_below(const std::vector<Vec3>& points, const std::vector<std::array<Vec3, 4>>& faces) {
  double deepest = -1e300;
  for (const std::array<Vec3, 4>& x : faces) {
    const Vec3 mean = 0.25 * (x[0] + x[1] + x[2] + x[3]), a = 0.25 * (x[1] + x[2] - x[0] - x[3]),
               b = 0.25 * (x[2] + x[3] - x[0] - x[1]), c = 0.25 * (x[0] + x[2] - x[1] - x[3]);
    for (const Vec3& p : points) {
      bool near = true;  // in the upright box about the face
      for (std::size_t d = 0; d < 2; ++d)
        near = near && std::abs(p[d] - mean[d]) <= std::abs(a[d]) + std::abs(b[d]) + std::abs(c[d]);
      for (int start = 0; near && start < 9; ++start) {
        double r = start % 3 - 1, s = start / 3 - 1;
        Vec3 off{};
        for (int i = 0; i < 30; ++i) {
          off = p - (mean + r * a + s * b + (r * s) * c);
          const Vec3 dr = a + s * c, ds = b + r * c;
          const double det = dr[0] * ds[1] - dr[1] * ds[0];
          if (det == 0) break;
          r += (off[0] * ds[1] - off[1] * ds[0]) / det, s += (dr[0] * off[1] - dr[1] * off[0]) / det;
        }
        if (std::abs(r) <= 1 && std::abs(s) <= 1 && std::hypot(off[0], off[1]) < 1e-9 * norm(x[2] - x[0]))
          deepest = std::max(deepest, -off[2]);
      }
    }
  }
  return deepest;
}

/// Distance of a point from a triangle, m [Ericson 2005, 5.1.5].
inline double distance(const Vec3& p, const Triangle& t) {
  const Vec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return norm(ap);
  const Vec3 bp = p - t[1];
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return norm(bp);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return norm(ap - (d1 / (d1 - d3)) * ab);
  const Vec3 cp = p - t[2];
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return norm(cp);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return norm(ap - (d2 / (d2 - d6)) * ac);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return norm(bp - ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (t[2] - t[1]));
  const Vec3 n = cross(ab, ac);
  return std::abs(dot(n, ap)) / norm(n);
}

}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// The space that a mesh encloses: inside or not by crossings of a line along z (in a plane: along x).
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <span>

#include "framework/base/error.hpp"
#include "framework/mesh/facets.hpp"
#include "framework/mesh/particle_bodies.hpp"
#include "framework/mesh/shape_functions.hpp"
#include "framework/search/box_tree.hpp"

namespace tenon {

namespace {

/// Whether the line from the point towards greater x, in the plane, crosses the edge. The answer for an edge does not
/// depend on its direction, so of edges that meet, along a closed path, an even number is crossed whatever the
/// rounding, and a corner counts for one of the two edges at it.
bool crosses(const Vec3& point, const Vec3& from, const Vec3& to) {
  const bool swapped = to[1] < from[1] || (to[1] == from[1] && to[0] < from[0]);
  const Vec3 &low = swapped ? to : from, &high = swapped ? from : to;
  if (!(low[1] <= point[1] && point[1] < high[1])) return false;
  return (high[0] - low[0]) * (point[1] - low[1]) - (point[0] - low[0]) * (high[1] - low[1]) > 0;
}

using Triangle = std::array<GlobalId, 3>;

/// Triangles (or, in a plane, edges with the last node -1) of the boundary, and what finds them.
struct Boundary {
  std::vector<Vec3> nodes;
  std::vector<Triangle> sides;
  BoxTree columns;  // endless along the line that is followed
  BoxTree boxes;

  const Vec3& at(const Triangle& t, std::size_t i) const { return nodes[static_cast<std::size_t>(t[i])]; }

  void build(int dimension) {
    const std::size_t along = dimension == 2 ? 0 : 2;
    std::vector<Box> all(sides.size());
    for (std::size_t s = 0; s < sides.size(); ++s)
      for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i) all[s].add(at(sides[s], i));
    boxes.build(all);
    Box whole;
    for (const Box& box : all) whole.add(box);
    for (Box& box : all) box.low[along] = whole.low[along], box.high[along] = whole.high[along];
    columns.build(all);
  }

  /// Of a triangle whose image in the plane z = 0 holds the point: whether it is above the point.
  bool above(const Triangle& t, const Vec3& point) const {
    const Vec3 a = at(t, 0), n = cross(at(t, 1) - a, at(t, 2) - a);
    return n[2] != 0 && a[2] - (n[0] * (point[0] - a[0]) + n[1] * (point[1] - a[1])) / n[2] > point[2];
  }

  bool inside(const Vec3& point, int dimension) const {
    std::vector<LocalIndex> found;
    columns.containing({point[0], point[1], point[2]}, found);
    bool odd = false;
    for (const LocalIndex s : found) {
      const Triangle& t = sides[static_cast<std::size_t>(s)];
      if (dimension == 2) {
        odd ^= crosses(point, at(t, 0), at(t, 1));
        continue;
      }
      const bool hit =
          crosses(point, at(t, 0), at(t, 1)) ^ crosses(point, at(t, 1), at(t, 2)) ^ crosses(point, at(t, 2), at(t, 0));
      odd ^= hit && above(t, point);
    }
    return odd;
  }

  ParticleRegion::Surface surface(const Vec3& point, int dimension) const {
    double least = std::numeric_limits<double>::infinity();
    Vec3 to{};
    boxes.nearest(point, std::numeric_limits<double>::infinity(), [&](LocalIndex s) {
      const Triangle& t = sides[static_cast<std::size_t>(s)];
      const std::array<Vec3, 3> corners{at(t, 0), at(t, 1), dimension == 2 ? at(t, 1) : at(t, 2)};
      const Vec3 foot = nearest_on(corners, point);
      const double d = norm(foot - point);
      if (d < least) least = d, to = foot;
      return d;
    });
    const bool in = inside(point, dimension);
    const Vec3 way = in ? to - point : point - to;
    return {in ? -least : least, least > 0 ? (1 / least) * way : Vec3{}};
  }

  static Vec3 nearest_on(const std::array<Vec3, 3>& corners, const Vec3& point) {
    if (corners[1] == corners[2]) {
      const Vec3 d = corners[1] - corners[0];
      return corners[0] + std::clamp(dot(point - corners[0], d) / dot(d, d), 0.0, 1.0) * d;
    }
    const Vec3 xi = nearest_point(ElementKind::tri3, corners, point).xi;
    return corners[0] + xi[0] * (corners[1] - corners[0]) + xi[1] * (corners[2] - corners[0]);
  }
};

void add_polygon(std::vector<Triangle>& sides, std::span<const GlobalId> corners) {
  for (std::size_t i = 2; i < corners.size(); ++i) sides.push_back({corners[0], corners[i - 1], corners[i]});
}

void add_skin(const MeshData& mesh, std::vector<Triangle>& sides) {
  const std::vector<GlobalId> first = first_elements(mesh);
  std::vector<GlobalId> corners;
  for (const SideData& side : skin(mesh)) {
    const auto b =
        static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), side.element) - first.begin()) - 1;
    const BlockData& block = mesh.blocks[b];
    const Topology& t = topology(block.kind);
    const auto s = static_cast<std::size_t>(side.side);
    const auto at = static_cast<std::size_t>(side.element - first[b]) * static_cast<std::size_t>(t.nodes);
    corners.clear();
    for (std::size_t i = 0; i < static_cast<std::size_t>(t.side_nodes[s]); ++i)
      corners.push_back(block.connectivity[at + static_cast<std::size_t>(t.side[s][i])]);
    add_polygon(sides, corners);
  }
}

/// Edges of all surface elements: those between two are crossed twice, and so do not count.
void add_outlines(const MeshData& mesh, std::vector<Triangle>& sides) {
  for (const BlockData& block : mesh.blocks) {
    if (topology(block.kind).dimension != 2) continue;
    const auto n = static_cast<std::size_t>(topology(block.kind).nodes);
    for (std::size_t e = 0; e < block.size(); ++e)
      for (std::size_t i = 0; i < n; ++i)
        sides.push_back({block.connectivity[n * e + i], block.connectivity[n * e + (i + 1) % n], -1});
  }
}

std::vector<Triangle> single_edges(const std::vector<Triangle>& sides) {
  std::map<std::pair<GlobalId, GlobalId>, int> count;
  const auto key = [](const Triangle& t) { return std::pair{std::min(t[0], t[1]), std::max(t[0], t[1])}; };
  for (const Triangle& t : sides) ++count[key(t)];
  std::vector<Triangle> single;
  for (const Triangle& t : sides)
    if (count[key(t)] % 2 != 0) single.push_back(t);
  return single;
}

void require_closed(const MeshData& mesh, const std::vector<Triangle>& sides) {
  std::map<std::pair<GlobalId, GlobalId>, int> count;
  for (const Triangle& t : sides)
    for (std::size_t i = 0; i < 3; ++i) {
      const GlobalId a = t[i], b = t[(i + 1) % 3];
      ++count[{std::min(a, b), std::max(a, b)}];
    }
  for (const auto& [edge, n] : count) {
    if (n % 2 == 0) continue;
    const Vec3 x = mesh.coordinates[static_cast<std::size_t>(edge.first)];
    throw Error(ExitCode::geometry,
                fmt::format("{}: the surface is not closed: {} of its faces meet at the edge from node {} to node {} "
                            "near ({:.6g}, {:.6g}, {:.6g}); close the surface, or mesh the body with solids",
                            mesh.source, n, mesh.node_labels[static_cast<std::size_t>(edge.first)],
                            mesh.node_labels[static_cast<std::size_t>(edge.second)], x[0], x[1], x[2]));
  }
}

/// By Gauss: a third of the sum of x . n dA, or half of that of x . n ds. Faces of a surface may have any orientation:
/// out is where a point just beside the middle is outside.
double measure_of(const Boundary& boundary, int dimension) {
  double sum = 0;
  for (const Triangle& t : boundary.sides) {
    const Vec3 a = boundary.at(t, 0), b = boundary.at(t, 1), c = dimension == 2 ? 0.5 * (a + b) : boundary.at(t, 2);
    const Vec3 area = dimension == 2 ? Vec3{b[1] - a[1], a[0] - b[0], 0} : 0.5 * cross(b - a, c - a);
    const double size = norm(area);
    if (size == 0) continue;
    const Vec3 middle = dimension == 2 ? c : (1.0 / 3) * (a + b + c);
    const double step = 1e-6 * (dimension == 2 ? size : std::sqrt(size));
    const bool outward = !boundary.inside(middle + (step / size) * area, dimension);
    sum += (outward ? 1 : -1) * dot(middle, area) / dimension;
  }
  return sum;
}

}  // namespace

ParticleRegion mesh_region(const MeshData& mesh, int dimension) {
  const auto boundary = std::make_shared<Boundary>();
  boundary->nodes = mesh.coordinates;
  if (dimension == 2) {
    std::vector<Triangle> outlines;
    add_outlines(mesh, outlines);
    boundary->sides = single_edges(outlines);
  } else {
    add_skin(mesh, boundary->sides);
    require_closed(mesh, boundary->sides);
  }
  if (boundary->sides.empty())
    throw Error(ExitCode::usage, fmt::format("{}: no {} that could be filled with particles", mesh.source,
                                             dimension == 2 ? "surface elements" : "solids and no surface"));
  boundary->build(dimension);
  ParticleRegion region;
  region.name = mesh.source;
  for (const Triangle& t : boundary->sides)
    for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i) region.bounds.add(boundary->at(t, i));
  region.measure = measure_of(*boundary, dimension);
  region.inside = [boundary, dimension](const Vec3& x) { return boundary->inside(x, dimension); };
  region.surface = [boundary, dimension](const Vec3& x) { return boundary->surface(x, dimension); };
  return region;
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
#include "components/thermal/surface_projection.hpp"

#include <cmath>
#include <limits>

#include "framework/mesh/shape_functions.hpp"
#include "framework/search/distributed_search.hpp"

namespace tenon::thermal {
namespace {

/// A side as it travels to where it is searched.
struct Face {
  std::array<Vec3, max_side_nodes> corners{};
  std::array<GlobalId, max_side_nodes> nodes{no_id, no_id, no_id, no_id};
  GlobalId id = no_id;  ///< of all sides of all elements
  int count = 0;

  std::span<const Vec3> span() const { return std::span(corners).first(static_cast<std::size_t>(count)); }
};

std::vector<Face> owned_faces(const Mesh& mesh, const SideSet& surface, std::span<const Vec3> coordinates) {
  std::vector<Face> faces;
  for (const Side& side : surface.sides) {
    const ElementBlock& block = mesh.blocks[static_cast<std::size_t>(side.block)];
    const auto element = static_cast<std::size_t>(side.element);
    if (block.owners[element] != mesh.comm.rank()) continue;
    const SideCorners corners = side_corners(mesh, side);
    Face& face = faces.emplace_back();
    face.count = static_cast<int>(corners.count);
    face.id = block.ids[element] * max_sides + side.side;
    for (std::size_t a = 0; a < corners.count; ++a) {
      face.corners[a] = coordinates[static_cast<std::size_t>(corners.nodes[a])];
      face.nodes[a] = mesh.node_ids[static_cast<std::size_t>(corners.nodes[a])];
    }
  }
  return faces;
}

Opposite opposite(const Looker& looker, const BoxTree& tree, std::span<const Face> faces,
                  std::vector<LocalIndex>& found) {
  constexpr double facing = -0.5, ahead = 0.7;  // cosines of 120 and of about 45 degrees
  Box box;
  box.add(looker.place);
  box.inflate(looker.reach);
  found.clear();
  tree.overlapping(box, found);
  double least = std::numeric_limits<double>::infinity();
  GlobalId least_id = no_id;
  Opposite best;
  for (const LocalIndex f : found) {
    const Face& face = faces[static_cast<std::size_t>(f)];
    if (!(dot(side_normal(face.span()), looker.normal) < facing)) continue;
    const ElementKind kind = face.count == 3 ? ElementKind::tri3 : ElementKind::quad4;
    const NearestPoint nearest = nearest_point(kind, face.span(), looker.place);
    const bool nearer = nearest.distance < least || (nearest.distance == least && face.id < least_id);
    if (!nearer || !(nearest.distance <= looker.reach)) continue;
    const Vec3 way = map_to_space(kind, face.span(), nearest.xi) - looker.place;
    const double along = dot(way, looker.normal);
    if (nearest.distance > looker.touch && std::abs(along) < ahead * nearest.distance) continue;
    least = nearest.distance, least_id = face.id;
    best.nodes = face.nodes, best.count = face.count;
    best.weights = {};
    shape_values(kind, nearest.xi, std::span(best.weights).first(static_cast<std::size_t>(face.count)));
    best.gap = along > 0 ? nearest.distance : 0;
  }
  return best;
}

}  // namespace

SideCorners side_corners(const Mesh& mesh, const Side& side) {
  const ElementBlock& block = mesh.blocks[static_cast<std::size_t>(side.block)];
  const Topology& shape = topology(block.kind);
  const auto s = static_cast<std::size_t>(side.side);
  SideCorners corners;
  corners.count = static_cast<std::size_t>(shape.side_nodes[s]);
  for (std::size_t a = 0; a < corners.count; ++a)
    corners.nodes[a] = block.nodes(side.element)[static_cast<std::size_t>(shape.side[s][a])];
  return corners;
}

Vec3 side_normal(std::span<const Vec3> p) {
  const Vec3 n = p.size() == 3 ? cross(p[1] - p[0], p[2] - p[0]) : cross(p[2] - p[0], p[3] - p[1]);
  const double length = norm(n);
  return length > 0 ? (1 / length) * n : Vec3{};
}

std::vector<Opposite> opposite_points(const Mesh& mesh, const SideSet& surface, std::span<const Vec3> coordinates,
                                      std::span<const Looker> lookers, double reach, const std::string& name) {
  const std::vector<Face> mine = owned_faces(mesh, surface, coordinates);
  std::vector<Box> boxes(mine.size());
  for (std::size_t f = 0; f < mine.size(); ++f)
    for (const Vec3& corner : mine[f].span()) boxes[f].add(corner);
  std::vector<Vec3> places;
  places.reserve(lookers.size());
  for (const Looker& looker : lookers) places.push_back(looker.place);
  const DistributedSearch search(mesh.comm, boxes, places, reach, name);

  std::vector<Face> leaving;
  for (const LocalIndex b : search.box_of_send()) leaving.push_back(mine[static_cast<std::size_t>(b)]);
  std::vector<Face> faces(static_cast<std::size_t>(search.boxes().received()));
  search.boxes().forward(std::span<const Face>(leaving), std::span(faces));
  std::vector<Looker> here(static_cast<std::size_t>(search.points().received()));
  search.points().forward(lookers, std::span(here));
  std::vector<Opposite> found(here.size()), result(lookers.size());
  std::vector<LocalIndex> candidates;
  for (std::size_t i = 0; i < here.size(); ++i) found[i] = opposite(here[i], search.tree(), faces, candidates);
  search.points().reverse(std::span<const Opposite>(found), std::span(result));
  return result;
}

}  // namespace tenon::thermal

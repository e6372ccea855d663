// SPDX-License-Identifier: BSD-3-Clause
// Finds the face that each tied node belongs to.
#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "components/mechanics/load.hpp"
#include "components/mechanics/surface_load.hpp"
#include "components/mechanics/ties.hpp"
#include "framework/mesh/shape_functions.hpp"
#include "framework/search/distributed_search.hpp"

namespace tenon {

namespace {

/// A face as it travels.
struct Face {
  GlobalId element;
  int side, corners;
  std::array<GlobalId, max_side_nodes> id;
  std::array<Vec3, max_side_nodes> place;
};

ElementKind kind_of(const Face& face) {
  return face.corners == 4 ? ElementKind::quad4 : ElementKind::tri3;
}

Box box_of(const Face& face) {
  Box box;
  for (std::size_t a = 0; a < static_cast<std::size_t>(face.corners); ++a) box.add(face.place[a]);
  return box;
}

std::vector<Face> owned_faces(const Mesh& mesh, const TiedSet& set) {
  std::vector<Face> faces;
  for (const LoadedSide& side : faces_of_sets(mesh, set.side_sets, set.label)) {
    const ElementBlock& block = mesh.blocks[static_cast<std::size_t>(side.block)];
    const auto e = static_cast<std::size_t>(side.element);
    if (block.owners[e] != mesh.comm.rank()) continue;
    Face face{block.ids[e], side.side, side.nodes, {}, {}};
    for (std::size_t a = 0; a < static_cast<std::size_t>(side.nodes); ++a) {
      face.id[a] = mesh.node_ids[static_cast<std::size_t>(side.node[a])];
      face.place[a] = mesh.coordinates[static_cast<std::size_t>(side.node[a])];
    }
    faces.push_back(face);
  }
  return faces;
}

/// The nearest face within reach; of several at one distance that of the smallest element, and of that the first side.
Ties::Record nearest_face(const DistributedSearch& search, const std::vector<Face>& faces, const Vec3& point,
                          GlobalId node, double tolerance) {
  const Face* best = nullptr;
  NearestPoint at{{}, std::numeric_limits<double>::infinity()};
  search.tree().nearest(point, tolerance, [&](LocalIndex index) {
    const Face& face = faces[static_cast<std::size_t>(index)];
    const auto corners = static_cast<std::size_t>(face.corners);
    if (std::ranges::count(std::span(face.id).first(corners), node) > 0) return std::numeric_limits<double>::infinity();
    const NearestPoint found = nearest_point(kind_of(face), std::span(face.place).first(corners), point);
    const bool before = best && std::tuple(face.element, face.side) < std::tuple(best->element, best->side);
    const bool better = found.distance < at.distance || (found.distance == at.distance && before);
    if (found.distance <= tolerance && better) at = found, best = &face;
    return found.distance;
  });
  Ties::Record record;
  if (!best) return record;
  record = {node, best->corners, best->id, {}};
  shape_values(kind_of(*best), at.xi, std::span(record.weight).first(static_cast<std::size_t>(best->corners)));
  return record;
}

}  // namespace

std::vector<Ties::Record> Ties::find(const Mesh& mesh, const TiedSet& set) const {
  const std::vector<Face> faces = owned_faces(mesh, set);
  std::vector<Box> boxes;
  double size = 0;
  for (const Face& face : faces) {
    boxes.push_back(box_of(face));
    size = std::max(size, boxes.back().diagonal());
  }
  const double tolerance = set.tolerance.value_or(0.05 * mesh.comm.max(size));
  std::vector<GlobalId> ids;
  std::vector<Vec3> points;
  for (const LocalIndex n : nodes_of_sets(mesh, set.node_sets, set.label)) {
    if (!mesh.owns_node(n)) continue;
    ids.push_back(mesh.node_ids[static_cast<std::size_t>(n)]);
    points.push_back(mesh.coordinates[static_cast<std::size_t>(n)]);
  }
  const DistributedSearch search(mesh.comm, boxes, points, tolerance, "tied nodes: search");
  std::vector<Face> sent, arrived(static_cast<std::size_t>(search.boxes().received()));
  for (const LocalIndex box : search.box_of_send()) sent.push_back(faces[static_cast<std::size_t>(box)]);
  search.boxes().forward<Face>(sent, arrived);
  std::vector<GlobalId> nodes(static_cast<std::size_t>(search.points().received()));
  search.points().forward<GlobalId>(ids, nodes);
  std::vector<Record> found(nodes.size()), result(ids.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    found[i] = nearest_face(search, arrived, search.arrived_points()[i], nodes[i], tolerance);
  search.points().reverse<Record>(found, result);
  std::optional<Error> error;
  for (std::size_t i = 0; i < result.size() && !error; ++i)
    if (result[i].node < 0)
      error = Error(ExitCode::usage,
                    fmt::format("{}: the node at ({:.6g}, {:.6g}, {:.6g}) has no face within {:.3g} m; give a larger "
                                "tolerance, or take it out of the set",
                                set.label, points[i][0], points[i][1], points[i][2], tolerance));
  mesh.comm.throw_if_any(error);
  return result;
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Which elements of a mesh can contain points, and the refusal of those that are turned inside out.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "framework/mesh/shape_functions.hpp"
#include "transfer/locate.hpp"

namespace tenon::transfer {

namespace {

enum class Shape { sound, flat, inverted };

/// Neighbours of each corner of a hex8, such that the three edges to them form a right-handed system.
constexpr int hex_neighbours[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                      {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};

double edge_volume(const Corners& x, std::size_t corner, const int (&to)[3]) {
  const Vec3 a = x[static_cast<std::size_t>(to[0])] - x[corner], b = x[static_cast<std::size_t>(to[1])] - x[corner];
  return dot(cross(a, b), x[static_cast<std::size_t>(to[2])] - x[corner]);
}

/// True only if the Jacobian is positive at all corners: enough for nearly all elements of a sound mesh.
bool plainly_sound(ElementKind kind, const Corners& x, double smallest) {
  if (kind == ElementKind::tet4) return edge_volume(x, 0, {1, 2, 3}) > smallest;
  if (kind != ElementKind::hex8) return false;
  for (std::size_t c = 0; c < 8; ++c)
    if (!(edge_volume(x, c, hex_neighbours[c]) > smallest)) return false;
  return true;
}

/// An element that has volume is sound even if a corner is folded or edges have collapsed: points are found in it. One
/// without volume is flat if its Jacobian vanishes everywhere, else turned inside out.
Shape shape_of(const ElementPacket& element) {
  const double smallest = 1e-14 * element.size * element.size * element.size;
  if (plainly_sound(element.kind, element.corners, smallest)) return Shape::sound;
  const double volume = element_measure(element.kind, element.corner_span());
  if (volume > smallest) return Shape::sound;
  double greatest = std::abs(volume);
  for (const QuadraturePoint& q : quadrature(element.kind))
    greatest = std::max(greatest, std::abs(jacobian_determinant(element.kind, element.corner_span(), q.xi)));
  return greatest <= smallest ? Shape::flat : Shape::inverted;
}

ElementPacket packet_of(const ElementBlock& block, LocalIndex e, LocalIndex item, std::span<const Vec3> coordinates,
                        int rank) {
  ElementPacket packet;
  packet.corners = corners_of(block, e, coordinates);
  packet.id = block.ids[static_cast<std::size_t>(e)];
  packet.item = item;
  packet.owner = rank;
  packet.kind = block.kind;
  return packet;
}

Error inverted_error(const Mesh& mesh, const ElementBlock& block, LocalIndex e, const ElementPacket& packet,
                     const std::string& transfer) {
  const Vec3 at = centre_of(packet.kind, packet.corners);
  return Error(
      ExitCode::geometry,
      fmt::format("transfer '{}': element {} of block '{}' of {} at ({:.6g}, {:.6g}, {:.6g}) is inverted (volume "
                  "{:.3g} m^3), so points cannot be found in it; repair the mesh, or limit its deformation",
                  transfer, block.labels[static_cast<std::size_t>(e)], block.name, mesh.source, at[0], at[1], at[2],
                  element_measure(packet.kind, packet.corner_span())));
}

void refuse_surfaces(const Mesh& mesh, const std::string& transfer) {
  // Blocks are the same on every rank, so all of them throw.
  for (const ElementBlock& block : mesh.blocks)
    if (topology(block.kind).dimension != 3)
      throw Error(
          ExitCode::usage,
          fmt::format("transfer '{}': block '{}' of {} consists of {} elements; only solids (hex8, tet4, wedge6, "
                      "pyramid5) can be transferred from or to",
                      transfer, block.name, mesh.source, topology(block.kind).name));
}

}  // namespace

Containers containers_of(const Mesh& mesh, std::span<const Vec3> coordinates, double tolerance,
                         const std::string& transfer) {
  refuse_surfaces(mesh, transfer);
  Containers containers;
  std::optional<Error> error;
  std::int64_t flat = 0;
  ExactSum sizes;
  containers.elements.reserve(static_cast<std::size_t>(mesh.elements()));
  containers.boxes.reserve(static_cast<std::size_t>(mesh.elements()));
  for_each_element(mesh, [&](LocalIndex item, const ElementBlock& block, LocalIndex e) {
    if (block.owners[static_cast<std::size_t>(e)] != mesh.comm.rank()) return;
    ElementPacket packet = packet_of(block, e, item, coordinates, mesh.comm.rank());
    Box box;
    double farthest = 0;
    for (const Vec3& corner : packet.corner_span()) {
      box.add(corner);
      for (const double c : corner) farthest = std::max(farthest, std::abs(c));
    }
    packet.size = box.diagonal();
    const Shape shape = shape_of(packet);
    if (shape == Shape::inverted && !error) error = inverted_error(mesh, block, e, packet, transfer);
    if (shape == Shape::flat) ++flat;
    if (shape != Shape::sound) return;
    sizes.add(packet.size);
    // Large enough for points within the tolerance, and for the round-off of coordinates far from the origin.
    box.inflate((4 * tolerance + 1e-12) * packet.size + 1e-14 * farthest);
    containers.elements.push_back(packet);
    containers.boxes.push_back(box);
  });
  mesh.comm.throw_if_any(error);
  containers.skipped = mesh.comm.sum(flat);
  const std::int64_t count = mesh.comm.sum(static_cast<std::int64_t>(containers.elements.size()));
  const double total = mesh.comm.sum(sizes);
  containers.mean_size = count > 0 ? total / static_cast<double>(count) : 0.0;
  return containers;
}

}  // namespace tenon::transfer

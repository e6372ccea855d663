// SPDX-License-Identifier: BSD-3-Clause
// Refuses a mesh that no component can work with, and says where it is wrong.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "framework/base/error.hpp"
#include "framework/mesh/facets.hpp"
#include "framework/mesh/mesh_data.hpp"
#include "framework/mesh/shape_functions.hpp"

namespace tenon {

namespace {

/// Collects what is wrong: the first few in words, all in number.
struct Offenders {
  static constexpr int listed = 5;
  std::int64_t count = 0;
  std::string list;
  /// `describe()` is called only for those that are listed.
  template <typename Describe>
  void add(const Describe& describe) {
    if (count++ < listed) list += fmt::format("\n  {}", describe());
  }
  void throw_if_any(ExitCode code, const MeshData& mesh, const std::string& what, const std::string& advice) const {
    if (count == 0) return;
    const std::string more = count > listed ? fmt::format("\n  and {} more", count - listed) : "";
    throw Error(code, fmt::format("{}: {} {}:{}{}\n{}", mesh.source, count, what, list, more, advice));
  }
};

/// Corner, and the three (solid) or two (surface) neighbours along edges that make a positive frame there. For a
/// pyramid, whose determinant is that of its base corners all the way up, these suffice.
using Frame = std::array<std::int8_t, 4>;

std::span<const Frame> frames(ElementKind kind) {
  static constexpr std::array<Frame, 8> hex{
      {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7}, {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}}};
  static constexpr std::array<Frame, 1> tet{{{0, 1, 2, 3}}};
  static constexpr std::array<Frame, 6> wedge{
      {{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5}, {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}}};
  static constexpr std::array<Frame, 4> pyramid{{{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}};
  static constexpr std::array<Frame, 4> quad{{{0, 1, 3, -1}, {1, 2, 0, -1}, {2, 3, 1, -1}, {3, 0, 2, -1}}};
  static constexpr std::array<Frame, 1> tri{{{0, 1, 2, -1}}};
  switch (kind) {
    case ElementKind::hex8:
    case ElementKind::hex20:
      return hex;
    case ElementKind::tet4:
    case ElementKind::tet10:
      return tet;
    case ElementKind::wedge6:
      return wedge;
    case ElementKind::pyramid5:
      return pyramid;
    case ElementKind::quad4:
      return quad;
    case ElementKind::particle:
      return {};
    case ElementKind::tri3:
      break;
  }
  return tri;
}

/// Least of det(dx/dxi) of an element of second order at its nodes and at the points where it is integrated, m^3.
double least_of_curved(ElementKind kind, const GlobalId* nodes, const std::vector<Vec3>& coordinates) {
  std::array<Vec3, max_element_nodes> x;
  const auto count = static_cast<std::size_t>(topology(kind).nodes);
  for (std::size_t a = 0; a < count; ++a) x[a] = coordinates[static_cast<std::size_t>(nodes[a])];
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const Vec3& xi) {
    const double here = jacobian_determinant(kind, std::span(x).first(count), xi);
    if (!(here >= least)) least = here;
  };
  for (const Vec3& xi : local_nodes(kind)) look(xi);
  for (const QuadraturePoint& q : quadrature(kind)) look(q.xi);
  return least;
}

/// Least of det(dx/dxi) at the corners, up to a positive factor, m^3; for surfaces the least area of a corner, m^2.
double least_corner(ElementKind kind, const GlobalId* nodes, const std::vector<Vec3>& coordinates) {
  if (!middle_nodes(kind).empty()) return least_of_curved(kind, nodes, coordinates);
  const auto x = [&](std::int8_t n) -> const Vec3& { return coordinates[static_cast<std::size_t>(nodes[n])]; };
  double least = std::numeric_limits<double>::infinity();
  for (const Frame& f : frames(kind)) {
    const Vec3 normal = cross(x(f[1]) - x(f[0]), x(f[2]) - x(f[0]));
    const double here = f[3] < 0 ? norm(normal) : dot(normal, x(f[3]) - x(f[0]));
    if (!(here >= least)) least = here;  // also catches NaN from overflow
  }
  return least;
}

/// Calls `work(block, label, nodes)` for every element.
template <typename Work>
void each_element(const MeshData& mesh, const Work& work) {
  for (const BlockData& block : mesh.blocks) {
    const auto nodes = static_cast<std::size_t>(topology(block.kind).nodes);
    for (std::size_t e = 0; e < block.size(); ++e)
      work(block, block.labels[e], std::span(&block.connectivity[e * nodes], nodes));
  }
}

std::string place(const BlockData& block, std::int64_t label) {
  return fmt::format("{} element {} of block \"{}\"", topology(block.kind).name, label, block.name);
}

void check_sizes(const MeshData& mesh) {
  if (mesh.node_labels.size() != mesh.coordinates.size())
    throw Error(ExitCode::file, fmt::format("{}: {} nodes but {} node labels", mesh.source, mesh.coordinates.size(),
                                            mesh.node_labels.size()));
  for (const BlockData& b : mesh.blocks)
    if (b.connectivity.size() != b.size() * static_cast<std::size_t>(topology(b.kind).nodes))
      throw Error(ExitCode::file,
                  fmt::format("{}: block \"{}\" has {} elements of {} nodes but {} entries of connectivity",
                              mesh.source, b.name, b.size(), topology(b.kind).nodes, b.connectivity.size()));
}

void check_coordinates(const MeshData& mesh) {
  Offenders bad;
  for (std::size_t n = 0; n < mesh.coordinates.size(); ++n) {
    const Vec3& x = mesh.coordinates[n];
    if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2]))
      bad.add([&] { return fmt::format("node {} at ({}, {}, {})", mesh.node_labels[n], x[0], x[1], x[2]); });
  }
  bad.throw_if_any(ExitCode::file, mesh, "nodes have coordinates that are not finite numbers",
                   "Write the mesh again from the program that made it.");
}

void check_connectivity(const MeshData& mesh) {
  const auto count = static_cast<GlobalId>(mesh.coordinates.size());
  Offenders outside, repeated;
  each_element(mesh, [&](const BlockData& block, std::int64_t label, std::span<const GlobalId> nodes) {
    std::array<GlobalId, max_element_nodes> copy{};
    std::copy(nodes.begin(), nodes.end(), copy.begin());
    const std::span<GlobalId> sorted = std::span(copy).first(nodes.size());
    sort_few(sorted);
    if (sorted.front() < 0 || sorted.back() >= count)
      outside.add([&] {
        return fmt::format("{} refers to node number {}", place(block, label),
                           (sorted.front() < 0 ? sorted.front() : sorted.back()) + 1);
      });
    else if (const auto twin = std::adjacent_find(sorted.begin(), sorted.end()); twin != sorted.end())
      repeated.add([&] {
        return fmt::format("{} has node {} twice", place(block, label),
                           mesh.node_labels[static_cast<std::size_t>(*twin)]);
      });
  });
  outside.throw_if_any(ExitCode::file, mesh, fmt::format("elements refer to nodes outside 1 to {}", count),
                       "The file is damaged, or its node and element parts do not belong together.");
  repeated.throw_if_any(ExitCode::file, mesh, "elements have a node twice",
                        "Write collapsed elements as the kind they are (tet4, pyramid5, wedge6, tri3).");
}

void check_jacobians(const MeshData& mesh) {
  Offenders bad;
  each_element(mesh, [&](const BlockData& block, std::int64_t label, std::span<const GlobalId> nodes) {
    const double least = least_corner(block.kind, nodes.data(), mesh.coordinates);
    if (least > 0) return;
    bad.add([&] {
      Vec3 centre{};
      for (const GlobalId n : nodes)
        centre = centre + 1.0 / static_cast<double>(nodes.size()) * mesh.coordinates[static_cast<std::size_t>(n)];
      return fmt::format("{} at ({:.6g}, {:.6g}, {:.6g}) m: {} {:.3g}", place(block, label), centre[0], centre[1],
                         centre[2], topology(block.kind).dimension == 3 ? "Jacobian determinant" : "area", least);
    });
  });
  bad.throw_if_any(ExitCode::geometry, mesh, "elements are inverted or degenerate",
                   "The Jacobian determinant must be positive at every node: check the order of the nodes, and improve "
                   "the mesh there.");
}

void check_sets(const MeshData& mesh) {
  const auto nodes = static_cast<GlobalId>(mesh.coordinates.size());
  const std::vector<GlobalId> first = first_elements(mesh);
  const auto sides_of = [&](GlobalId element) {
    if (element < 0 || element >= first.back()) return 0;
    const auto after = std::upper_bound(first.begin(), first.end(), element);
    return topology(mesh.blocks[static_cast<std::size_t>(after - first.begin()) - 1].kind).sides;
  };
  for (const NodeSetData& s : mesh.node_sets)
    for (const GlobalId n : s.nodes)
      if (n < 0 || n >= nodes)
        throw Error(ExitCode::file, fmt::format("{}: node set \"{}\" refers to node number {} of {}", mesh.source,
                                                s.name, n + 1, nodes));
  for (const SideSetData& s : mesh.side_sets)
    for (const SideData& side : s.sides)
      if (side.side < 0 || side.side >= sides_of(side.element))
        throw Error(ExitCode::file, fmt::format("{}: side set \"{}\" refers to side {} of element number {} of {}",
                                                mesh.source, s.name, side.side + 1, side.element + 1, first.back()));
}

}  // namespace

void check(const MeshData& mesh) {
  check_sizes(mesh);
  check_coordinates(mesh);
  check_connectivity(mesh);
  check_sets(mesh);
  check_jacobians(mesh);
}

}  // namespace tenon

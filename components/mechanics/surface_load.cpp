// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/surface_load.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <tuple>

#include "framework/mesh/shape_functions.hpp"

namespace tenon {

namespace {

FaceRule make_rule(ElementKind kind) {
  FaceRule rule{};
  for (const QuadraturePoint& point : quadrature(kind)) {
    const auto q = static_cast<std::size_t>(rule.points++);
    const auto n = static_cast<std::size_t>(topology(kind).nodes);
    rule.weight[q] = point.weight;
    shape_values(kind, point.xi, std::span(rule.value[q]).first(n));
    shape_gradients(kind, point.xi, std::span(rule.gradient[q]).first(n));
  }
  return rule;
}

double area_of(const std::vector<LoadedSide>& sides, const Mesh& mesh) {
  ExactSum area;
  for (const LoadedSide& side : sides) {
    const ElementBlock& block = mesh.blocks[static_cast<std::size_t>(side.block)];
    if (block.owners[static_cast<std::size_t>(side.element)] != mesh.comm.rank()) continue;
    for_quadrature(side, mesh.coordinates, [&](const auto&, const Vec3&, const Vec3& a) { area.add(norm(a)); });
  }
  return mesh.comm.sum(area);
}

}  // namespace

const FaceRule& face_rule(int nodes) {
  static const FaceRule quad = make_rule(ElementKind::quad4), triangle = make_rule(ElementKind::tri3);
  return nodes == 4 ? quad : triangle;
}

std::vector<LoadedSide> faces_of_sets(const Mesh& mesh, const std::vector<std::string>& sets,
                                      const std::string& label) {
  std::vector<Side> all;
  for (const std::string& name : sets) {
    const SideSet* set = mesh.find_side_set(name);
    if (!set) throw Error(ExitCode::usage, fmt::format("{}: the mesh has no side set '{}'", label, name));
    all.insert(all.end(), set->sides.begin(), set->sides.end());
  }
  const auto key = [](const Side& s) { return std::tuple(s.block, s.element, s.side); };
  std::ranges::sort(all, {}, key);
  all.erase(std::unique(all.begin(), all.end(), [&](const Side& a, const Side& b) { return key(a) == key(b); }),
            all.end());
  std::vector<LoadedSide> faces;
  std::optional<Error> error;
  for (const Side& s : all) {
    const ElementBlock& block = mesh.blocks[static_cast<std::size_t>(s.block)];
    const Topology& shape = topology(block.kind);
    const auto side = static_cast<std::size_t>(s.side);
    LoadedSide face{s.block, s.element, s.side, shape.side_nodes[side], {}};
    if (face.nodes < 3) {
      if (!error)
        error = Error(ExitCode::usage,
                      fmt::format("{}: side {} of element {} of block {} is an edge; a load per area needs faces "
                                  "(of shells: sides 1 and 2)",
                                  label, s.side + 1, block.labels[static_cast<std::size_t>(s.element)], block.name));
      continue;
    }
    const std::span<const LocalIndex> nodes = block.nodes(s.element);
    for (std::size_t a = 0; a < static_cast<std::size_t>(face.nodes); ++a)
      face.node[a] = nodes[static_cast<std::size_t>(shape.side[side][a])];
    faces.push_back(face);
  }
  mesh.comm.throw_if_any(error);
  if (!(area_of(faces, mesh) > 0))
    throw Error(ExitCode::usage, fmt::format("{}: the sides have no area; expected faces with a positive area", label));
  return faces;
}

SurfaceForce::SurfaceForce(const Mesh& mesh, const SurfaceLoad& load)
    : reference_(mesh.coordinates), load_(load), sides_(faces_of_sets(mesh, load.side_sets, load.label)) {}

std::vector<LocalIndex> SurfaceForce::nodes() const {
  std::vector<LocalIndex> nodes;
  for (const LoadedSide& side : sides_) nodes.insert(nodes.end(), side.node.begin(), side.node.begin() + side.nodes);
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

void SurfaceForce::add_forces(const LoadState& state, std::span<ForceRow> force) const {
  const bool dead_load = load_.kind == SurfaceLoad::Kind::reference_traction;
  const bool pressure = load_.kind == SurfaceLoad::Kind::pressure;
  const std::span<const Vec3> positions = dead_load ? reference_ : state.nodes.position();
  for (const LoadedSide& side : sides_) {
    const ElementGroups::Place place_of = state.groups.place(static_cast<std::size_t>(side.block), side.element);
    if (!place_of.group->alive(place_of.element)) continue;
    for_quadrature(side, positions, [&](const auto& shape, const Vec3& place, const Vec3& area) {
      const auto value = [&](std::size_t c) { return load_.value[c](state.time, place); };
      const Vec3 f = pressure ? -value(0) * area : norm(area) * Vec3{value(0), value(1), value(2)};
      for (std::size_t a = 0; a < static_cast<std::size_t>(side.nodes); ++a)
        for (std::size_t c = 0; c < 3; ++c) force[static_cast<std::size_t>(side.node[a])].v[c] += shape[a] * f[c];
    });
  }
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Curved surfaces of shells for the tests, and bodies of them.
#pragma once

#include <functional>

#include "mechanics_case.hpp"

namespace tenon::testing {

using Surface = std::function<Vec3(double r, double s)>;

/// nx by ny quadrilaterals over 0 <= r, s <= 1, or twice as many triangles, or (mixed) every other one cut. Node sets:
/// edges r0, r1, s0, s1, corners such as r1s0, `all` and `middle` of the edge s1.
struct ShellGrid {
  int nx = 1, ny = 1;
  enum class Cells { quads, triangles, mixed } cells = Cells::quads;
};

inline MeshData shell_grid(const ShellGrid& grid, const Surface& surface) {
  MeshData mesh;
  if (communicator().rank() != 0) return mesh;
  mesh.source = "shell grid";
  const auto node = [&](int i, int k) { return static_cast<GlobalId>(k) * (grid.nx + 1) + i; };
  std::map<std::string, std::vector<GlobalId>> sets;
  for (int k = 0; k <= grid.ny; ++k)
    for (int i = 0; i <= grid.nx; ++i) {
      const bool edges[4] = {i == 0, i == grid.nx, k == 0, k == grid.ny};
      const char* const names[4] = {"r0", "r1", "s0", "s1"};
      for (int a = 0; a < 4; ++a) {
        if (edges[a]) sets[names[a]].push_back(node(i, k));
        for (int b = 2; b < 4 && a < 2; ++b)
          if (edges[a] && edges[b]) sets[std::string(names[a]) + names[b]].push_back(node(i, k));
      }
      if (edges[3] && 2 * i == grid.nx) sets["middle"].push_back(node(i, k));
      sets["all"].push_back(node(i, k));
      mesh.coordinates.push_back(surface(double(i) / grid.nx, double(k) / grid.ny));
      mesh.node_labels.push_back(node(i, k) + 1);
    }
  BlockData quads{"quads", 1, ElementKind::quad4, {}, {}}, triangles{"triangles", 2, ElementKind::tri3, {}, {}};
  for (int k = 0; k < grid.ny; ++k)
    for (int i = 0; i < grid.nx; ++i) {
      const GlobalId n[4] = {node(i, k), node(i + 1, k), node(i + 1, k + 1), node(i, k + 1)};
      const bool cut =
          grid.cells == ShellGrid::Cells::triangles || (grid.cells == ShellGrid::Cells::mixed && (i + k) % 2 == 1);
      if (cut)
        triangles.connectivity.insert(triangles.connectivity.end(), {n[0], n[1], n[2], n[0], n[2], n[3]});
      else
        quads.connectivity.insert(quads.connectivity.end(), n, n + 4);
    }
  std::int64_t label = 0;
  for (std::size_t e = 0; e < quads.connectivity.size() / 4; ++e) quads.labels.push_back(++label);
  for (std::size_t e = 0; e < triangles.connectivity.size() / 3; ++e) triangles.labels.push_back(++label);
  // Pressure on `top` pushes against the right-hand normal.
  SideSetData top{"top", 1, {}};
  for (GlobalId e = 0; e < label; ++e) top.sides.push_back({e, 0});
  mesh.side_sets.push_back(top);
  if (quads.size() > 0) mesh.blocks.push_back(quads);
  if (triangles.size() > 0) mesh.blocks.push_back(triangles);
  for (auto& [name, nodes] : sets)
    mesh.node_sets.push_back({name, static_cast<std::int64_t>(mesh.node_sets.size()) + 1, nodes});
  return mesh;
}

inline std::unique_ptr<Mechanics> shell_body(std::shared_ptr<const Mesh> mesh, const MaterialDescription& material,
                                             const ShellSection& section, MechanicsOptions options) {
  for (const ElementBlock& block : mesh->blocks) {
    MechanicsOptions::Block b;
    b.name = block.name, b.material = material, b.shell = section;
    options.blocks.push_back(b);
  }
  return std::make_unique<Mechanics>("shell", std::move(mesh), std::move(options));
}

inline ShellSection section(double thickness, int points = 0) {
  ShellSection s;
  s.thickness = thickness, s.points = points;
  return s;
}

/// Holds translations and rotations: "x", "z ry", ...
inline PrescribedMotion hold(const std::string& set, const std::string& components) {
  PrescribedMotion m = motion(PrescribedMotion::Kind::fixed, {set});
  m.components = m.rotations = {};
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (components[i] == ' ') continue;
    const bool turn = components[i] == 'r';
    if (turn) ++i;
    (turn ? m.rotations : m.components)[static_cast<std::size_t>(components[i] - 'x')] = true;
  }
  return m;
}

inline NodalForce force_on(const std::string& set, const Vec3& force) {
  NodalForce f;
  f.node_sets = {set}, f.label = "force on " + set;
  for (std::size_t c = 0; c < 3; ++c) f.force[c] = SpaceTimeFunction::constant(force[c]);
  return f;
}

/// Relaxes to the static state; returns the number of steps.
inline std::int64_t relax(Mechanics& body, std::int64_t most = 2000000) {
  body.initialize();
  while (!body.finished() && body.relaxation()->steps() < most) body.advance(body.time_step());
  EXPECT_TRUE(body.finished()) << body.ending();
  return body.relaxation()->steps();
}

/// Displacement of the only node of a set.
inline Vec3 displacement_of(Mechanics& body, const std::string& set) {
  const LocalIndex n = body.mesh().find_node_set(set)->nodes.front();
  return body.current_coordinates()[static_cast<std::size_t>(n)] - body.mesh().coordinates[static_cast<std::size_t>(n)];
}

}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Solid ball: a rounded cube of bricks, and layers of bricks from its surface to the sphere.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "framework/mesh/generator_tools.hpp"
#include "framework/mesh/generators.hpp"

namespace tenon {

namespace {

/// Point of [-1, 1]^3 in the core: half way between the cube and the ball it maps to elliptically.
Vec3 core_point(const Vec3& s, double half_width) {
  constexpr double bulge = 0.5;
  Vec3 x;
  for (std::size_t c = 0; c < 3; ++c) {
    const double a = s[(c + 1) % 3] * s[(c + 1) % 3], b = s[(c + 2) % 3] * s[(c + 2) % 3];
    x[c] = half_width * s[c] * ((1 - bulge) + bulge * std::sqrt(1 - (a + b) / 2 + a * b / 3));
  }
  return x;
}

/// Direction of a point on the cube's surface: equal angles along the lines of each face.
Vec3 direction(const Vec3& s) {
  Vec3 v;
  for (std::size_t c = 0; c < 3; ++c)
    v[c] = std::abs(s[c]) == 1 ? s[c] : std::tan(std::numbers::pi / 4 * s[c]);  // tan(pi/4) is not exactly 1
  return (1 / norm(v)) * v;
}

/// Lattice points of the core, x fastest, at odd-even positions -n, -n + 2 ... n.
struct Core {
  int n;
  int row() const { return n + 1; }
  GlobalId node(int i, int j, int k) const { return (static_cast<GlobalId>(k) * row() + j) * row() + i; }
  bool on_surface(int i, int j, int k) const {
    const auto end = [&](int a) { return a == 0 || a == n; };
    return end(i) || end(j) || end(k);
  }
  Vec3 place(int i, int j, int k) const {
    const auto s = [&](int a) { return static_cast<double>(2 * a - n) / n; };
    return {s(i), s(j), s(k)};
  }
};

/// The cells of the core, and the quadrilaterals of its surface, positive seen from outside.
std::vector<std::array<GlobalId, 4>> fill_core(const Core& core, BlockData& block) {
  const Topology& hex = topology(ElementKind::hex8);
  std::vector<std::array<GlobalId, 4>> surface;
  for (int k = 0; k < core.n; ++k)
    for (int j = 0; j < core.n; ++j)
      for (int i = 0; i < core.n; ++i) {
        const std::array<GlobalId, 8> nodes{core.node(i, j, k),
                                            core.node(i + 1, j, k),
                                            core.node(i + 1, j + 1, k),
                                            core.node(i, j + 1, k),
                                            core.node(i, j, k + 1),
                                            core.node(i + 1, j, k + 1),
                                            core.node(i + 1, j + 1, k + 1),
                                            core.node(i, j + 1, k + 1)};
        block.connectivity.insert(block.connectivity.end(), nodes.begin(), nodes.end());
        const int last = core.n - 1;  // in the order of hex8's sides: y-, x+, y+, x-, z-, z+
        const std::array<bool, 6> free{j == 0, i == last, j == last, i == 0, k == 0, k == last};
        for (std::size_t s = 0; s < 6; ++s) {
          if (!free[s]) continue;
          std::array<GlobalId, 4> quad;
          for (std::size_t a = 0; a < 4; ++a) quad[a] = nodes[static_cast<std::size_t>(hex.side[s][a])];
          surface.push_back(quad);
        }
      }
  return surface;
}

}  // namespace

MeshData generate(const SphereShape& shape) {
  require_positive("sphere", "radius", shape.radius);
  require_count("sphere", "core", shape.core, 1);
  require_count("sphere", "shell", shape.shell, 1);
  const Core core{shape.core};
  const double half_width = shape.radius * std::clamp(core.n / (core.n + 2.0 * shape.shell), 0.25, 0.5);

  MeshData mesh;
  mesh.source = "generated sphere";
  std::vector<Vec3> inner, outer;  // ends of the lines from core to sphere
  std::vector<GlobalId> position;  // of a core node among those lines
  for (int k = 0; k <= core.n; ++k)
    for (int j = 0; j <= core.n; ++j)
      for (int i = 0; i <= core.n; ++i) {
        mesh.coordinates.push_back(core_point(core.place(i, j, k), half_width));
        position.push_back(static_cast<GlobalId>(inner.size()));
        if (!core.on_surface(i, j, k)) continue;
        inner.push_back(mesh.coordinates.back());
        outer.push_back(shape.radius * direction(core.place(i, j, k)));
      }
  const auto core_nodes = static_cast<GlobalId>(mesh.coordinates.size()), lines = static_cast<GlobalId>(inner.size());
  for (int layer = 1; layer <= shape.shell; ++layer) {
    const double t = static_cast<double>(layer) / shape.shell;
    for (std::size_t m = 0; m < inner.size(); ++m)
      mesh.coordinates.push_back(layer == shape.shell ? outer[m] : inner[m] + t * (outer[m] - inner[m]));
  }

  BlockData block{"sphere", 1, ElementKind::hex8, {}, {}};
  const std::vector<std::array<GlobalId, 4>> surface = fill_core(core, block);
  const auto node = [&](GlobalId core_node, int layer) {
    return layer == 0 ? core_node : core_nodes + (layer - 1) * lines + position[static_cast<std::size_t>(core_node)];
  };
  for (const std::array<GlobalId, 4>& quad : surface)
    for (int layer = 0; layer < shape.shell; ++layer)
      for (const int level : {layer, layer + 1})
        for (const GlobalId n : quad) block.connectivity.push_back(node(n, level));
  mesh.blocks.push_back(std::move(block));
  number_from_one(mesh);

  std::vector<char> marked(mesh.coordinates.size(), 0);
  std::fill(marked.end() - static_cast<std::ptrdiff_t>(lines), marked.end(), 1);
  add_face_sets(mesh, skin(mesh), "outer", marked);
  return finish(std::move(mesh), shape.tetrahedra);
}

}  // namespace tenon

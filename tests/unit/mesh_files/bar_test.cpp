// SPDX-License-Identifier: BSD-3-Clause
// The two meshes of the main job: the same bar, the same names, sound elements.
#include <algorithm>
#include <numbers>

#include "framework/mesh/shape_functions.hpp"
#include "tests/unit/mesh_files/sample_files.hpp"

namespace tenon::testing {
namespace {

constexpr double radius = 0.0032, length = 0.0324;  // m

MeshData bar(const std::string& name) {
  return read_mesh(std::string(TENON_SOURCE_DIR) + "/apps/scenes/hot-taylor-bar/" + name);
}

double volume(const MeshData& mesh) {
  double sum = 0;
  for (const BlockData& block : mesh.blocks) {
    const auto nodes = static_cast<std::size_t>(topology(block.kind).nodes);
    std::vector<Vec3> corners(nodes);
    for (std::size_t e = 0; e < block.size(); ++e) {
      for (std::size_t n = 0; n < nodes; ++n)
        corners[n] = mesh.coordinates[static_cast<std::size_t>(block.connectivity[e * nodes + n])];
      sum += element_measure(block.kind, corners);
    }
  }
  return sum;
}

/// Least of the determinants of the unit vectors along the edges at the corners of all hex8: 1 for a cube.
double least_scaled_jacobian(const MeshData& mesh) {
  constexpr int corner[8][4] = {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7},
                                {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}};
  double least = 1;
  const BlockData& block = mesh.blocks.at(0);
  for (std::size_t e = 0; e < block.size(); ++e)
    for (const auto& c : corner) {
      const auto at = [&](int n) {
        return mesh.coordinates[static_cast<std::size_t>(block.connectivity[8 * e + static_cast<std::size_t>(n)])];
      };
      const Vec3 a = at(c[1]) - at(c[0]), b = at(c[2]) - at(c[0]), d = at(c[3]) - at(c[0]);
      least = std::min(least, dot(cross(a, b), d) / (norm(a) * norm(b) * norm(d)));
    }
  return least;
}

void expect_bar(const MeshData& mesh, double volume_tolerance) {
  EXPECT_NO_THROW(check(mesh));
  EXPECT_TRUE(mesh.warnings.empty());
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].name, "bar");
  ASSERT_EQ(mesh.node_sets.size(), 3u);
  ASSERT_EQ(mesh.side_sets.size(), 3u);
  const char* names[] = {"foot", "top", "side"};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(mesh.node_sets[i].name, names[i]);
    EXPECT_EQ(mesh.side_sets[i].name, names[i]);
  }
  for (const GlobalId n : mesh.node_sets[0].nodes) EXPECT_EQ(mesh.coordinates[static_cast<std::size_t>(n)][2], 0);
  for (const GlobalId n : mesh.node_sets[1].nodes)
    EXPECT_NEAR(mesh.coordinates[static_cast<std::size_t>(n)][2], length, 1e-15);
  for (const GlobalId n : mesh.node_sets[2].nodes) {
    const Vec3& x = mesh.coordinates[static_cast<std::size_t>(n)];
    EXPECT_NEAR(std::hypot(x[0], x[1]), radius, 1e-9);
  }
  // The sides together are the skin.
  std::vector<SideData> sides;
  for (const SideSetData& set : mesh.side_sets) sides.insert(sides.end(), set.sides.begin(), set.sides.end());
  std::sort(sides.begin(), sides.end());
  EXPECT_EQ(sides, skin(mesh));
  // A polygon within the circle.
  const double exact = std::numbers::pi * radius * radius * length;
  EXPECT_LT(volume(mesh), exact);
  EXPECT_NEAR(volume(mesh) / exact, 1, volume_tolerance);
}

TEST(Bar, HexahedraAreSound) {
  const MeshData mesh = bar("bar_hex.exo");
  expect_bar(mesh, 0.012);
  EXPECT_EQ(mesh.elements(), 5400u);
  EXPECT_GT(least_scaled_jacobian(mesh), 0.85);
}

TEST(Bar, TetrahedraAreSound) {
  const MeshData mesh = bar("bar_tet.msh");
  expect_bar(mesh, 0.003);
  EXPECT_EQ(mesh.blocks[0].kind, ElementKind::tet4);
  EXPECT_GT(mesh.elements(), 40'000u);
}

}  // namespace
}  // namespace tenon::testing

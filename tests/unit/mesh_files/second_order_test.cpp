// SPDX-License-Identifier: BSD-3-Clause
// hex20 and tet10 in the file formats, each of which has its own order of middle nodes.
#include <vtk_exodusII.h>

#include "framework/mesh/shape_functions.hpp"
#include "tests/unit/mesh_files/sample_files.hpp"

namespace tenon::testing {
namespace {

class SecondOrderFiles : public FolderTest {};

/// Whether every node of the element stands where the reference element, scaled and moved, has it.
void expect_reference(const MeshData& mesh, const BlockData& block, double scale, const Vec3& origin) {
  const std::span<const Vec3> local = local_nodes(block.kind);
  ASSERT_EQ(block.connectivity.size(), local.size());
  for (std::size_t a = 0; a < local.size(); ++a)
    EXPECT_EQ(mesh.coordinates[static_cast<std::size_t>(block.connectivity[a])], origin + scale * local[a])
        << topology(block.kind).name << " node " << a;
}

TEST_F(SecondOrderFiles, ExodusHasItsOwnOrderOfUprightEdges) {
  // Coordinates in the order of the manual's figure of HEX20: corners, below, upright, above.
  const double x[] = {-1, 1, 1, -1, -1, 1, 1, -1, 0, 1, 0, -1, -1, 1, 1, -1, 0, 1, 0, -1};
  const double y[] = {-1, -1, 1, 1, -1, -1, 1, 1, -1, 0, 1, 0, -1, -1, 1, 1, -1, 0, 1, 0};
  const double z[] = {-1, -1, -1, -1, 1, 1, 1, 1, -1, -1, -1, -1, 0, 0, 0, 0, 1, 1, 1, 1};
  int computer = sizeof(double), stored = sizeof(double), connectivity[20];
  for (int i = 0; i < 20; ++i) connectivity[i] = i + 1;
  const std::string file = path("hex20.g");
  const int id = ex_create(file.c_str(), EX_CLOBBER, &computer, &stored);
  ASSERT_GE(id, 0);
  EXPECT_GE(ex_put_init(id, "hex20", 3, 20, 1, 1, 0, 1), 0);
  EXPECT_GE(ex_put_coord(id, x, y, z), 0);
  EXPECT_GE(ex_put_block(id, EX_ELEM_BLOCK, 1, "HEX", 1, 20, 0, 0, 0), 0);
  EXPECT_GE(ex_put_conn(id, EX_ELEM_BLOCK, 1, connectivity, nullptr, nullptr), 0);
  const int element = 1, side = 6;
  EXPECT_GE(ex_put_set_param(id, EX_SIDE_SET, 3, 1, 0), 0);
  EXPECT_GE(ex_put_set(id, EX_SIDE_SET, 3, &element, &side), 0);
  EXPECT_GE(ex_close(id), 0);

  MeshData mesh = read_exodus(file);
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].kind, ElementKind::hex20);
  expect_reference(mesh, mesh.blocks[0], 1, {0, 0, 0});
  EXPECT_NO_THROW(check(mesh));
  // The nodes of a side are its corners and its middle nodes: of the top, all at z = 1.
  add_derived_sets(mesh);
  ASSERT_EQ(mesh.node_sets.size(), 2u);
  ASSERT_EQ(mesh.node_sets[0].nodes.size(), 8u);
  for (const GlobalId n : mesh.node_sets[0].nodes) EXPECT_EQ(mesh.coordinates[static_cast<std::size_t>(n)][2], 1);
  EXPECT_EQ(mesh.node_sets[1].nodes.size(), 20u);  // the skin

  write_exodus(mesh, path("again.exo"));
  expect_same(mesh, read_exodus(path("again.exo")));
  // Another program finds the manual's order in what was written.
  int computer_again = sizeof(double), stored_again = 0, nodes[20];
  float version = 0;
  const int again = ex_open(path("again.exo").c_str(), EX_READ, &computer_again, &stored_again, &version);
  ASSERT_GE(again, 0);
  EXPECT_GE(ex_get_conn(again, EX_ELEM_BLOCK, 1, nodes, nullptr, nullptr), 0);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(nodes[i], i + 1);
  char type[MAX_STR_LENGTH + 1];
  EXPECT_GE(ex_get_block(again, EX_ELEM_BLOCK, 1, type, nullptr, nullptr, nullptr, nullptr, nullptr), 0);
  EXPECT_STREQ(type, "HEX20");
  EXPECT_GE(ex_close(again), 0);
}

/// Nodes of one element in Gmsh's order, with its surface group.
std::string gmsh_file(const std::vector<Vec3>& nodes, int type, const std::string& boundary) {
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 5 \"top\"\n3 6 \"body\"\n"
      "$EndPhysicalNames\n$Nodes\n" +
      std::to_string(nodes.size()) + "\n";
  for (std::size_t n = 0; n < nodes.size(); ++n)
    text += std::to_string(n + 1) + " " + std::to_string(nodes[n][0]) + " " + std::to_string(nodes[n][1]) + " " +
            std::to_string(nodes[n][2]) + "\n";
  text += "$EndNodes\n$Elements\n2\n" + boundary + "\n2 " + std::to_string(type) + " 2 6 1";
  for (std::size_t n = 0; n < nodes.size(); ++n) text += " " + std::to_string(n + 1);
  return text + "\n$EndElements\n";
}

TEST_F(SecondOrderFiles, GmshHexahedron20) {
  // Corners, then edges (0,1) (0,3) (0,4) (1,2) (1,5) (2,3) (2,6) (3,7) (4,5) (4,7) (5,6) (6,7).
  const std::vector<Vec3> nodes{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2},
                                {0, 2, 2}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 1, 0}, {2, 0, 1}, {1, 2, 0},
                                {2, 2, 1}, {0, 2, 1}, {1, 0, 2}, {0, 1, 2}, {2, 1, 2}, {1, 2, 2}};
  MeshData mesh = read_gmsh(write("hex20.msh", gmsh_file(nodes, 17, "1 16 2 5 1 5 6 7 8 17 19 20 18")));
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].kind, ElementKind::hex20);
  EXPECT_EQ(mesh.blocks[0].name, "body");
  expect_reference(mesh, mesh.blocks[0], 1, {1, 1, 1});
  EXPECT_NO_THROW(check(mesh));
  ASSERT_EQ(mesh.side_sets.size(), 1u);
  EXPECT_EQ(mesh.side_sets[0].sides, (std::vector<SideData>{{0, 5}}));
  EXPECT_EQ(mesh.node_sets.at(0).nodes, (std::vector<GlobalId>{4, 5, 6, 7, 16, 17, 18, 19}));
}

TEST_F(SecondOrderFiles, GmshTetrahedron10) {
  const std::vector<Vec3> nodes{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 0, 0},
                                {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}};
  MeshData mesh = read_gmsh(write("tet10.msh", gmsh_file(nodes, 11, "1 9 2 5 1 2 3 4 6 9 10")));
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].kind, ElementKind::tet10);
  expect_reference(mesh, mesh.blocks[0], 2, {0, 0, 0});
  ASSERT_EQ(mesh.side_sets.size(), 1u);
  EXPECT_EQ(mesh.side_sets[0].sides, (std::vector<SideData>{{0, 1}}));
  write_exodus(mesh, path("tet10.exo"));
  expect_same(mesh, read_exodus(path("tet10.exo")));
}

}  // namespace
}  // namespace tenon::testing

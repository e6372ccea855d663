// SPDX-License-Identifier: BSD-3-Clause
// Gmsh files: node sets, side sets, and groups that lie on nothing.
#include "tests/unit/mesh_files/sample_files.hpp"

namespace tenon::testing {
namespace {

constexpr const char* cube_nodes = "8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n";

class GmshSets : public FolderTest {
 protected:
  MeshData read(const std::string& nodes, const std::string& elements, const std::string& names = "") const {
    return read_gmsh(write("mesh.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names + "$Nodes\n" + nodes +
                                           "$EndNodes\n$Elements\n" + elements + "$EndElements\n"));
  }
};

TEST_F(GmshSets, FindsEverySideOfAHexahedron) {
  const MeshData mesh = read(cube_nodes,
                             "7\n1 5 2 1 1 1 2 3 4 5 6 7 8\n2 3 2 1 1 2 6 5 1\n3 3 2 2 1 3 2 6 7\n4 3 2 3 1 8 4 3 7\n"
                             "5 3 2 4 1 1 5 8 4\n6 3 2 5 1 1 2 3 4\n7 3 2 6 1 8 7 6 5\n");
  ASSERT_EQ(mesh.side_sets.size(), 6u);
  for (int s = 0; s < 6; ++s) {
    const SideSetData& set = mesh.side_sets[static_cast<std::size_t>(s)];
    EXPECT_EQ(set.name, "surface_" + std::to_string(s + 1));
    EXPECT_EQ(set.sides, (std::vector<SideData>{{0, s}}));
    EXPECT_EQ(mesh.node_sets[static_cast<std::size_t>(s)].name, "nodelist_" + std::to_string(s + 1));
    EXPECT_EQ(mesh.node_sets[static_cast<std::size_t>(s)].nodes.size(), 4u);
  }
}

TEST_F(GmshSets, AnInnerFaceBelongsToTheSolidItPointsOutOf) {
  const std::string nodes = "5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n";
  const std::string tets = "3 4 2 1 1 1 2 3 4\n4 4 2 1 1 2 3 4 5\n";
  const MeshData out = read(nodes, "3\n1 2 2 1 1 2 3 4\n" + tets);
  EXPECT_EQ(out.side_sets.at(0).sides, (std::vector<SideData>{{0, 1}}));
  const MeshData in = read(nodes, "3\n1 2 2 1 1 3 2 4\n" + tets);
  EXPECT_EQ(in.side_sets.at(0).sides, (std::vector<SideData>{{1, 3}}));
}

TEST_F(GmshSets, LinesBecomeEdgesOfASurfaceMesh) {
  const MeshData mesh =
      read("4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n", "3\n1 1 2 1 1 3 4\n2 1 2 2 1 1 4\n3 3 2 9 1 1 2 3 4\n");
  ASSERT_EQ(mesh.side_sets.size(), 2u);
  // The sides of a quadrangle are its two faces and then its edges.
  EXPECT_EQ(mesh.side_sets[0].sides, (std::vector<SideData>{{0, 4}}));
  EXPECT_EQ(mesh.side_sets[1].sides, (std::vector<SideData>{{0, 5}}));
}

TEST_F(GmshSets, LinesAndPointsOfASolidAreNodeSetsOnly) {
  const MeshData mesh = read(cube_nodes, "3\n1 5 2 1 1 1 2 3 4 5 6 7 8\n2 1 2 1 1 7 6\n3 15 2 2 1 8\n");
  EXPECT_TRUE(mesh.side_sets.empty());
  ASSERT_EQ(mesh.node_sets.size(), 2u);
  EXPECT_EQ(mesh.node_sets[0].nodes, (std::vector<GlobalId>{5, 6}));
  EXPECT_EQ(mesh.node_sets[1].nodes, std::vector<GlobalId>{7});
}

TEST_F(GmshSets, ASurfaceOnNoSolidIsAShellStructure) {
  const MeshData mesh =
      read("11\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n9 5 0 0\n10 6 0 0\n11 5 1 0\n",
           "3\n1 5 2 1 1 1 2 3 4 5 6 7 8\n2 2 2 4 1 9 10 11\n3 1 2 2 1 10 9\n",
           "$PhysicalNames\n1\n2 4 \"plate\"\n$EndPhysicalNames\n");
  ASSERT_EQ(mesh.blocks.size(), 2u);
  EXPECT_EQ(mesh.blocks[1].name, "plate");
  EXPECT_EQ(mesh.blocks[1].kind, ElementKind::tri3);
  EXPECT_EQ(mesh.coordinates.size(), 11u);
  // The line lies on an edge of the plate.
  ASSERT_EQ(mesh.side_sets.size(), 1u);
  EXPECT_EQ(mesh.side_sets[0].sides, (std::vector<SideData>{{1, 2}}));
  ASSERT_EQ(mesh.warnings.size(), 1u);
  expect_mentions(mesh.warnings[0], {"'plate'", "shells"});
}

TEST_F(GmshSets, FacesOnNoSolidAreLeftOutAndCounted) {
  const MeshData mesh = read(cube_nodes, "3\n1 5 2 1 1 1 2 3 4 5 6 7 8\n2 3 2 1 1 1 2 6 5\n3 3 2 1 1 1 2 7 8\n");
  EXPECT_EQ(mesh.side_sets.at(0).sides, (std::vector<SideData>{{0, 0}}));
  ASSERT_EQ(mesh.warnings.size(), 1u);
  expect_mentions(mesh.warnings[0], {"1 of 2", "surface_1"});
}

TEST_F(GmshSets, EqualNamesAreMadeDistinct) {
  const MeshData mesh = read(cube_nodes, "3\n1 5 2 1 1 1 2 3 4 5 6 7 8\n2 3 2 1 1 1 2 6 5\n3 1 2 2 1 1 2\n",
                             "$PhysicalNames\n2\n2 1 \"fixed\"\n1 2 \"fixed\"\n$EndPhysicalNames\n");
  ASSERT_EQ(mesh.node_sets.size(), 2u);
  EXPECT_EQ(mesh.node_sets[0].name, "fixed");
  EXPECT_EQ(mesh.node_sets[1].name, "fixed_2");
  EXPECT_EQ(mesh.warnings.size(), 1u);
}

}  // namespace
}  // namespace tenon::testing

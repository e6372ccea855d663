// SPDX-License-Identifier: BSD-3-Clause
// Gmsh files: the formats, blocks and labels.
#include "tests/unit/mesh_files/sample_files.hpp"

namespace tenon::testing {
namespace {

class Gmsh : public FolderTest {
 protected:
  MeshData read(const std::string& text) const { return read_gmsh(write("mesh.msh", text)); }
};

std::string msh22(const std::string& nodes, const std::string& elements, const std::string& names = "") {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names + "$Nodes\n" + nodes + "$EndNodes\n$Elements\n" + elements +
         "$EndElements\n";
}

class EveryGmshFormat : public Gmsh, public ::testing::WithParamInterface<GmshFormat> {};

TEST_P(EveryGmshFormat, GivesTheSameMesh) {
  const MeshData mesh = read(two_tets(GetParam()));
  ASSERT_EQ(mesh.blocks.size(), 2u);
  EXPECT_EQ(mesh.blocks[0].name, "left");
  EXPECT_EQ(mesh.blocks[1].name, "right");
  EXPECT_EQ(mesh.blocks[0].kind, ElementKind::tet4);
  EXPECT_EQ(mesh.blocks[0].labels, std::vector<std::int64_t>{6});
  EXPECT_EQ(mesh.blocks[1].labels, std::vector<std::int64_t>{17});
  // Node 90 belongs to the geometry only.
  EXPECT_EQ(mesh.node_labels, (std::vector<std::int64_t>{50, 10, 20, 30, 40}));
  EXPECT_EQ(mesh.coordinates[0], (Vec3{1, 1, 1}));
  EXPECT_EQ(mesh.blocks[0].connectivity, (std::vector<GlobalId>{1, 2, 3, 4}));
  EXPECT_EQ(mesh.blocks[1].connectivity, (std::vector<GlobalId>{2, 3, 4, 0}));
  ASSERT_EQ(mesh.side_sets.size(), 2u);
  EXPECT_EQ(mesh.side_sets[0].name, "middle");
  EXPECT_EQ(mesh.side_sets[0].sides, (std::vector<SideData>{{0, 1}}));
  EXPECT_EQ(mesh.side_sets[1].name, "outer");
  EXPECT_EQ(mesh.side_sets[1].sides, (std::vector<SideData>{{0, 3}}));
  ASSERT_EQ(mesh.node_sets.size(), 4u);
  EXPECT_EQ(mesh.node_sets[0].nodes, (std::vector<GlobalId>{2, 3, 4}));
  EXPECT_EQ(mesh.node_sets[1].nodes, (std::vector<GlobalId>{1, 2, 3}));
  EXPECT_EQ(mesh.node_sets[2].name, "edge");
  EXPECT_EQ(mesh.node_sets[2].nodes, (std::vector<GlobalId>{1, 2}));
  EXPECT_EQ(mesh.node_sets[3].name, "tip");
  EXPECT_EQ(mesh.node_sets[3].nodes, std::vector<GlobalId>{0});
  EXPECT_NO_THROW(check(mesh));
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryGmshFormat,
                         ::testing::Values(GmshFormat{2.2}, GmshFormat{4.0}, GmshFormat{4.1}, GmshFormat{2.2, true},
                                           GmshFormat{4.1, true}, GmshFormat{2.2, true, true},
                                           GmshFormat{4.1, true, true}));

TEST_F(Gmsh, IdsOfSetsDifferSoThatTheMeshCanBeWritten) {
  const MeshData mesh = read(two_tets({}));
  write_exodus(mesh, path("mesh.exo"));
  expect_same(mesh, read_exodus(path("mesh.exo")));
}

TEST_F(Gmsh, WithoutGroupsThereIsOneBlockOfVolume) {
  const MeshData mesh = read(msh22("4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n", "1\n1 4 2 0 1 1 2 3 4\n"));
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].name, "volume");
  EXPECT_TRUE(mesh.node_sets.empty() && mesh.side_sets.empty());
}

TEST_F(Gmsh, SeveralKindsInAGroupBecomeBlocksNamedAfterThem) {
  const MeshData mesh =
      read(msh22("5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 0 0\n", "2\n1 2 2 8 1 2 5 3\n2 3 2 8 1 1 2 3 4\n",
                 "$PhysicalNames\n1\n2 8 \"sheet metal\"\n$EndPhysicalNames\n"));
  ASSERT_EQ(mesh.blocks.size(), 2u);
  EXPECT_EQ(mesh.blocks[0].name, "sheet metal_quad4");
  EXPECT_EQ(mesh.blocks[1].name, "sheet metal_tri3");
  EXPECT_NE(mesh.blocks[0].label, mesh.blocks[1].label);
}

TEST_F(Gmsh, ElementsOutsideAllGroupsAreKept) {
  const MeshData mesh =
      read(msh22("5\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 2 0 0\n", "2\n1 2 2 0 1 2 5 3\n2 3 2 8 1 1 2 3 4\n"));
  ASSERT_EQ(mesh.blocks.size(), 2u);
  EXPECT_EQ(mesh.blocks[0].name, "block_8");
  EXPECT_EQ(mesh.blocks[1].name, "surface");
  ASSERT_EQ(mesh.warnings.size(), 1u);
  expect_mentions(mesh.warnings[0], {"outside all physical groups"});
}

TEST_F(Gmsh, AnElementOfSeveralGroupsIsReadOnce) {
  // Format 2 repeats the element; format 4 lists several groups of its entity.
  const MeshData repeated =
      read(msh22("4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n", "2\n1 4 2 7 1 1 2 3 4\n2 4 2 3 1 1 2 3 4\n"));
  ASSERT_EQ(repeated.blocks.size(), 1u);
  EXPECT_EQ(repeated.blocks[0].name, "block_3");
  EXPECT_EQ(repeated.blocks[0].size(), 1u);
  ASSERT_EQ(repeated.warnings.size(), 1u);
  expect_mentions(repeated.warnings[0], {"1 elements are in several"});
  const MeshData listed = read(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 2 7 3 0\n$EndEntities\n"
      "$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n$Elements\n1 1 1 1\n3 1 4 1\n1 1 2 "
      "3 4\n$EndElements\n");
  ASSERT_EQ(listed.blocks.size(), 1u);
  EXPECT_EQ(listed.blocks[0].name, "block_3");
  EXPECT_EQ(listed.warnings, repeated.warnings);
}

TEST_F(Gmsh, ANegativeGroupReversesASurface) {
  const MeshData mesh = read(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n1 0 0 0 1 1 1 1 -3 0\n$EndEntities\n"
      "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 "
      "3\n$EndElements\n");
  EXPECT_EQ(mesh.blocks.at(0).name, "block_3");
  EXPECT_EQ(mesh.blocks.at(0).connectivity, (std::vector<GlobalId>{0, 2, 1}));
}

TEST_F(Gmsh, ParametersOfNodesAndUnknownSectionsAreSkipped) {
  const MeshData mesh = read(
      "$Comments\nmade by hand\n$EndComments\n$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$NodesOnMars\n1 2 "
      "3\n$EndNodesOnMars\n"
      "$Nodes\n2 3 1 3\n1 1 1 1\n7\n0 0 0 0.5\n2 1 1 2\n8\n9\n1 0 0 0.1 0.2\n0 1 0 0.3 0.4\n$EndNodes\n"
      "$Elements\n1 1 1 1\n2 1 2 1\n1 7 8 9\n$EndElements\n$Periodic\n0\n$EndPeriodic\n");
  EXPECT_EQ(mesh.coordinates, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST_F(Gmsh, ReadsCarriageReturnsAndOddNumbers) {
  std::string text = msh22("3\n1 +0 0 -0.0\n2 1E0 .0 1e-400\n3 0 1. 0\n", "1\n1 2 2 0 1 1 2 3\n");
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, 1, '\r');
  const MeshData mesh = read(text);
  EXPECT_EQ(mesh.coordinates, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

}  // namespace
}  // namespace tenon::testing

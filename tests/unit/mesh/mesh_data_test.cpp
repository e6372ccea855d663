// SPDX-License-Identifier: BSD-3-Clause
// Check, skin, derived sets and summary of whole meshes.
#include "framework/mesh/mesh_data.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "framework/base/error.hpp"
#include "framework/mesh/generators.hpp"
#include "tests/unit/mesh/sample_elements.hpp"

namespace tenon::testing {
namespace {

MeshData one_element(ElementKind kind) {
  MeshData mesh;
  mesh.source = "sample";
  mesh.coordinates = reference_element(kind);
  BlockData block{"body", 4, kind, {}, {70}};
  for (std::size_t n = 0; n < mesh.coordinates.size(); ++n) {
    mesh.node_labels.push_back(static_cast<std::int64_t>(100 + n));
    block.connectivity.push_back(static_cast<GlobalId>(n));
  }
  mesh.blocks.push_back(block);
  return mesh;
}

/// What check() says about a mesh, and the code.
std::pair<ExitCode, std::string> verdict(const MeshData& mesh) {
  try {
    check(mesh);
  } catch (const Error& e) {
    return {e.code(), e.what()};
  }
  return {ExitCode::done, ""};
}

TEST(Check, AcceptsEveryKind) {
  for (const ElementKind kind : all_kinds) EXPECT_EQ(verdict(one_element(kind)).first, ExitCode::done);
}

TEST(Check, NamesInvertedElementsOfEveryKind) {
  for (const ElementKind kind : solid_kinds) {
    MeshData mesh = one_element(kind);
    for (Vec3& x : mesh.coordinates) x[1] = -x[1];
    const auto [code, text] = verdict(mesh);
    EXPECT_EQ(code, ExitCode::geometry);
    EXPECT_NE(text.find("element 70 of block \"body\""), std::string::npos) << text;
    EXPECT_NE(text.find("sample"), std::string::npos) << text;
  }
}

TEST(Check, FindsACornerThatIsInvertedAlone) {
  for (const ElementKind kind : solid_kinds) {
    if (kind == ElementKind::tet4) continue;  // it has one determinant
    for (std::size_t corner = 0; corner < reference_element(kind).size(); ++corner) {
      MeshData mesh = one_element(kind);
      const Vec3 centre = map_to_space(kind, mesh.coordinates, element_centre(kind));
      mesh.coordinates[corner] = mesh.coordinates[corner] + 1.9 * (centre - mesh.coordinates[corner]);
      if (kind == ElementKind::pyramid5 && corner == 4) mesh.coordinates[4] = {0, 0, -0.1};
      EXPECT_EQ(verdict(mesh).first, ExitCode::geometry) << topology(kind).name << corner;
    }
  }
}

TEST(Check, RefusesFlatAndEmptyElements) {
  for (const ElementKind kind : all_kinds) {
    MeshData mesh = one_element(kind);
    for (Vec3& x : mesh.coordinates) x[1] = 0, x[2] = topology(kind).dimension == 2 ? 0 : x[2];
    EXPECT_EQ(verdict(mesh).first, ExitCode::geometry) << topology(kind).name;
  }
}

TEST(Check, RefusesBadNumbers) {
  MeshData mesh = one_element(ElementKind::hex8);
  mesh.blocks[0].connectivity[3] = 8;
  EXPECT_EQ(verdict(mesh).first, ExitCode::file);
  mesh.blocks[0].connectivity[3] = -1;
  EXPECT_EQ(verdict(mesh).first, ExitCode::file);
  mesh.blocks[0].connectivity[3] = 2;
  EXPECT_EQ(verdict(mesh).first, ExitCode::file);
  EXPECT_NE(verdict(mesh).second.find("node 102 twice"), std::string::npos) << verdict(mesh).second;
  mesh = one_element(ElementKind::hex8);
  mesh.coordinates[5][1] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(verdict(mesh).first, ExitCode::file);
  EXPECT_NE(verdict(mesh).second.find("node 105"), std::string::npos);
  mesh.coordinates[5][1] = std::nan("");
  EXPECT_EQ(verdict(mesh).first, ExitCode::file);
  mesh = one_element(ElementKind::hex8);
  mesh.node_sets = {{"fixed", 1, {0, 8}}};
  EXPECT_EQ(verdict(mesh).first, ExitCode::file);
  mesh.node_sets.clear();
  mesh.side_sets = {{"load", 1, {{0, 6}}}};
  EXPECT_EQ(verdict(mesh).first, ExitCode::file);
  mesh.side_sets = {{"load", 1, {{1, 0}}}};
  EXPECT_EQ(verdict(mesh).first, ExitCode::file);
  mesh = one_element(ElementKind::hex8);
  mesh.blocks[0].connectivity.pop_back();
  EXPECT_EQ(verdict(mesh).first, ExitCode::file);
}

TEST(Check, ListsFiveAndCountsAll) {
  BoxShape shape;
  shape.elements = {3, 3, 1};
  MeshData mesh = generate(shape);
  for (Vec3& x : mesh.coordinates) x[0] = -x[0];
  const auto [code, text] = verdict(mesh);
  EXPECT_EQ(code, ExitCode::geometry);
  EXPECT_NE(text.find("9 elements are inverted"), std::string::npos) << text;
  EXPECT_NE(text.find("element 5 of"), std::string::npos) << text;
  EXPECT_EQ(text.find("element 6 of"), std::string::npos) << text;
  EXPECT_NE(text.find("and 4 more"), std::string::npos) << text;
}

TEST(Skin, OfABoxHasAllOutsideSides) {
  BoxShape shape;
  shape.elements = {3, 4, 5};
  EXPECT_EQ(skin(generate(shape)).size(), 2u * (3 * 4 + 4 * 5 + 5 * 3));
  shape.elements = {1, 1, 1};
  EXPECT_EQ(skin(generate(shape)).size(), 6u);
}

TEST(Skin, OfSurfaceElementsIsTheirFirstFace) {
  PlateShape shape;
  shape.elements_x = 2;
  EXPECT_EQ(skin(generate(shape)), (std::vector<SideData>{{0, 0}, {1, 0}}));
}

TEST(Skin, IgnoresASurfaceElementThatLiesOnASolid) {
  MeshData mesh = one_element(ElementKind::hex8);
  mesh.blocks.push_back({"cover", 5, ElementKind::quad4, {4, 5, 6, 7}, {71}});
  EXPECT_EQ(skin(mesh).size(), 7u);
}

TEST(DerivedSets, AddSkinAndNodesOfSides) {
  MeshData mesh = one_element(ElementKind::tet4);
  mesh.side_sets = {{"base", 7, {{0, 3}}}, {"known", 8, {{0, 0}}}};
  mesh.node_sets = {{"known", 9, {2}}};
  add_derived_sets(mesh);
  ASSERT_EQ(mesh.side_sets.size(), 3u);
  EXPECT_EQ(mesh.side_sets[2].name, "skin");
  EXPECT_EQ(mesh.side_sets[2].sides.size(), 4u);
  ASSERT_EQ(mesh.node_sets.size(), 3u);
  EXPECT_EQ(mesh.node_sets[0].nodes, (std::vector<GlobalId>{2}));  // one that the file has is kept
  EXPECT_EQ(mesh.node_sets[1].name, "base");
  EXPECT_EQ(mesh.node_sets[1].nodes, (std::vector<GlobalId>{0, 1, 2}));
  EXPECT_EQ(mesh.node_sets[2].name, "skin");
  const MeshData once = mesh;
  add_derived_sets(mesh);
  EXPECT_EQ(mesh.side_sets.size(), once.side_sets.size());
  EXPECT_EQ(mesh.node_sets.size(), once.node_sets.size());
}

TEST(Summary, CountsAndBounds) {
  CylinderShape shape;
  shape.radius = 2, shape.length = 5;
  const MeshData mesh = generate(shape);
  const MeshSummary summary = summarise(mesh);
  EXPECT_EQ(summary.nodes, static_cast<std::int64_t>(mesh.coordinates.size()));
  EXPECT_EQ(summary.elements, static_cast<std::int64_t>(mesh.elements()));
  EXPECT_EQ(summary.low, (Vec3{-2, -2, 0}));
  EXPECT_EQ(summary.high, (Vec3{2, 2, 5}));
  ASSERT_EQ(summary.blocks.size(), 1u);
  EXPECT_EQ(summary.blocks[0].name, "cylinder");
  EXPECT_EQ(summary.side_sets.size(), 3u);
  EXPECT_EQ(summarise(MeshData{}).nodes, 0);
  EXPECT_EQ(summarise(MeshData{}).low, (Vec3{0, 0, 0}));
}

}  // namespace
}  // namespace tenon::testing

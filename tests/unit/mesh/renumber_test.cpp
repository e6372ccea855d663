// SPDX-License-Identifier: BSD-3-Clause
// Renumbering: the same mesh by label, sets that follow, an order that is local, and no work where none is needed.
#include "framework/mesh/renumber.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "mesh_samples.hpp"

namespace tenon {
namespace {

using Labels = std::vector<std::int64_t>;

/// What a mesh is, whatever its order: everything by label.
struct ByLabel {
  std::map<std::int64_t, Vec3> nodes;
  std::map<std::pair<std::string, std::int64_t>, Labels> elements;  ///< nodes in their order
  std::map<std::string, std::set<std::int64_t>> node_sets;
  std::map<std::string, std::set<std::pair<std::int64_t, int>>> side_sets;
  bool operator==(const ByLabel&) const = default;
};

ByLabel by_label(const MeshData& mesh) {
  ByLabel result;
  Labels element_labels;
  for (std::size_t n = 0; n < mesh.coordinates.size(); ++n) result.nodes[mesh.node_labels[n]] = mesh.coordinates[n];
  for (const BlockData& block : mesh.blocks) {
    const auto nodes = static_cast<std::size_t>(topology(block.kind).nodes);
    for (std::size_t e = 0; e < block.size(); ++e) {
      Labels& labels = result.elements[{block.name, block.labels[e]}];
      for (std::size_t i = 0; i < nodes; ++i)
        labels.push_back(mesh.node_labels[static_cast<std::size_t>(block.connectivity[e * nodes + i])]);
      element_labels.push_back(block.labels[e]);
    }
  }
  for (const NodeSetData& set : mesh.node_sets)
    for (const GlobalId n : set.nodes) result.node_sets[set.name].insert(mesh.node_labels[static_cast<std::size_t>(n)]);
  for (const SideSetData& set : mesh.side_sets)
    for (const SideData& side : set.sides)
      result.side_sets[set.name].insert({element_labels[static_cast<std::size_t>(side.element)], side.side});
  return result;
}

void expect_sorted_sets(const MeshData& mesh) {
  for (const NodeSetData& set : mesh.node_sets) EXPECT_TRUE(std::is_sorted(set.nodes.begin(), set.nodes.end()));
  for (const SideSetData& set : mesh.side_sets) EXPECT_TRUE(std::is_sorted(set.sides.begin(), set.sides.end()));
}

MeshData box(int n, bool tetrahedra = false) {
  BoxShape shape;
  shape.elements = {n, n, n};
  shape.tetrahedra = tetrahedra;
  MeshData mesh = generate(shape);
  add_derived_sets(mesh);
  return mesh;
}

TEST(Renumber, TheMeshIsTheSameByLabel) {
  for (const testing::MeshSample& sample : testing::mesh_samples())
    for (const Numbering numbering : {Numbering::hilbert, Numbering::shuffled}) {
      SCOPED_TRACE(sample.name);
      MeshData mesh = sample.make();
      add_derived_sets(mesh);
      const ByLabel before = by_label(mesh);
      const Labels order = mesh.node_labels;
      EXPECT_TRUE(renumber(mesh, numbering).renumbered);
      EXPECT_NE(mesh.node_labels, order);
      EXPECT_TRUE(by_label(mesh) == before);
      expect_sorted_sets(mesh);
      check(mesh);
    }
}

TEST(Renumber, NodesWithoutElementsComeLast) {
  MeshData mesh = box(2);
  mesh.coordinates.insert(mesh.coordinates.begin(), {9, 9, 9});
  mesh.node_labels.insert(mesh.node_labels.begin(), 777);
  for (GlobalId& node : mesh.blocks[0].connectivity) ++node;
  for (NodeSetData& set : mesh.node_sets)
    for (GlobalId& node : set.nodes) ++node;
  const ByLabel before = by_label(mesh);
  renumber(mesh, Numbering::hilbert);
  EXPECT_EQ(mesh.node_labels.back(), 777);
  EXPECT_TRUE(by_label(mesh) == before);
}

TEST(Renumber, AShuffledMeshIsPutInOrderAndAnOrderlyOneIsLeftAlone) {
  for (const bool tetrahedra : {false, true}) {
    MeshData mesh = box(tetrahedra ? 30 : 36, tetrahedra);
    const MeshData original = mesh;
    EXPECT_LT(fetches_per_group(mesh), 2.5);
    const NumberingReport alone = renumber(mesh, Numbering::automatic);
    EXPECT_FALSE(alone.renumbered);
    EXPECT_EQ(described(alone), "");
    EXPECT_EQ(mesh.node_labels, original.node_labels);
    EXPECT_FALSE(renumber(mesh, Numbering::file).renumbered);
    renumber(mesh, Numbering::shuffled);
    EXPECT_FALSE(renumber(mesh, Numbering::file).renumbered);
    EXPECT_GT(fetches_per_group(mesh), 10.0);
    const NumberingReport report = renumber(mesh, Numbering::automatic);
    EXPECT_TRUE(report.renumbered);
    EXPECT_GT(report.before, 10.0);
    EXPECT_LT(report.after, 1.6);
    EXPECT_EQ(report.after, fetches_per_group(mesh));
    EXPECT_NE(described(report).find("numbers shown are the file's"), std::string::npos);
    EXPECT_TRUE(by_label(mesh) == by_label(original));
  }
}

// So that a restart, and a file whose order alone was changed, find the same numbers.
TEST(Renumber, TheOrderDoesNotDependOnTheFiles) {
  MeshData straight = box(9), mixed = box(9);
  renumber(mixed, Numbering::shuffled);
  renumber(mixed, Numbering::hilbert);
  renumber(straight, Numbering::hilbert);
  EXPECT_EQ(straight.node_labels, mixed.node_labels);
  EXPECT_EQ(straight.blocks[0].labels, mixed.blocks[0].labels);
  EXPECT_EQ(straight.blocks[0].connectivity, mixed.blocks[0].connectivity);
}

TEST(Renumber, AnEmptyMeshAndASingleElement) {
  MeshData nothing;
  EXPECT_FALSE(renumber(nothing, Numbering::automatic).renumbered);
  renumber(nothing, Numbering::hilbert);
  EXPECT_EQ(nothing.coordinates.size(), 0U);
  MeshData one = box(1);
  const ByLabel before = by_label(one);
  renumber(one, Numbering::hilbert);
  EXPECT_TRUE(by_label(one) == before);
}

}  // namespace
}  // namespace tenon

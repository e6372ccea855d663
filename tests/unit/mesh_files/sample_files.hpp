// SPDX-License-Identifier: BSD-3-Clause
// Small meshes and mesh files for the tests of the readers.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "framework/base/error.hpp"
#include "framework/mesh_files/readers.hpp"

namespace tenon::testing {

/// A folder of its own for every test, removed at its end.
class FolderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(info->test_suite_name()) + "." + info->name() + "." + std::to_string(::getpid());
    for (char& c : name) c = c == '/' ? '_' : c;
    folder_ = std::filesystem::temp_directory_path() / ("tenon_" + name);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& contents) const {
    std::ofstream(path(name), std::ios::binary) << contents;
    return path(name);
  }
  static std::string bytes_of(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::filesystem::path folder_;
};

/// The message with which `read` refuses; fails the test if it does not, or not as a matter of the file.
template <class Read>
std::string refusal(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::file) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "expected a refusal";
  return "";
}

inline void expect_mentions(const std::string& message, std::initializer_list<const char*> words) {
  for (const char* word : words)
    EXPECT_NE(message.find(word), std::string::npos) << "no '" << word << "' in: " << message;
}

/// Everything but the source and the warnings.
inline void expect_same(const MeshData& a, const MeshData& b) {
  EXPECT_EQ(a.coordinates, b.coordinates);
  EXPECT_EQ(a.node_labels, b.node_labels);
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  for (std::size_t i = 0; i < a.blocks.size(); ++i) {
    EXPECT_EQ(a.blocks[i].name, b.blocks[i].name);
    EXPECT_EQ(a.blocks[i].label, b.blocks[i].label);
    EXPECT_EQ(a.blocks[i].kind, b.blocks[i].kind);
    EXPECT_EQ(a.blocks[i].connectivity, b.blocks[i].connectivity);
    EXPECT_EQ(a.blocks[i].labels, b.blocks[i].labels);
  }
  ASSERT_EQ(a.node_sets.size(), b.node_sets.size());
  for (std::size_t i = 0; i < a.node_sets.size(); ++i) {
    EXPECT_EQ(a.node_sets[i].name, b.node_sets[i].name);
    EXPECT_EQ(a.node_sets[i].label, b.node_sets[i].label);
    EXPECT_EQ(a.node_sets[i].nodes, b.node_sets[i].nodes);
  }
  ASSERT_EQ(a.side_sets.size(), b.side_sets.size());
  for (std::size_t i = 0; i < a.side_sets.size(); ++i) {
    EXPECT_EQ(a.side_sets[i].name, b.side_sets[i].name);
    EXPECT_EQ(a.side_sets[i].label, b.side_sets[i].label);
    EXPECT_EQ(a.side_sets[i].sides, b.side_sets[i].sides);
  }
}

/// Whether every index of the mesh is one that exists.
inline void expect_sound(const MeshData& mesh) {
  const auto nodes = static_cast<GlobalId>(mesh.coordinates.size());
  ASSERT_EQ(mesh.node_labels.size(), mesh.coordinates.size());
  std::vector<ElementKind> kinds;
  for (const BlockData& block : mesh.blocks) {
    ASSERT_EQ(block.connectivity.size(), block.size() * static_cast<std::size_t>(topology(block.kind).nodes));
    for (const GlobalId n : block.connectivity) ASSERT_TRUE(n >= 0 && n < nodes);
    kinds.insert(kinds.end(), block.size(), block.kind);
  }
  for (const NodeSetData& set : mesh.node_sets)
    for (const GlobalId n : set.nodes) ASSERT_TRUE(n >= 0 && n < nodes);
  for (const SideSetData& set : mesh.side_sets)
    for (const SideData& side : set.sides) {
      ASSERT_TRUE(side.element >= 0 && side.element < static_cast<GlobalId>(kinds.size()));
      ASSERT_TRUE(side.side >= 0 && side.side < topology(kinds[static_cast<std::size_t>(side.element)]).sides);
    }
  for (const Vec3& x : mesh.coordinates)
    for (const double c : x) ASSERT_TRUE(std::isfinite(c));
}

/// One element of every kind that has a shape, apart from each other, with labels of its own and a side set of all
/// sides of all elements.
inline MeshData one_of_each_kind() {
  MeshData mesh;
  mesh.source = "one of each kind";
  const std::vector<std::vector<Vec3>> corners{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}},
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
      {{0, 0, 0},   {1, 0, 0},   {1, 1, 0},   {0, 1, 0},   {0, 0, 1},   {1, 0, 1},   {1, 1, 1},
       {0, 1, 1},   {0.5, 0, 0}, {1, 0.5, 0}, {0.5, 1, 0}, {0, 0.5, 0}, {0.5, 0, 1}, {1, 0.5, 1},
       {0.5, 1, 1}, {0, 0.5, 1}, {0, 0, 0.5}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5}},
      {{0, 0, 0},
       {1, 0, 0},
       {0, 1, 0},
       {0, 0, 1},
       {0.5, 0, 0},
       {0.5, 0.5, 0},
       {0, 0.5, 0},
       {0, 0, 0.5},
       {0.5, 0, 0.5},
       {0, 0.5, 0.5}}};
  SideSetData sides{"every side", 30, {}};
  for (int k = 0; k < element_kinds; ++k) {
    const auto kind = static_cast<ElementKind>(k);
    if (kind == ElementKind::particle) continue;
    BlockData block{"block of " + std::string(topology(kind).name), 10 + k, kind, {}, {1000 - k}};
    for (const Vec3& x : corners[static_cast<std::size_t>(k)]) {
      block.connectivity.push_back(static_cast<GlobalId>(mesh.coordinates.size()));
      mesh.node_labels.push_back(500 + 3 * static_cast<std::int64_t>(mesh.coordinates.size()));
      mesh.coordinates.push_back(x + Vec3{2.0 * k, 1.0 / 3, 0});
    }
    mesh.blocks.push_back(block);
    for (int s = 0; s < topology(kind).sides; ++s) sides.sides.push_back({k, s});
  }
  mesh.node_sets.push_back({"first", 7, {0, 3, 5}});
  mesh.node_sets.push_back({"empty", 9, {}});
  mesh.side_sets.push_back(sides);
  mesh.side_sets.push_back({"empty sides", 40, {}});
  return mesh;
}

/// How a Gmsh file is written.
struct GmshFormat {
  double version = 4.1;  ///< 2.2, 4.0 or 4.1
  bool binary = false;
  bool swapped = false;  ///< bytes in the order of the other kind of computer
};

/// Two tetrahedra (volume groups "left" and "right") that share a face, which is the surface group "middle" and points
/// out of the left one; another face of the left one is "outer"; a line is "edge", a point "tip". The group "away" is a
/// point of the geometry only. The same mesh in every format.
std::string two_tets(const GmshFormat& format);

}  // namespace tenon::testing

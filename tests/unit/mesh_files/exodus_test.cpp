// SPDX-License-Identifier: BSD-3-Clause
// Exodus files that Tenon wrote: what comes back, and what the Exodus library itself makes of them.
#include <vtk_exodusII.h>

#include <algorithm>

#include "tests/unit/mesh_files/sample_files.hpp"

namespace tenon::testing {
namespace {

class Exodus : public FolderTest {
 protected:
  MeshData round_trip(const MeshData& mesh) const {
    write_exodus(mesh, path("mesh.exo"));
    return read_exodus(path("mesh.exo"));
  }
};

TEST_F(Exodus, RoundTripIsEqual) {
  const MeshData mesh = one_of_each_kind();
  const MeshData back = round_trip(mesh);
  expect_same(mesh, back);
  EXPECT_EQ(back.source, path("mesh.exo"));
  EXPECT_TRUE(back.warnings.empty());
  EXPECT_FALSE(std::filesystem::exists(path("mesh.exo.part")));
}

TEST_F(Exodus, SameMeshSameBytes) {
  write_exodus(one_of_each_kind(), path("a.exo"));
  write_exodus(one_of_each_kind(), path("b.exo"));
  EXPECT_EQ(bytes_of(path("a.exo")), bytes_of(path("b.exo")));
}

TEST_F(Exodus, NamesMayBeLongAndInAnyLanguage) {
  MeshData mesh = one_of_each_kind();
  mesh.blocks[0].name = std::string(200, 'n');
  mesh.blocks[1].name = "Stoßfänger";
  mesh.side_sets[0].name = "a name of precisely 33 characters";
  expect_same(mesh, round_trip(mesh));
  mesh.blocks[0].name = std::string(300, 'n');
  expect_mentions(refusal([&] { round_trip(mesh); }), {"300 characters"});
}

TEST_F(Exodus, LabelsBeyond32BitsAreKept) {
  MeshData mesh = one_of_each_kind();
  mesh.node_labels[4] = 5'000'000'000;
  mesh.blocks[3].labels[0] = 6'000'000'000;
  mesh.blocks[3].label = 7'000'000'000;
  expect_same(mesh, round_trip(mesh));
  // Only a file in HDF5 can hold them.
  EXPECT_EQ(bytes_of(path("mesh.exo")).substr(1, 3), "HDF");
}

TEST_F(Exodus, ReplacesAFileOnlyWhenWhole) {
  write_exodus(one_of_each_kind(), path("mesh.exo"));
  const std::string before = bytes_of(path("mesh.exo"));
  MeshData twice = one_of_each_kind();
  twice.blocks[1].label = twice.blocks[0].label;
  expect_mentions(refusal([&] { write_exodus(twice, path("mesh.exo")); }), {"distinct ids"});
  EXPECT_EQ(bytes_of(path("mesh.exo")), before);
  expect_mentions(refusal([&] { write_exodus(twice, path("no/folder/mesh.exo")); }), {"no/folder/mesh.exo"});
  twice.blocks[1].label = 99;
  expect_mentions(refusal([&] { write_exodus(twice, path("no/folder/mesh.exo")); }), {"cannot be created"});
}

/// Node lists of the sides of a file, as the Exodus library knows them.
std::vector<std::vector<int>> sides_by_library(const std::string& file, std::int64_t set) {
  int computer = sizeof(double), stored = 0;
  float version = 0;
  const int id = ex_open(file.c_str(), EX_READ, &computer, &stored, &version);
  EXPECT_GE(id, 0);
  std::int64_t sides = 0, length = 0;
  ex_set_int64_status(id, EX_BULK_INT64_API | EX_INQ_INT64_API);
  EXPECT_GE(ex_get_set_param(id, EX_SIDE_SET, set, &sides, &length), 0);
  EXPECT_GE(ex_get_side_set_node_list_len(id, set, &length), 0);
  std::vector<std::int64_t> counts(static_cast<std::size_t>(sides)), nodes(static_cast<std::size_t>(length));
  EXPECT_GE(ex_get_side_set_node_list(id, set, counts.data(), nodes.data()), 0);
  ex_close(id);
  std::vector<std::vector<int>> lists;
  auto next = nodes.begin();
  for (const std::int64_t count : counts) {
    lists.emplace_back(next, next + count);
    next += count;
  }
  return lists;
}

TEST_F(Exodus, SidesAreThoseOfTheLibrary) {
  const MeshData mesh = one_of_each_kind();
  write_exodus(mesh, path("mesh.exo"));
  const auto lists = sides_by_library(path("mesh.exo"), 30);
  const std::vector<SideData>& sides = mesh.side_sets[0].sides;
  ASSERT_EQ(lists.size(), sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const BlockData& block = mesh.blocks[static_cast<std::size_t>(sides[i].element)];
    const Topology& shape = topology(block.kind);
    const auto s = static_cast<std::size_t>(sides[i].side);
    std::vector<int> ours;
    for (int n = 0; n < shape.side_nodes[s]; ++n)
      ours.push_back(
          static_cast<int>(block.connectivity[static_cast<std::size_t>(shape.side[s][static_cast<std::size_t>(n)])]) +
          1);
    // The same list but for where it starts: the same nodes, and the same sense.
    std::vector<int> theirs = lists[i];
    const auto first = std::find(theirs.begin(), theirs.end(), ours[0]);
    const auto corners_end = theirs.begin() + shape.side_nodes[s];
    if (!middle_nodes(block.kind).empty()) {  // theirs: the corners, then the middle nodes between each and the next
      const std::vector<int> corners = ours;
      for (std::size_t n = 0; n < corners.size(); ++n) {
        const int middle = middle_node(block.kind, shape.side[s][n], shape.side[s][(n + 1) % corners.size()]);
        ours.push_back(static_cast<int>(block.connectivity[static_cast<std::size_t>(middle)]) + 1);
      }
      ASSERT_EQ(theirs.size(), ours.size());
      std::rotate(corners_end, corners_end + (first - theirs.begin()), theirs.end());
    }
    std::rotate(theirs.begin(), first, corners_end);
    EXPECT_EQ(theirs, ours) << shape.name << " side " << s + 1;
  }
}

TEST_F(Exodus, NodesOfNoElementAreLeftOut) {
  MeshData mesh = one_of_each_kind();
  mesh.coordinates.insert(mesh.coordinates.begin() + 2, Vec3{9, 9, 9});
  mesh.node_labels.insert(mesh.node_labels.begin() + 2, 4242);
  for (BlockData& block : mesh.blocks)
    for (GlobalId& n : block.connectivity) n += n >= 2 ? 1 : 0;
  mesh.node_sets[0].nodes = {0, 2, 4, 6};
  const MeshData back = round_trip(mesh);
  ASSERT_EQ(back.warnings.size(), 1u);
  expect_mentions(back.warnings[0], {"1 nodes belong to no element"});
  expect_same(one_of_each_kind(), back);
}

TEST_F(Exodus, AMeshWithoutElementsIsRefused) {
  MeshData mesh;
  expect_mentions(refusal([&] { round_trip(mesh); }), {"no elements"});
}

}  // namespace
}  // namespace tenon::testing

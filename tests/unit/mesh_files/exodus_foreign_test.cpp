// SPDX-License-Identifier: BSD-3-Clause
// Exodus files as other programs write them.
#include <vtk_exodusII.h>
#include <vtk_netcdf.h>

#include "tests/unit/mesh_files/sample_files.hpp"

namespace tenon::testing {
namespace {

struct Block {
  std::string type;
  int nodes;
  std::vector<int> connectivity;  ///< from one
};

/// Writes a mesh without names of blocks and sets; `stored` is the width of a number in the file.
class ForeignExodus : public FolderTest {
 protected:
  std::string make(const std::vector<Block>& blocks, int dimension = 3, int mode = 0,
                   int stored = sizeof(double)) const {
    int computer = sizeof(double), elements = 0;
    const std::string file = path("foreign.g");
    for (const Block& b : blocks) elements += count(b);
    const int id = ex_create(file.c_str(), EX_CLOBBER | mode, &computer, &stored);
    EXPECT_GE(id, 0);
    const double x[] = {0, 1, 1, 0, 0, 1, 1, 0}, y[] = {0, 0, 1, 1, 0, 0, 1, 1}, z[] = {0, 0, 0, 0, 1, 1, 1, 1};
    const int nodes = dimension == 2 ? 4 : 8;
    EXPECT_GE(ex_put_init(id, "foreign", dimension, nodes, elements, static_cast<int>(blocks.size()), 1, 1), 0);
    EXPECT_GE(ex_put_coord(id, x, y, z), 0);
    int label = 100;
    for (const Block& b : blocks) {
      EXPECT_GE(ex_put_block(id, EX_ELEM_BLOCK, ++label, b.type.c_str(), count(b), b.nodes, 0, 0, 0), 0);
      if (count(b) > 0) {
        EXPECT_GE(ex_put_conn(id, EX_ELEM_BLOCK, label, b.connectivity.data(), nullptr, nullptr), 0);
      }
    }
    const int set_nodes[] = {4, 1}, set_element[] = {1}, set_side[] = {dimension == 2 ? 4 : 1};
    EXPECT_GE(ex_put_set_param(id, EX_NODE_SET, 7, 2, 0), 0);
    EXPECT_GE(ex_put_set(id, EX_NODE_SET, 7, set_nodes, nullptr), 0);
    EXPECT_GE(ex_put_set_param(id, EX_SIDE_SET, 8, 1, 0), 0);
    EXPECT_GE(ex_put_set(id, EX_SIDE_SET, 8, set_element, set_side), 0);
    EXPECT_GE(ex_close(id), 0);
    return file;
  }
  static int count(const Block& b) { return b.nodes == 0 ? 0 : static_cast<int>(b.connectivity.size()) / b.nodes; }
  static std::vector<int> first(int n) {
    std::vector<int> nodes;
    for (int i = 1; i <= n; ++i) nodes.push_back(i);
    return nodes;
  }
};

TEST_F(ForeignExodus, UnnamedBlocksAndSetsAreCalledAsInParaView) {
  const MeshData mesh = read_exodus(make({{"HEX", 8, first(8)}}));
  EXPECT_EQ(mesh.blocks.at(0).name, "block_101");
  EXPECT_EQ(mesh.node_sets.at(0).name, "nodelist_7");
  EXPECT_EQ(mesh.side_sets.at(0).name, "surface_8");
  EXPECT_EQ(mesh.node_sets[0].nodes, (std::vector<GlobalId>{0, 3}));
  EXPECT_EQ(mesh.side_sets[0].sides, (std::vector<SideData>{{0, 0}}));
  // Without maps the labels count from one.
  EXPECT_EQ(mesh.node_labels.back(), 8);
  EXPECT_EQ(mesh.blocks[0].labels, std::vector<std::int64_t>{1});
}

// Radius, or radius and volume, as programs for particles write them.
TEST_F(ForeignExodus, SpheresHaveVolumes) {
  const std::string file = path("spheres.g");
  int computer = sizeof(double), stored = sizeof(double);
  const int id = ex_create(file.c_str(), EX_CLOBBER, &computer, &stored);
  ASSERT_GE(id, 0);
  const double x[] = {0, 1, 2, 3}, y[] = {0, 0, 0, 0}, z[] = {5, 5, 5, 5};
  EXPECT_GE(ex_put_init(id, "spheres", 3, 4, 3, 2, 0, 0), 0);
  EXPECT_GE(ex_put_coord(id, x, y, z), 0);
  const int one[] = {2}, two[] = {4, 1};  // node 3 is in no element
  const double radius[] = {0.5}, both[] = {0.5, 1.25, 0.25, 0.75};
  EXPECT_GE(ex_put_block(id, EX_ELEM_BLOCK, 1, "SPHERE", 1, 1, 0, 0, 1), 0);
  EXPECT_GE(ex_put_conn(id, EX_ELEM_BLOCK, 1, one, nullptr, nullptr), 0);
  EXPECT_GE(ex_put_attr(id, EX_ELEM_BLOCK, 1, radius), 0);
  EXPECT_GE(ex_put_block(id, EX_ELEM_BLOCK, 2, "SPHERE", 2, 1, 0, 0, 2), 0);
  EXPECT_GE(ex_put_conn(id, EX_ELEM_BLOCK, 2, two, nullptr, nullptr), 0);
  EXPECT_GE(ex_put_attr(id, EX_ELEM_BLOCK, 2, both), 0);
  EXPECT_GE(ex_close(id), 0);
  const MeshData mesh = read_exodus(file);
  ASSERT_EQ(mesh.coordinates.size(), 3u);
  EXPECT_EQ(mesh.blocks[0].kind, ElementKind::particle);
  EXPECT_EQ(mesh.node_labels, (std::vector<std::int64_t>{1, 2, 4}));
  ASSERT_EQ(mesh.volumes.size(), 3u);
  EXPECT_EQ(mesh.volumes[0], 0.75);
  EXPECT_NEAR(mesh.volumes[1], 0.5235987755982988, 1e-15);
  EXPECT_EQ(mesh.volumes[2], 1.25);
}

TEST_F(ForeignExodus, EveryFileFormatGivesTheSameMesh) {
  const std::vector<Block> blocks{{"HEX8", 8, first(8)}, {"TETRA", 4, {1, 2, 4, 5}}};
  const MeshData classic = read_exodus(make(blocks));
  EXPECT_EQ(classic.coordinates[6], (Vec3{1, 1, 1}));
  for (const int mode : {EX_LARGE_MODEL, EX_64BIT_DATA | EX_ALL_INT64_DB, EX_NETCDF4, EX_NETCDF4 | EX_ALL_INT64_DB,
                         EX_NETCDF4 | EX_NOCLASSIC})
    for (const int stored : {4, 8}) expect_same(classic, read_exodus(make(blocks, 3, mode, stored)));
}

TEST_F(ForeignExodus, KnowsTheSpellingsOfTypes) {
  const std::vector<std::pair<Block, ElementKind>> spellings{
      {{"HEX", 8, first(8)}, ElementKind::hex8},      {{"hexahedron", 8, first(8)}, ElementKind::hex8},
      {{"Tet4", 4, {1, 2, 4, 5}}, ElementKind::tet4}, {{"TETRA4", 4, {1, 2, 4, 5}}, ElementKind::tet4},
      {{"WEDGE", 6, first(6)}, ElementKind::wedge6},  {{"PYRAMID5", 5, first(5)}, ElementKind::pyramid5},
      {{"SHELL", 4, first(4)}, ElementKind::quad4},   {{"SHELL4", 4, first(4)}, ElementKind::quad4},
      {{"quad", 4, first(4)}, ElementKind::quad4},    {{"TRI", 3, first(3)}, ElementKind::tri3},
      {{"SHELL3", 3, first(3)}, ElementKind::tri3},   {{"triangle", 3, first(3)}, ElementKind::tri3}};
  for (const auto& [block, kind] : spellings) {
    const std::string file = make({{"HEX8", 8, first(8)}, block});
    EXPECT_EQ(read_exodus(file).blocks.at(1).kind, kind) << block.type;
  }
}

TEST_F(ForeignExodus, OfHigherOrderOrUnknownKindIsRefusedByName) {
  const std::vector<Block> refused{{"TETRA", 8, first(8)},
                                   {"HEX27", 27, std::vector<int>(27, 1)},
                                   {"SPHERE", 2, {1, 2}},
                                   {"BAR2", 2, {1, 2}},
                                   {"NSIDED", 4, first(4)}};
  for (const Block& block : refused) {
    const std::string file = make({{"HEX8", 8, first(8)}, block});
    const std::string count = std::to_string(block.nodes) + " nodes";
    expect_mentions(refusal([&] { read_exodus(file); }),
                    {"block_102", block.type.c_str(), count.c_str(), "HEX8, TETRA4"});
  }
}

TEST_F(ForeignExodus, EmptyBlocksOfAnyTypeAreSkipped) {
  const MeshData mesh = read_exodus(make({{"NULL", 0, {}}, {"SPHERE", 1, {}}, {"HEX8", 8, first(8)}}));
  ASSERT_EQ(mesh.blocks.size(), 1u);
  EXPECT_EQ(mesh.blocks[0].name, "block_103");
  EXPECT_EQ(mesh.side_sets.at(0).sides, (std::vector<SideData>{{0, 0}}));
}

TEST_F(ForeignExodus, OfTwoDimensionsLiesAtZeroWithEdgesAsSides) {
  const MeshData mesh = read_exodus(make({{"QUAD", 4, first(4)}}, 2));
  EXPECT_EQ(mesh.blocks.at(0).kind, ElementKind::quad4);
  EXPECT_EQ(mesh.coordinates, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  // Side 4 of the file is the edge from node 4 to node 1, which stands behind the two faces here.
  ASSERT_EQ(mesh.side_sets.at(0).sides, (std::vector<SideData>{{0, 5}}));
  EXPECT_EQ(topology(ElementKind::quad4).side[5][0], 3);
  EXPECT_EQ(topology(ElementKind::quad4).side[5][1], 0);
  const std::string solid = make({{"TETRA4", 4, first(4)}}, 2);
  expect_mentions(refusal([&] { read_exodus(solid); }), {"two dimensions"});
}

/// Puts `values` over those of an integer variable.
void overwrite(const std::string& file, const char* variable, const std::vector<int>& values) {
  int id = 0, v = 0;
  ASSERT_EQ(nc_open(file.c_str(), NC_WRITE, &id), NC_NOERR);
  ASSERT_EQ(nc_inq_varid(id, variable, &v), NC_NOERR);
  ASSERT_EQ(nc_put_var_int(id, v, values.data()), NC_NOERR);
  ASSERT_EQ(nc_close(id), NC_NOERR);
}

TEST_F(ForeignExodus, IndicesThatDoNotExistAreRefused) {
  const std::vector<Block> hex{{"HEX8", 8, first(8)}};
  struct Wrong {
    const char* variable;
    std::vector<int> values;
    std::initializer_list<const char*> words;
  };
  for (const Wrong& wrong : {Wrong{"connect1", {1, 2, 3, 4, 5, 6, 7, 9}, {"block_101", "node 9", "1 to 8"}},
                             Wrong{"connect1", {0, 2, 3, 4, 5, 6, 7, 8}, {"block_101", "node 0"}},
                             Wrong{"node_ns1", {1, -2147483647}, {"nodelist_7", "-2147483647"}},
                             Wrong{"elem_ss1", {2}, {"surface_8", "element 2", "1 to 1"}},
                             Wrong{"side_ss1", {7}, {"surface_8", "side 7", "sides 1 to 6"}},
                             Wrong{"side_ss1", {0}, {"surface_8", "side 0"}}}) {
    const std::string file = make(hex);
    overwrite(file, wrong.variable, wrong.values);
    expect_mentions(refusal([&] { read_exodus(file); }), wrong.words);
  }
}

TEST_F(ForeignExodus, OldFilesKeepCoordinatesInOneVariable) {
  int id = 0, dims[4], coord = 0, ids = 0, connect = 0;
  const std::string file = path("old.g");
  ASSERT_EQ(nc_create(file.c_str(), NC_CLOBBER, &id), NC_NOERR);
  nc_def_dim(id, "num_dim", 3, &dims[0]);
  nc_def_dim(id, "num_nodes", 4, &dims[1]);
  nc_def_dim(id, "num_elem", 1, &dims[2]);
  nc_def_dim(id, "num_el_blk", 1, &dims[3]);
  int in_block = 0, per_element = 0;
  nc_def_dim(id, "num_el_in_blk1", 1, &in_block);
  nc_def_dim(id, "num_nod_per_el1", 4, &per_element);
  nc_def_var(id, "coord", NC_FLOAT, 2, dims, &coord);
  nc_def_var(id, "eb_prop1", NC_INT, 1, &dims[3], &ids);
  const int shape[] = {in_block, per_element};
  nc_def_var(id, "connect1", NC_INT, 2, shape, &connect);
  nc_put_att_text(id, connect, "elem_type", 6, "tetra ");
  nc_enddef(id);
  const float x[] = {0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.5F};
  const int block = 3, nodes[] = {1, 2, 3, 4};
  nc_put_var_float(id, coord, x);
  nc_put_var_int(id, ids, &block);
  nc_put_var_int(id, connect, nodes);
  ASSERT_EQ(nc_close(id), NC_NOERR);
  const MeshData mesh = read_exodus(file);
  EXPECT_EQ(mesh.blocks.at(0).name, "block_3");
  EXPECT_EQ(mesh.coordinates, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.5}}));
}

TEST_F(ForeignExodus, OtherNetcdfFilesAreRefused) {
  for (const int mode : {NC_CLOBBER, NC_CLOBBER | NC_NETCDF4}) {
    int id = 0, dimension = 0;
    ASSERT_EQ(nc_create(path("other.nc").c_str(), mode, &id), NC_NOERR);
    nc_def_dim(id, "latitude", 10, &dimension);
    ASSERT_EQ(nc_close(id), NC_NOERR);
    expect_mentions(refusal([&] { read_exodus(path("other.nc")); }), {"num_dim", "not an Exodus II mesh"});
  }
}

}  // namespace
}  // namespace tenon::testing

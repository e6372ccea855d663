// SPDX-License-Identifier: BSD-3-Clause
// Variables of Exodus files, written by the Exodus library itself.
#include <vtk_exodusII.h>

#include "tests/unit/mesh_files/sample_files.hpp"

namespace tenon::testing {
namespace {

/// A brick and a tetrahedron beside it; the third node of the file belongs to no element.
class ExodusResult : public FolderTest {
 protected:
  int make(int mode = 0) {
    int computer = sizeof(double), stored = sizeof(double);
    const int id = ex_create(path("result.exo").c_str(), EX_CLOBBER | mode, &computer, &stored);
    const double x[] = {0, 1, 77, 1, 0, 0, 1, 1, 0, 5, 6, 5, 5}, y[] = {0, 0, 77, 1, 1, 0, 0, 1, 1, 0, 0, 1, 0},
                 z[] = {0, 0, 77, 0, 0, 1, 1, 1, 1, 0, 0, 0, 1};
    EXPECT_GE(ex_put_init(id, "result", 3, 13, 2, 2, 0, 0), 0);
    EXPECT_GE(ex_put_coord(id, x, y, z), 0);
    const int brick[] = {1, 2, 4, 5, 6, 7, 8, 9}, tet[] = {10, 11, 12, 13};
    EXPECT_GE(ex_put_block(id, EX_ELEM_BLOCK, 10, "HEX", 1, 8, 0, 0, 0), 0);
    EXPECT_GE(ex_put_block(id, EX_ELEM_BLOCK, 20, "TETRA", 1, 4, 0, 0, 0), 0);
    EXPECT_GE(ex_put_conn(id, EX_ELEM_BLOCK, 10, brick, nullptr, nullptr), 0);
    EXPECT_GE(ex_put_conn(id, EX_ELEM_BLOCK, 20, tet, nullptr, nullptr), 0);
    return id;
  }
  void add_states(int id) {
    const char* nodal[] = {"displ_y", "TEMP", "displ_x", "displ_z", "flow_x"};
    const char* element[] = {"eqps", "SXX", "SYY", "SZZ", "SXY", "SYZ", "SZX", "only_brick"};
    const int table[] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0};
    EXPECT_GE(ex_put_variable_param(id, EX_NODAL, 5), 0);
    EXPECT_GE(ex_put_variable_names(id, EX_NODAL, 5, const_cast<char**>(nodal)), 0);
    EXPECT_GE(ex_put_variable_param(id, EX_ELEM_BLOCK, 8), 0);
    EXPECT_GE(ex_put_variable_names(id, EX_ELEM_BLOCK, 8, const_cast<char**>(element)), 0);
    EXPECT_GE(ex_put_truth_table(id, EX_ELEM_BLOCK, 2, 8, const_cast<int*>(table)), 0);
    for (int state = 1; state <= 3; ++state) {
      const double time = state * 1e-3;
      EXPECT_GE(ex_put_time(id, state, &time), 0);
      for (int v = 1; v <= 5; ++v) {
        std::vector<double> values;
        for (int n = 0; n < 13; ++n) values.push_back(1000 * state + 100 * v + n);
        EXPECT_GE(ex_put_var(id, state, EX_NODAL, v, 1, 13, values.data()), 0);
      }
      for (int v = 1; v <= 8; ++v)
        for (const int block : {10, 20}) {
          const double value = 1000 * state + 100 * v + block;
          if (v == 8 && block == 20) continue;
          EXPECT_GE(ex_put_var(id, state, EX_ELEM_BLOCK, v, block, 1, &value), 0);
        }
    }
  }
  ResultData read(int mode, const StateChoice& choice) {
    const int id = make(mode);
    add_states(id);
    EXPECT_GE(ex_close(id), 0);
    return read_exodus_result(path("result.exo"), choice);
  }
};

TEST_F(ExodusResult, VariablesOfTheLastStateAsFields) {
  for (const int mode : {0, EX_NETCDF4}) {
    const ResultData result = read(mode, {});
    EXPECT_EQ(result.time, 3e-3);
    ASSERT_EQ(result.mesh.coordinates.size(), 12u);
    ASSERT_EQ(result.fields.size(), 6u);
    const auto expect = [&](std::size_t f, const char* name, Location location, int components) {
      EXPECT_EQ(result.fields[f].description.name, name);
      EXPECT_EQ(result.fields[f].description.location, location);
      EXPECT_EQ(result.fields[f].description.components, components);
    };
    expect(0, "TEMP", Location::node, 1);
    expect(1, "displ", Location::node, 3);
    expect(2, "flow_x", Location::node, 1);
    expect(3, "eqps", Location::element, 1);
    expect(4, "S", Location::element, 6);
    expect(5, "only_brick", Location::element, 1);
    // Of node 4 of the file, the third that elements use: x, y, z.
    const std::vector<double>& displ = result.fields[1].values;
    EXPECT_EQ(std::vector<double>(displ.begin() + 6, displ.begin() + 9), (std::vector<double>{3303, 3103, 3403}));
    EXPECT_EQ(result.fields[0].values[1], 3201);
    EXPECT_EQ(result.fields[0].values[2], 3203);
    EXPECT_EQ(result.fields[4].values,
              (std::vector<double>{3210, 3310, 3410, 3510, 3610, 3710, 3220, 3320, 3420, 3520, 3620, 3720}));
    EXPECT_EQ(result.fields[4].missing, "");
    EXPECT_EQ(result.fields[5].missing, "block 'block_20'");
  }
}

TEST_F(ExodusResult, NearestStateToATime) {
  EXPECT_EQ(read(0, {.time = 2.2e-3}).fields[0].values[0], 2200);
  EXPECT_EQ(read(0, {.time = -1.0}).fields[0].values[0], 1200);
  EXPECT_EQ(read(0, {.time = 1.0}).fields[0].values[0], 3200);
}

TEST_F(ExodusResult, AMeshWithoutStatesHasNoFields) {
  EXPECT_GE(ex_close(make()), 0);
  const ResultData result = read_result(path("result.exo"), {});
  EXPECT_TRUE(result.fields.empty());
  EXPECT_FALSE(result.time);
  EXPECT_EQ(result.mesh.elements(), 2u);
}

TEST_F(ExodusResult, RefusesATruncatedFile) {
  read(0, {});
  const std::string whole = bytes_of(path("result.exo"));
  for (std::size_t part = 1; part < 16; ++part) {
    const std::string cut = write("cut.exo", whole.substr(0, whole.size() * part / 16));
    EXPECT_FALSE(refusal([&] { read_exodus_result(cut, {}); }).empty());
  }
}

}  // namespace
}  // namespace tenon::testing

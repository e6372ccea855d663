// SPDX-License-Identifier: BSD-3-Clause
// Results that any number of ranks has written, read back whole; and what is refused.
#include "framework/io/vtk_result.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include "framework/fields/root_order.hpp"
#include "framework/io/posix_file.hpp"
#include "framework/io/vtk_output.hpp"
#include "framework/io/vtk_piece.hpp"
#include "framework/mesh/generators.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon::testing {
namespace {

/// A box of bricks and one of tetrahedra in two blocks.
MeshData two_blocks() {
  BoxShape shape;
  shape.elements = {4, 3, 5}, shape.distortion = 0.2;
  MeshData mesh = generate(shape);
  shape.low = {2, 0, 0}, shape.high = {3, 1, 1}, shape.tetrahedra = true;
  MeshData other = generate(shape);
  for (GlobalId& n : other.blocks[0].connectivity) n += static_cast<GlobalId>(mesh.coordinates.size());
  mesh.blocks.push_back(other.blocks[0]);
  mesh.blocks[0].name = "bricks", mesh.blocks[1].name = "chips";
  mesh.coordinates.insert(mesh.coordinates.end(), other.coordinates.begin(), other.coordinates.end());
  mesh.node_labels.resize(mesh.coordinates.size());
  mesh.node_sets.clear(), mesh.side_sets.clear();
  return mesh;
}

std::vector<double> counted(std::size_t count, double factor) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(factor * static_cast<double>(i));
  return values;
}

class VtkResult : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fmt::format("vtk_result_np{}", comm.size());
    comm.vote_on_root([&] {
      std::filesystem::remove_all(folder_);
      make_folder(folder_);
    });
    mesh_ = distribute(comm, comm.rank() == 0 ? two_blocks() : MeshData{}, {});
    const RootOrder nodes(*mesh_, Location::node), elements(*mesh_, Location::element);
    const bool root = comm.rank() == 0;
    vector_ = nodes.to_local(root ? counted(3 * whole.coordinates.size(), 0.1) : std::vector<double>(), 3);
    scalar_ = elements.to_local(root ? counted(whole.elements(), 7) : std::vector<double>(), 1);
  }
  void TearDown() override { comm.barrier(); }
  OutputPart part() const {
    return {"body",
            mesh_.get(),
            mesh_->coordinates,
            {{{"displacement", Location::node, FieldKind::point_value, 3, "m"}, vector_},
             {{"eqps", Location::element, FieldKind::point_value, 1, "1"}, scalar_}}};
  }
  void expect_whole(const ResultData& result) const {
    EXPECT_EQ(result.mesh.coordinates, whole.coordinates);
    ASSERT_EQ(result.mesh.blocks.size(), 2u);
    for (std::size_t b = 0; b < 2; ++b) {
      EXPECT_EQ(result.mesh.blocks[b].name, whole.blocks[b].name);
      EXPECT_EQ(result.mesh.blocks[b].kind, whole.blocks[b].kind);
      EXPECT_EQ(result.mesh.blocks[b].connectivity, whole.blocks[b].connectivity);
    }
    ASSERT_EQ(result.fields.size(), 2u);
    EXPECT_EQ(result.fields[0].description.name, "displacement");
    EXPECT_EQ(result.fields[0].description.unit, "m");
    EXPECT_EQ(result.fields[0].description.components, 3);
    EXPECT_EQ(result.fields[0].values, counted(3 * whole.coordinates.size(), 0.1));
    EXPECT_EQ(result.fields[1].description.name, "eqps");
    EXPECT_EQ(result.fields[1].description.location, Location::element);
    EXPECT_EQ(result.fields[1].values, counted(whole.elements(), 7));
    EXPECT_EQ(result.fields[0].missing + result.fields[1].missing, "");
  }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  static std::string refusal(ExitCode code, const std::function<void()>& work) {
    try {
      work();
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      return error.what();
    }
    return "nothing";
  }

  const Communicator& comm = communicator();
  const MeshData whole = two_blocks();
  std::shared_ptr<const Mesh> mesh_;
  std::vector<double> vector_, scalar_;
  std::string folder_;
};

TEST_F(VtkResult, PiecesOfAllRanksMakeTheWholeAgain) {
  write_pvtu(comm, path("state.pvtu"), part());
  comm.barrier();
  expect_whole(read_vtk_result(path("state.pvtu"), {}, ""));
}

TEST_F(VtkResult, TakesTheStateAndPartThatAreAskedFor) {
  VtkOutput output(comm, folder_, std::numeric_limits<double>::quiet_NaN());
  for (const double time : {0.0, 1e-3, 3e-3}) {
    scalar_.assign(scalar_.size(), time);
    OutputPart other = part();
    other.component = "other";
    const std::vector<OutputPart> parts{part(), other};
    output.write(time, 0, parts);
  }
  comm.barrier();
  EXPECT_EQ(read_vtk_result(path("body.pvd"), {}, "").fields[1].values[5], 3e-3);
  const ResultData middle = read_vtk_result(path("all.pvd"), {.time = 1.4e-3}, "other");
  EXPECT_EQ(middle.fields[1].values[5], 1e-3);
  EXPECT_EQ(middle.time, 1e-3);
  const std::string said = refusal(ExitCode::usage, [&] { read_vtk_result(path("all.pvd"), {}, "bodi"); });
  EXPECT_NE(said.find("body, other"), std::string::npos) << said;
  EXPECT_NE(refusal(ExitCode::usage, [&] { read_vtk_result(path("all.pvd"), {}, ""); }).find("--part"),
            std::string::npos);
}

TEST_F(VtkResult, RefusesWhatIsMissingOrDamaged) {
  write_pvtu(comm, path("state.pvtu"), part());
  comm.barrier();
  refusal(ExitCode::file, [&] { read_vtk_result(path("nowhere.vtu"), {}, ""); });
  refusal(ExitCode::file, [&] { read_vtk_result(path("nowhere.pvd"), {}, ""); });
  EXPECT_NE(refusal(ExitCode::file, [&] { read_vtk_result(path("nowhere.pvtu"), {}, ""); }), "nothing");
  const std::string name = path(fmt::format("damaged{}.vtu", comm.rank()));
  const std::string text = read_text(path("state-r0.vtu"));
  write_and_rename(name, text.substr(0, text.size() / 2));
  EXPECT_NE(refusal(ExitCode::file, [&] { read_vtk_result(name, {}, ""); }), "nothing");
  comm.barrier();
}

TEST_F(VtkResult, NothingRemainsOfPiecesWhenARankCannotWrite) {
  OutputPart bad = part();
  if (comm.rank() == comm.size() - 1) bad.fields[1].values = bad.fields[1].values.first(1);
  EXPECT_NE(refusal(ExitCode::file, [&] { write_pvtu(comm, path("bad.pvtu"), bad); }), "nothing");
  comm.barrier();
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    EXPECT_FALSE(entry.path().filename().string().starts_with("bad")) << entry.path();
  comm.barrier();
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Frames: what VTK reads back, the lists after every frame, restart, errors.
#include "framework/io/vtk_output.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <set>

#include <vtkAbstractArray.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "framework/io/posix_file.hpp"
#include "framework/io/pvd_file.hpp"
#include "sample_mesh.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {

namespace {

const double no_time = std::numeric_limits<double>::quiet_NaN();

template <typename Reader>
vtkSmartPointer<vtkUnstructuredGrid> read_with(const std::string& path) {
  const vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), 0u) << path;
  return vtkUnstructuredGrid::SafeDownCast(reader->GetOutputAsDataSet());
}

vtkSmartPointer<vtkUnstructuredGrid> read(const std::string& path) {
  return path.ends_with(".pvtu") ? read_with<vtkXMLPUnstructuredGridReader>(path)
                                 : read_with<vtkXMLUnstructuredGridReader>(path);
}

std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::set<std::string> files_in(const std::string& folder) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.insert(entry.path().filename().string());
  return files;
}

void write_frame(const Communicator& comm, VtkOutput& output, double time) {
  const testing::SampleFrame frame(comm, time);
  output.write(time, 0, frame.parts);
}

std::vector<double> times_in(const std::string& path) {
  std::vector<double> times;
  for (const PvdEntry& entry : read_pvd(path)) times.push_back(entry.time);
  return times;
}

void expect_field(vtkDataSetAttributes& attributes, const char* ids, const char* name, int components, double time) {
  vtkDataArray* const id = attributes.GetArray(ids);
  vtkDataArray* const values = attributes.GetArray(name);
  ASSERT_NE(id, nullptr) << ids;
  ASSERT_NE(values, nullptr) << name;
  ASSERT_EQ(values->GetNumberOfComponents(), components);
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
    for (int c = 0; c < components; ++c)
      ASSERT_EQ(values->GetComponent(i, c), id->GetTuple1(i) + 0.1 * c + 1000 * time) << name << " " << i;
}

}  // namespace

TEST(VtkOutput, ReadsBackWhole) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_vtk_whole");
  VtkOutput output(comm, folder, no_time);
  const double time = 0.1 + 0.2;  // needs all 17 digits
  write_frame(comm, output, time);
  comm.vote_on_root([&] {
    const std::vector<PvdEntry> list = read_pvd(folder + "/all.pvd");
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].time, time);
    EXPECT_EQ(list[0].name, "mechanics");
    EXPECT_EQ(list[1].name, "thermal");
    EXPECT_EQ(list[1].part, 1);
    const auto grid = read(folder + "/" + list[0].file);
    ASSERT_EQ(grid->GetNumberOfCells(), 25);
    expect_field(*grid->GetPointData(), "GlobalNodeId", "displacement", 3, time);
    expect_field(*grid->GetCellData(), "GlobalElementId", "stress", 6, time);
    expect_field(*grid->GetCellData(), "GlobalElementId", "eqps", 1, time);
    EXPECT_STREQ(grid->GetCellData()->GetArray("stress")->GetComponentName(5), "XZ");

    std::set<int> elements;
    for (vtkIdType e = 0; e < 25; ++e) {
      const int id = static_cast<int>(grid->GetCellData()->GetArray("GlobalElementId")->GetTuple1(e));
      elements.insert(id);
      EXPECT_EQ(grid->GetCellType(e), id < 20 ? 12 : 10);
      EXPECT_EQ(grid->GetCellData()->GetArray("block")->GetTuple1(e), id < 20 ? 0 : 1);
      const double rank = grid->GetCellData()->GetArray("rank")->GetTuple1(e);
      EXPECT_TRUE(rank >= 0 && rank < comm.size() && (comm.size() < 3 || rank != 1));
      // The first corner of element i is node 4 i, at (i, 0, 0).
      double at[3];
      grid->GetPoint(grid->GetCell(e)->GetPointId(0), at);
      EXPECT_EQ(at[0], id);
    }
    EXPECT_EQ(elements.size(), 25u);
    std::set<int> nodes;
    for (vtkIdType n = 0; n < grid->GetNumberOfPoints(); ++n)
      nodes.insert(static_cast<int>(grid->GetPointData()->GetArray("GlobalNodeId")->GetTuple1(n)));
    EXPECT_EQ(nodes.size(),
              84u + 4u * 3u + 1u);  // of 21 hex faces, then three new ones per tet; no node without element
  });
}

TEST(VtkOutput, IsInlineBinaryWithUnitsAndBlockNames) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_vtk_inline");
  VtkOutput output(comm, folder, no_time);
  write_frame(comm, output, 0);
  comm.vote_on_root([&] {
    const std::string piece = folder + "/frames/mechanics-000000" + (comm.size() == 1 ? ".vtu" : "-r0.vtu");
    const std::string text = read_text(piece);
    EXPECT_EQ(text.find("AppendedData"), std::string::npos);
    EXPECT_NE(text.find("vtkLZ4DataCompressor"), std::string::npos);
    const auto grid = read(piece);
    const auto word = [&](const char* name, int i) {
      auto* const array = vtkStringArray::SafeDownCast(grid->GetFieldData()->GetAbstractArray(name));
      return array == nullptr ? std::string("none") : static_cast<std::string>(array->GetValue(i));
    };
    EXPECT_EQ(word("unit_stress", 0), "Pa");
    EXPECT_EQ(word("unit_eqps", 0), "1");
    EXPECT_EQ(word("block_names", 1), "tail");
  });
}

TEST(VtkOutput, ListsAreWholeAfterEveryFrame) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_vtk_lists");
  VtkOutput output(comm, folder, no_time);
  for (int i = 0; i < 4; ++i) {
    write_frame(comm, output, 1e-6 * i);
    EXPECT_EQ(output.frames(), i + 1);
    comm.vote_on_root([&] {
      for (const char* name : {"/all.pvd", "/mechanics.pvd", "/thermal.pvd"}) {
        const std::vector<PvdEntry> list = read_pvd(folder + name);
        ASSERT_EQ(list.size(), static_cast<std::size_t>(i + 1) * (std::string(name) == "/all.pvd" ? 2 : 1));
        EXPECT_EQ(list.back().time, 1e-6 * i);
        for (const PvdEntry& entry : list) EXPECT_GT(read(folder + "/" + entry.file)->GetNumberOfCells(), 0);
      }
      for (const std::string& file : files_in(folder + "/frames")) EXPECT_FALSE(file.ends_with(".part")) << file;
    });
  }
}

TEST(VtkOutput, RestartKeepsFramesUpToItsTime) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_vtk_resume");
  {
    VtkOutput output(comm, folder, no_time);
    for (int i = 0; i < 6; ++i) write_frame(comm, output, i / 3.0);
  }
  const std::vector<double> kept{0, 1 / 3.0, 2 / 3.0};
  VtkOutput output(comm, folder, 2 / 3.0);
  EXPECT_EQ(output.frames(), 3);
  comm.vote_on_root([&] {
    EXPECT_EQ(times_in(folder + "/thermal.pvd"), kept);
    for (const std::string& file : files_in(folder + "/frames"))
      EXPECT_TRUE(file.find("-00000" + std::string(1, file[file.find('-') + 6])) != std::string::npos &&
                  file[file.find('-') + 6] < '3')
          << file;
  });
  write_frame(comm, output, 0.7);
  EXPECT_EQ(output.frames(), 4);
  comm.vote_on_root([&] {
    EXPECT_EQ(times_in(folder + "/mechanics.pvd"), (std::vector<double>{0, 1 / 3.0, 2 / 3.0, 0.7}));
    EXPECT_NE(read_pvd(folder + "/mechanics.pvd").back().file.find("mechanics-000003"), std::string::npos);
  });
}

TEST(VtkOutput, AFrameOfTheSameTimeTakesItsPlace) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_vtk_again");
  VtkOutput output(comm, folder, no_time);
  for (const double time : {0.0, 1.0, 1.0}) write_frame(comm, output, time);
  EXPECT_EQ(output.frames(), 2);
  comm.vote_on_root([&] { EXPECT_EQ(times_in(folder + "/thermal.pvd"), (std::vector<double>{0, 1})); });
}

TEST(VtkOutput, ANewRunRemovesTheFramesOfTheOld) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_vtk_fresh");
  {
    VtkOutput output(comm, folder, no_time);
    for (int i = 0; i < 3; ++i) write_frame(comm, output, i);
  }
  comm.vote_on_root([&] { std::ofstream(folder + "/frames/mechanics-notes.txt") << "mine"; });
  const VtkOutput output(comm, folder, no_time);
  EXPECT_EQ(output.frames(), 0);
  comm.vote_on_root([&] {
    EXPECT_EQ(files_in(folder + "/frames"), std::set<std::string>{"mechanics-notes.txt"});
    EXPECT_TRUE(read_pvd(folder + "/all.pvd").empty());
  });
}

TEST(VtkOutput, ShowsAMeshWithoutElements) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_vtk_empty");
  const Mesh mesh = testing::sample_mesh(comm, 0, 0);
  const std::vector<double> values = testing::field_values(mesh.global_nodes, 1, 0);
  const OutputPart part{
      "empty", &mesh, mesh.coordinates, {{{"temperature", Location::node, FieldKind::point_value, 1, "K"}, values}}};
  VtkOutput output(comm, folder, no_time);
  output.write(0, 0, std::span(&part, 1));
  comm.vote_on_root(
      [&] { EXPECT_EQ(read(folder + "/" + read_pvd(folder + "/empty.pvd")[0].file)->GetNumberOfCells(), 0); });
}

TEST(VtkOutput, RefusesFieldsThatDoNotFit) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_vtk_fit");
  VtkOutput output(comm, folder, no_time);
  testing::SampleFrame frame(comm, 0);
  if (comm.rank() == comm.size() - 1) frame.parts[0].fields[2].values = {};
  EXPECT_EQ(message_of([&] { output.write(0, 0, frame.parts); }),
            "output of component mechanics: field eqps: 0 values instead of 25");
  EXPECT_EQ(output.frames(), 0);
}

TEST(VtkOutput, SaysWhatCannotBeWritten) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_vtk_errors");
  VtkOutput output(comm, folder, no_time);
  comm.vote_on_root([&] { std::filesystem::remove_all(folder + "/frames"); });
  EXPECT_NE(message_of([&] { write_frame(comm, output, 0); }).find(folder + "/frames/mechanics-000000"),
            std::string::npos);
  comm.vote_on_root([&] { std::ofstream(folder + "/frames") << "a file"; });
  EXPECT_NE(message_of([&] { VtkOutput(comm, folder, no_time); }).find("folder cannot be made"), std::string::npos);
}

TEST(PvdFile, RefusesWhatIsNoList) {
  const Communicator& comm = testing::communicator();
  const std::string path = testing::fresh_folder(comm, "io_pvd") + "/all.pvd";
  comm.vote_on_root([&] {
    const std::string whole = format_pvd(std::vector<PvdEntry>{{0.1, 0, "a<b>&\"c", "x.vtu"}, {0.2, 1, "d", "y.vtu"}});
    std::ofstream(path) << whole;
    ASSERT_EQ(read_pvd(path).size(), 2u);
    EXPECT_EQ(read_pvd(path)[0].name, "a<b>&\"c");
    EXPECT_EQ(read_pvd(path)[0].time, 0.1);
    for (std::size_t cut = 0; cut + 2 < whole.size(); cut += 7) {
      write_and_rename(path, whole.substr(0, cut));
      EXPECT_THROW(read_pvd(path), Error) << cut;
    }
  });
}

}  // namespace tenon

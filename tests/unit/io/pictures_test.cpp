// SPDX-License-Identifier: BSD-3-Clause
// Pictures of a run: there, of the right size, coloured, with frames that differ. Runs under xvfb-run.
#include "framework/io/pictures.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkSmartPointer.h>

#include "framework/io/history_table.hpp"
#include "framework/io/pvd_file.hpp"
#include "framework/io/run_frames.hpp"
#include "sample_bar.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {

namespace {

/// What a look at a picture would tell.
struct Picture {
  int width = 0, height = 0;
  std::size_t colors = 0;  // distinct, in steps of 1/64
  double white = 0;        // share of the pixels
  std::vector<unsigned char> pixels;
};

Picture look(const std::string& path) {
  const vtkNew<vtkPNGReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkImageData* const image = reader->GetOutput();
  Picture p{image->GetDimensions()[0], image->GetDimensions()[1], 0, 0, {}};
  const auto* const data = static_cast<const unsigned char*>(image->GetScalarPointer());
  const auto count = static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height);
  const auto channels = static_cast<std::size_t>(image->GetNumberOfScalarComponents());
  std::set<unsigned> colors;
  std::size_t white = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned char* const rgb = data + i * channels;
    colors.insert(rgb[0] / 4u << 16 | rgb[1] / 4u << 8 | rgb[2] / 4u);
    white += rgb[0] == 255 && rgb[1] == 255 && rgb[2] == 255;
  }
  p.colors = colors.size();
  p.white = static_cast<double>(white) / static_cast<double>(count);
  p.pixels.assign(data, data + count * channels);
  return p;
}

std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string sample_run(const std::string& name, int frames) {
  const std::string folder = testing::fresh_folder(testing::communicator(), name);
  testing::write_sample_run(testing::communicator(), folder, 4, 12, frames);
  return folder;
}

}  // namespace

TEST(Pictures, EveryFrameTheLastAndTheHistory) {
  const std::string folder = sample_run("io_pictures_all", 3);
  PictureOptions options;
  options.width = 640, options.height = 360;
  const std::vector<std::string> paths = draw_pictures(folder, options);
  const std::set<std::string> found(paths.begin(), paths.end());
  for (const char* name : {"mechanics_eqps_0000.png", "mechanics_eqps_0002.png", "mechanics_von_mises_0001.png",
                           "thermal_temperature_0002.png", "last.png", "history.png"}) {
    ASSERT_TRUE(found.contains(folder + "/pictures/" + name)) << name;
    const Picture picture = look(folder + "/pictures/" + name);
    EXPECT_EQ(picture.width, 640);
    EXPECT_EQ(picture.height, 360);
    EXPECT_GT(picture.colors, std::string(name) == "history.png" ? 60u : 150u) << name;
    EXPECT_GT(picture.white, 0.3) << name;
    EXPECT_LT(picture.white, 0.97) << name;
  }
  EXPECT_EQ(paths.size(), 3u * 3u + 2u);
  const Picture first = look(folder + "/pictures/mechanics_eqps_0000.png"),
                last = look(folder + "/pictures/mechanics_eqps_0002.png");
  EXPECT_NE(first.pixels, last.pixels);
}

TEST(Pictures, SameInputGivesTheSamePicture) {
  const std::string folder = sample_run("io_pictures_same", 2);
  PictureOptions options;
  options.width = 400, options.height = 300;
  options.every_frame = false;
  draw_pictures(folder, options);
  const Picture first = look(folder + "/pictures/last.png");
  draw_pictures(folder, options);
  EXPECT_EQ(first.pixels, look(folder + "/pictures/last.png").pixels);
}

TEST(Pictures, OnlyWhatIsAskedFor) {
  const std::string folder = sample_run("io_pictures_one", 2);
  PictureOptions options;
  options.width = 400, options.height = 300;
  options.component = "mechanics";
  options.fields = {"displacement"};
  const std::vector<std::string> paths = draw_pictures(folder, options);
  EXPECT_EQ(paths, (std::vector<std::string>{folder + "/pictures/mechanics_displacement_0000.png",
                                             folder + "/pictures/mechanics_displacement_0001.png",
                                             folder + "/pictures/last.png", folder + "/pictures/history.png"}));
}

TEST(Pictures, RefusesWhatCannotBeDrawn) {
  const std::string folder = sample_run("io_pictures_refuse", 1);
  PictureOptions options;
  options.component = "sph";
  EXPECT_NE(message_of([&] { draw_pictures(folder, options); }).find("components are mechanics, thermal"),
            std::string::npos);
  EXPECT_NE(message_of([&] { draw_pictures("no-such-folder", {}); }).find("holds no frames"), std::string::npos);
  options.component = "mechanics", options.fields = {"colour"};
  EXPECT_NE(message_of([&] { draw_pictures(folder, options); }).find("no such field"), std::string::npos);
  std::ofstream(folder + "/frames/thermal-000000.vtu") << "<VTKFile type=\"UnstructuredGrid\"><broken";
  EXPECT_NE(message_of([&] { draw_pictures(folder, {}); }).find("thermal-000000.vtu"), std::string::npos);
  std::filesystem::remove(folder + "/frames/thermal-000000.vtu");
  EXPECT_NE(message_of([&] { draw_pictures(folder, {}); }).find("thermal-000000.vtu"), std::string::npos);
}

TEST(Pictures, RangeIsThatOfAllFrames) {
  const std::string folder = sample_run("io_pictures_range", 3);
  RunFrames frames(folder, "mechanics");
  frames.scan({"eqps", "displacement"});
  EXPECT_EQ(frames.range("eqps").low, 0);
  EXPECT_DOUBLE_EQ(frames.range("eqps").high, testing::foot(0, std::sin(1.5707963)));
  EXPECT_GT(frames.range("displacement").high, 3e-3);  // a magnitude, so never below zero
  EXPECT_EQ(frames.range("displacement").low, 0);
  EXPECT_EQ(frames.find("eqps")->unit, "1");
  EXPECT_EQ(frames.find("von_mises")->unit, "Pa");
}

// Two pieces that share a face: the face is not part of the outside.
TEST(Pictures, PiecesOfSeveralRanksJoinWithoutInnerFaces) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_pictures_pieces");
  Mesh mesh = testing::bar_mesh(comm, 2, 4, false);
  const auto write = [&](int owner_of_top, const std::string& name) {
    for (std::size_t e = 0; e < mesh.blocks[0].owners.size(); ++e)
      mesh.blocks[0].owners[e] = e < 8 ? owner_of_top : 1 - owner_of_top;
    const OutputPart part{name, &mesh, mesh.coordinates, {}};
    VtkOutput output(comm, folder + "/" + name, std::numeric_limits<double>::quiet_NaN());
    output.write(0, 0, std::span(&part, 1));
    return folder + "/" + name + "/frames/" + name + "-000000.vtu";
  };
  const std::string low = write(0, "low"), high = write(1, "high");
  std::filesystem::create_directories(folder + "/frames");
  std::filesystem::copy(low, folder + "/frames/bar-000000-r0.vtu");
  std::filesystem::copy(high, folder + "/frames/bar-000000-r1.vtu");
  std::ofstream(folder + "/frames/bar-000000.pvtu")
      << "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece Source=\"bar-000000-r0.vtu\"/>"
         "<Piece Source=\"bar-000000-r1.vtu\"/></PUnstructuredGrid></VTKFile>";
  std::ofstream(folder + "/all.pvd") << format_pvd(std::vector<PvdEntry>{{0, 0, "bar", "frames/bar-000000.pvtu"}});
  RunFrames frames(folder, "bar");
  frames.scan({});
  EXPECT_EQ(frames.faces(), 2 * 4 + 4 * 2 * 4);
}

// Hot along the axis: the cut shows it. Hot outside: no need to cut.
TEST(Pictures, CutsOpenWhatHidesItsGreatestValues) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_pictures_cut");
  const Mesh mesh = testing::bar_mesh(comm, 8, 12, true);
  std::vector<double> core, shell;
  for (const Vec3& x : mesh.coordinates) {
    const double r = std::hypot(x[0], x[1]) / 3.2e-3;
    core.push_back(1 - r);
    shell.push_back(r);
  }
  const OutputPart part{"bar",
                        &mesh,
                        mesh.coordinates,
                        {{{"core", Location::node, FieldKind::point_value, 1, "K"}, core},
                         {{"shell", Location::node, FieldKind::point_value, 1, "K"}, shell}}};
  VtkOutput output(comm, folder, std::numeric_limits<double>::quiet_NaN());
  output.write(0, 0, std::span(&part, 1));
  for (const char* field : {"shell", "core"}) {  // the upper end shows the axis
    RunFrames open(folder, "bar");
    open.cut_if_hidden(field);
    EXPECT_FALSE(open.is_cut()) << field;
  }
  for (std::size_t n = 0; n < core.size(); ++n)
    if (mesh.coordinates[n][2] > 32e-3) core[n] = 0;  // now it does not
  output.write(0, 0, std::span(&part, 1));
  RunFrames frames(folder, "bar");
  frames.cut_if_hidden("core");
  ASSERT_TRUE(frames.is_cut());
  frames.scan({"core"});
  EXPECT_GT(frames.range("core").high, 0.95);
  EXPECT_NEAR(frames.box().low[1], -3.2e-3, 1e-6);  // of the whole body
  double bounds[6];
  frames.surface(0)->GetBounds(bounds);
  EXPECT_NEAR(bounds[2], 0, 1e-4);  // the near half is gone
}

TEST(Pictures, ARunThatHasOnlyBegun) {
  const std::string folder = sample_run("io_pictures_begun", 1);
  std::ofstream(folder + "/history.csv") << "time,step,dt,kinetic_energy,energy_error\n0,0,1e-8,3,0\n";
  PictureOptions options;
  options.width = 400, options.height = 300;
  EXPECT_EQ(draw_pictures(folder, options).size(), 5u);
  EXPECT_GT(look(folder + "/pictures/history.png").colors, 10u);
}

TEST(HistoryTable, GroupsColumnsByQuantity) {
  const std::string folder = sample_run("io_pictures_history", 1);
  std::ofstream(folder + "/history.csv", std::ios::app) << "1,2,3";  // torn by a kill
  const HistoryTable table = read_history(folder + "/history.csv");
  EXPECT_EQ(table.rows(), 801u);
  const std::vector<PlotGroup> groups = plot_groups(table);
  ASSERT_EQ(groups.size(), 6u);
  EXPECT_EQ(groups[0].columns.size(), 6u);  // all but wall_work, which is zero
  EXPECT_TRUE(groups[1].logarithmic);
  EXPECT_EQ(groups[2].quantity, "eqps");
  EXPECT_EQ(groups[3].quantity, "temperature");
  EXPECT_EQ(groups[3].columns.size(), 3u);
  std::ofstream(folder + "/history.csv", std::ios::app) << "\n";
  EXPECT_NE(message_of([&] { read_history(folder + "/history.csv"); }).find("row 803 is not 17 numbers"),
            std::string::npos);
}

}  // namespace tenon

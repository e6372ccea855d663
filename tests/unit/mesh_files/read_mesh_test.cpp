// SPDX-License-Identifier: BSD-3-Clause
// The choice of the reader, and files that none can read.
#include "tests/unit/mesh_files/sample_files.hpp"

namespace tenon::testing {
namespace {

class ReadMesh : public FolderTest {};

TEST_F(ReadMesh, ChoosesByContentWhateverTheName) {
  const MeshData gmsh = read_mesh(write("mesh.exo", two_tets({})));
  EXPECT_EQ(gmsh.blocks.size(), 2u);
  write_exodus(gmsh, path("mesh.msh"));
  expect_same(read_mesh(path("mesh.msh")), gmsh);
  EXPECT_EQ(gmsh.source, path("mesh.exo"));
}

TEST_F(ReadMesh, RefusesWhatIsNoFile) {
  expect_mentions(refusal([&] { read_mesh(path("nothing.exo")); }),
                  {"nothing.exo", "no such file", "Exodus II or Gmsh"});
  expect_mentions(refusal([&] { read_mesh(path("")); }), {"is a directory", "Exodus II or Gmsh"});
  expect_mentions(refusal([&] { read_mesh(write("empty.exo", "")); }), {"is empty"});
  expect_mentions(refusal([&] { read_mesh("/dev/null"); }), {"not a regular file"});
}

TEST_F(ReadMesh, ExplainsFilesOfOtherKinds) {
  const auto message = [&](const std::string& name, const std::string& text) {
    return refusal([&] { read_mesh(write(name, text)); });
  };
  expect_mentions(message("a.txt", "hello"), {"unknown kind", "expected an Exodus II", "Gmsh"});
  expect_mentions(message("a.msh", "hello"), {"$MeshFormat"});
  expect_mentions(message("a.e", "hello"), {"netCDF or HDF5"});
  expect_mentions(message("a.msh.gz", "\x1f\x8b zzz"), {"compressed", "decompress"});
  expect_mentions(message("a.inp", "*HEADING\n"), {"Abaqus"});
  expect_mentions(message("a.vtu", "<?xml version=\"1.0\"?>"), {"VTK"});
  expect_mentions(message("a.geo", "Point(1) = {0,0,0};"), {"geometry", "gmsh -3"});
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// tenon_mesh_convert IN OUT.exo: reads a mesh of any kind that Tenon reads, checks it, and writes it as Exodus II.
#include <fmt/format.h>

#include <exception>

#include "framework/base/error.hpp"
#include "framework/mesh_files/readers.hpp"

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: tenon_mesh_convert IN OUT.exo\n");
    return static_cast<int>(tenon::ExitCode::usage);
  }
  try {
    const tenon::MeshData mesh = tenon::read_mesh(argv[1]);
    for (const std::string& warning : mesh.warnings) fmt::print(stderr, "{}: warning: {}\n", argv[1], warning);
    tenon::check(mesh);
    tenon::write_exodus(mesh, argv[2]);
    fmt::print("{}: {} nodes, {} elements, {} blocks, {} node sets, {} side sets\n", argv[2], mesh.coordinates.size(),
               mesh.elements(), mesh.blocks.size(), mesh.node_sets.size(), mesh.side_sets.size());
  } catch (const tenon::Error& error) {
    fmt::print(stderr, "tenon_mesh_convert: {}\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    fmt::print(stderr, "tenon_mesh_convert: {}\n", error.what());
    return 1;
  }
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
// Chooses the reader of a mesh file by its first bytes, and explains what a file is that none can read.
#include "framework/mesh_files/readers.hpp"

#include <algorithm>
#include <filesystem>

#include "framework/mesh_files/netcdf_file.hpp"
#include "framework/mesh_files/read_support.hpp"

namespace tenon {
namespace {

constexpr std::size_t looked_at = 4096;
constexpr const char* readable = "expected an Exodus II file (.e .g .exo .ex2) or a Gmsh file (.msh, version 2 or 4)";

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

bool begins_as_gmsh(const std::string& start) {
  const std::size_t first = start.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return false;
  const std::string_view rest = std::string_view(start).substr(first);
  return rest.starts_with("$MeshFormat") || rest.starts_with("$Comments") || rest.starts_with("$NOD");
}

/// Why a file that is neither Exodus nor Gmsh is not read.
std::string explain(const std::string& start, const std::string& extension) {
  if (start.starts_with("\x1f\x8b")) return "is compressed (gzip); decompress it first";
  if (start.starts_with("*") || extension == ".inp") return std::string("looks like an Abaqus input file; ") + readable;
  if (start.starts_with("<?xml") || start.starts_with("<VTKFile") || start.starts_with("# vtk"))
    return std::string("is a VTK file; ") + readable;
  if (extension == ".msh") return "does not begin with $MeshFormat, as a Gmsh mesh does (other programs use .msh too)";
  if (extension == ".e" || extension == ".g" || extension == ".exo" || extension == ".ex2")
    return "does not begin as a netCDF or HDF5 file, as an Exodus II mesh does";
  if (extension == ".geo") return "is a Gmsh geometry, not a mesh; make the mesh with: gmsh -3 FILE.geo -format msh41";
  return std::string("is of an unknown kind; ") + readable;
}

}  // namespace

MeshData read_mesh(const std::string& path) {
  const std::string start = mesh_file::start_of(path, looked_at);
  if (start.starts_with("CDF") || mesh_file::is_hdf5(start)) return read_exodus(path);
  if (begins_as_gmsh(start)) return read_gmsh(path);
  mesh_file::refuse(path, explain(start, extension_of(path)));
}

ResultData read_result(const std::string& path, const StateChoice& choice) {
  const std::string start = mesh_file::start_of(path, looked_at);
  if (start.starts_with("CDF") || mesh_file::is_hdf5(start)) return read_exodus_result(path, choice);
  ResultData result;
  result.mesh = read_mesh(path);
  return result;
}

}  // namespace tenon

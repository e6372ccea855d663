// SPDX-License-Identifier: BSD-3-Clause
// Mesh files. Serial: rank 0 reads, then the mesh is distributed.
#pragma once

#include <string>

#include "framework/fields/result_data.hpp"
#include "framework/mesh/mesh_data.hpp"

namespace tenon {

/// Reads by content, whatever the extension: Exodus II (.e .g .exo .ex2; netCDF classic, 64-bit offset, CDF-5 and HDF5)
/// and Gmsh 2.x and 4.1, text or binary, and 4.0, text (.msh). Throws Error(file) naming file, line or section, what
/// was expected and, for a version or an element that is not read, what to do. Never crashes on truncated or corrupted
/// files. Indices are checked; shapes are not: call check(). Nodes that no element uses are left out. Names and ids are
/// made distinct. What was left out or renamed stands in MeshData::warnings.
MeshData read_mesh(const std::string& path);

/// Unnamed blocks and sets become block_N, nodelist_N, surface_N, as ParaView names them; names in the file are kept.
/// In a file of two dimensions z is 0. Spheres are particles; their attributes, the radius or radius and volume, become
/// MeshData::volumes. An HDF5 file is read in a forked child first, because that library can crash on
/// corrupt files.
MeshData read_exodus(const std::string& path);

/// The mesh with its nodal and element variables in one state. Variables that differ in a last x, y, z (or xx, yy, zz,
/// xy, yz, zx or xz) alone are one field: displ_x, displ_y, displ_z -> displ. A file without states has no fields.
ResultData read_exodus_result(const std::string& path, const StateChoice& choice);
/// The same of any file that read_mesh reads; a Gmsh file has no fields.
ResultData read_result(const std::string& path, const StateChoice& choice);

/// Elements of the highest dimension become blocks, one for each physical group and kind ("name", or "name_tet4" where
/// a group has several kinds); without groups the block is "volume" or "surface". An element of several groups is in
/// that with the smallest tag. Groups of lower dimension become node sets, and side sets where their elements lie on
/// sides of blocks: of the two solids at an inner face, that which the face points out of. A surface group in a solid
/// mesh that lies on no solid becomes a block of shells.
MeshData read_gmsh(const std::string& path);

/// Writes an Exodus II file with blocks, node sets, side sets, names and labels, which read_exodus() reads back equal:
/// 64-bit offset, or HDF5 if an id needs more than 32 bits. Ids of blocks and of sets must be positive and distinct.
/// The file is replaced only when the new one is whole. Throws Error(file).
void write_exodus(const MeshData& mesh, const std::string& path);

}  // namespace tenon

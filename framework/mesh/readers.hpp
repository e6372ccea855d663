// SPDX-License-Identifier: BSD-3-Clause
// Mesh files. Serial: rank 0 reads, then the mesh is distributed.
#pragma once

#include <string>

#include "framework/mesh/mesh_data.hpp"

namespace tenon {

/// Reads by content and extension: Exodus II (.e .g .exo .ex2), Gmsh 2.2 and 4.1 ASCII or binary (.msh).
/// Throws Error(file) naming file, line or section, what was expected and, for a version or an element that is not
/// read, what to do. Never crashes on truncated or corrupted files.
MeshData read_mesh(const std::string& path);
/// Unnamed blocks and sets become block_N, nodelist_N, surface_N, as ParaView names them; names in the file are kept.
MeshData read_exodus(const std::string& path);
/// Physical groups become blocks (of the highest dimension present), node sets and side sets; without groups, entities
/// become blocks.
MeshData read_gmsh(const std::string& path);
/// Writes an Exodus II file with blocks, node sets, side sets and their names. Throws Error(file).
void write_exodus(const MeshData& mesh, const std::string& path);

}  // namespace tenon

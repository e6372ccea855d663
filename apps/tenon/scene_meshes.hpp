// SPDX-License-Identifier: BSD-3-Clause
// Meshes of a scene: files and generated shapes.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "framework/comm/communicator.hpp"
#include "framework/mesh/mesh_data.hpp"
#include "framework/scene/schema.hpp"

namespace tenon {

/// Schemas of the kinds of mesh block, by `type`.
std::vector<std::pair<std::string, scene::Schema>> mesh_variants();

/// A mesh block that was read: `data` is whole on rank 0 and empty elsewhere, `summary` is the same on every rank.
struct SceneMesh {
  std::string name;
  MeshData data;
  MeshSummary summary;
  int dimension = 3;      ///< of the volumes of particles
  std::string numbering;  ///< what was done to the order of nodes and elements, for the log
};

/// Collective. Reads or generates on rank 0, checks the elements. Paths are relative to the scene's folder. Complaints
/// about the block (counts that are no whole numbers ...) go to `diagnostics`; throws Error(file) or Error(geometry)
/// together. `earlier`: meshes that this one may be made of.
SceneMesh make_mesh(const Communicator& comm, const std::string& name, const scene::Value& block,
                    const std::string& folder, std::span<const SceneMesh> earlier, scene::Diagnostics& diagnostics);

}  // namespace tenon

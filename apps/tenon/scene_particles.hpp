// SPDX-License-Identifier: BSD-3-Clause
// Meshes of particles in a scene: bodies of simple shape, walls of tanks, whatever a mesh encloses, points of files.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "framework/mesh/mesh_data.hpp"
#include "framework/scene/schema.hpp"

namespace tenon {

/// Keys of a mesh of type `particles`.
scene::Schema particle_mesh_schema();

struct SceneMesh;

/// What makes it on rank 0; complaints are the same on every rank. `earlier`: meshes whose elements bodies may be made
/// of, at the time of the call.
std::function<MeshData()> particle_recipe(const scene::Value& block, const std::string& folder,
                                          std::span<const SceneMesh> earlier, scene::Diagnostics& diagnostics);

}  // namespace tenon

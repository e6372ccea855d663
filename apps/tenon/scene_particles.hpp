// SPDX-License-Identifier: BSD-3-Clause
// Meshes of particles in a scene: bodies of simple shape, walls of tanks, whatever a mesh encloses, points of files.
#pragma once

#include <functional>
#include <string>

#include "framework/mesh/mesh_data.hpp"
#include "framework/scene/schema.hpp"

namespace tenon {

/// Keys of a mesh of type `particles`.
scene::Schema particle_mesh_schema();

/// What makes it on rank 0; complaints are the same on every rank.
std::function<MeshData()> particle_recipe(const scene::Value& block, const std::string& folder,
                                          scene::Diagnostics& diagnostics);

}  // namespace tenon

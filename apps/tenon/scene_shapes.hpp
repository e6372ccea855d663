// SPDX-License-Identifier: BSD-3-Clause
// Generated meshes of test bodies: cans, projectiles, foams; and where a generated mesh is put.
#pragma once

#include <functional>

#include "framework/mesh/mesh_data.hpp"
#include "framework/scene/schema.hpp"

namespace tenon {

scene::Schema can_schema();
scene::Schema projectile_schema();
scene::Schema foam_schema();

/// What is to be done on rank 0 for a block of type `can`, `projectile` or `foam`.
std::function<MeshData()> shape_recipe(const scene::Value& block, scene::Diagnostics& diagnostics);

/// Adds the keys `turn` and `shift`, which any mesh but that of particles has.
void add_placement(scene::Schema& schema);
/// Complains about a turn that makes no sense; returns what moves the nodes.
std::function<void(MeshData&)> placement(const scene::Value& block, scene::Diagnostics& diagnostics);

}  // namespace tenon

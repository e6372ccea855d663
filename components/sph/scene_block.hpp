// SPDX-License-Identifier: BSD-3-Clause
// The scene block of particles.
#pragma once

#include <map>
#include <string>

#include "components/materials/material.hpp"
#include "components/sph/sph_options.hpp"
#include "framework/mesh/mesh_data.hpp"
#include "framework/scene/schema.hpp"
#include "framework/scene/value.hpp"

namespace tenon {

/// Keys of a component of type `sph`.
scene::Schema sph_schema();

/// Turns a validated block into options; block and material names are checked against the mesh and the scene, and
/// complaints go to `diagnostics`. `dimension` is that of the volumes of the mesh.
SphOptions read_sph(const scene::Value& value, const MeshSummary& mesh, int dimension,
                    const std::map<std::string, MaterialDescription>& materials, scene::Diagnostics& diagnostics);

}  // namespace tenon

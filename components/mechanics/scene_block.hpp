// SPDX-License-Identifier: BSD-3-Clause
// The scene block of an explicit mechanics component.
#pragma once

#include <map>
#include <string>

#include "components/materials/material.hpp"
#include "components/mechanics/element_cost.hpp"
#include "components/mechanics/mechanics_options.hpp"
#include "framework/mesh/mesh_data.hpp"
#include "framework/scene/schema.hpp"
#include "framework/scene/value.hpp"

namespace tenon {

/// Keys of a component of type `explicit_mechanics`.
scene::Schema mechanics_schema();

/// Turns a validated block into options; block, set and material names are checked against the mesh and the scene, and
/// complaints go to `diagnostics`.
MechanicsOptions read_mechanics(const scene::Value& value, const MeshSummary& mesh,
                                const std::map<std::string, MaterialDescription>& materials,
                                scene::Diagnostics& diagnostics);

}  // namespace tenon

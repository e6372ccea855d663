// SPDX-License-Identifier: BSD-3-Clause
// Materials in a scene file.
#pragma once

#include <string>

#include "components/materials/material.hpp"
#include "framework/scene/schema.hpp"
#include "framework/scene/value.hpp"

namespace tenon {

/// The keys of one material block.
scene::Schema material_schema();

/// Turns a validated block into a description. What the schema cannot see (melting below the reference temperature,
/// plasticity without elasticity) goes to `diagnostics`.
MaterialDescription read_material(const std::string& name, const scene::Value& value, scene::Diagnostics& diagnostics);

}  // namespace tenon

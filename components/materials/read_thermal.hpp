// SPDX-License-Identifier: BSD-3-Clause
// The thermal properties of a material in a scene file.
#pragma once

#include "components/materials/material.hpp"
#include "framework/scene/schema.hpp"
#include "framework/scene/value.hpp"

namespace tenon {

/// The keys of the block `thermal` of a material.
scene::Schema thermal_properties_schema();

/// Turns a validated block into properties; what the schema cannot see goes to `diagnostics`.
ThermalProperties read_thermal_properties(const scene::Value& value, scene::Diagnostics& diagnostics);

}  // namespace tenon

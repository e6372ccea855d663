// SPDX-License-Identifier: BSD-3-Clause
// Loads in the scene block of mechanics.
#pragma once

#include "components/mechanics/load_options.hpp"
#include "components/mechanics/scene_reader.hpp"
#include "framework/scene/schema.hpp"

namespace tenon {

/// Adds the keys of loads to those of the component.
void add_load_keys(scene::Schema& schema);
/// Reads them; complaints go to the reader's diagnostics.
void read_loads(const scene::Value& value, const SceneReader& reader, LoadOptions& loads);

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// The schema of a whole scene: the sum of what the rooms declare.
#pragma once

#include <string>
#include <vector>

#include "framework/scene/schema.hpp"
#include "framework/simulation/interval.hpp"

namespace tenon {

/// Validation and docs/scene-reference.md both come from here. A further component is one more entry of `components`.
scene::Schema scene_schema();

/// Keys `component` and `field`, of a field that is shown.
void add_shown_field(scene::Schema& schema);

/// "5 us" or "200 steps"; complaints go to `diagnostics`.
Interval read_interval(const scene::Value& block, const std::string& key, scene::Diagnostics& diagnostics);

}  // namespace tenon

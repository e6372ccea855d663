// SPDX-License-Identifier: BSD-3-Clause
// A schema that uses every kind of key, and a scene that obeys it.
#pragma once

#include <string>
#include <vector>

#include "framework/scene/schema.hpp"

namespace tenon::testing {

scene::Schema rich_schema();
extern const char* const good_scene;

/// The complaints about a text, as "LINE:COLUMN: message" or "--set path: message".
std::vector<std::string> complaints(const std::string& text, const std::vector<scene::Override>& overrides = {});

}  // namespace tenon::testing

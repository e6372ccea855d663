// SPDX-License-Identifier: BSD-3-Clause
// From a scene file to a checked description, the same on every rank.
#pragma once

#include <string>
#include <vector>

#include "framework/comm/communicator.hpp"
#include "framework/scene/schema.hpp"

namespace tenon {

struct LoadedScene {
  std::string path, folder;  ///< file and the folder it is in
  std::string title;
  scene::Value value;
};

/// Collective. The text of a scene or study, the same on every rank. Throws Error(usage) if it cannot be read.
std::string read_scene_text(const Communicator& comm, const std::string& path);

/// A study names its scene and what varies at the left margin; a scene never has these keys.
bool is_study(const std::string& text);

/// Collective. Rank 0 reads the file, all ranks parse the same text. Throws Error(file) if it cannot be read and
/// Error(usage) with every complaint of the schema.
LoadedScene load_scene(const Communicator& comm, const std::string& path,
                       const std::vector<scene::Override>& overrides);

/// "a.b=c" as it stands on the command line. Throws Error(usage).
std::vector<scene::Override> parse_overrides(const std::vector<std::string>& texts);

}  // namespace tenon

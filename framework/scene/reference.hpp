// SPDX-License-Identifier: BSD-3-Clause
// The sections of the scene reference and their examples; private to this room.
#pragma once

#include <string>
#include <vector>

#include "framework/scene/schema.hpp"

namespace tenon::scene {

/// One step from the scene's root into a nested mapping.
struct Frame {
  const Key* key;
  std::string type;  ///< the chosen variant, or empty
};

/// A mapping of the schema, as the reference shows it.
struct Section {
  std::string path;           ///< keys and types with dots between them; empty for the root
  std::vector<Frame> frames;  ///< from the root
  const Schema* schema;       ///< nullptr for the head of several variants
  const Key* key = nullptr;   ///< that holds it; nullptr for the root
};

/// All sections, in the order of the schema, each before those inside it.
std::vector<Section> sections_of(const Schema& schema);

/// The smallest example that is allowed, as YAML; what surrounds the section is shown by its keys only.
std::string example_of(const Section& section);

}  // namespace tenon::scene

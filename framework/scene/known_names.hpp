// SPDX-License-Identifier: BSD-3-Clause
// Names in a scene that must be those of parts of a mesh, or of materials.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "framework/scene/value.hpp"

namespace tenon::scene {

/// Complains at `key` unless `entries` (each with a `name` and a `count`; blocks, node sets or side sets of the mesh
/// that comes from `source`, called `what`) has `name`, with something in it.
template <typename Entries>
void check_name(const Value& value, const std::string& key, const std::string& name, const Entries& entries,
                const std::string& what, const std::string& source, Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const auto& entry : entries) {
    if (entry.name == name && entry.count == 0)
      diagnostics.error(value.where(key), key + ": " + what + " '" + name + "' of the mesh " + source + " is empty");
    if (entry.name == name) return;
    names.push_back(entry.name);
  }
  diagnostics.error(value.where(key),
                    key + ": the mesh " + source + " has no " + what + " '" + name + "'" + suggestion(name, names));
}

/// The material that stands under `material`; nullptr, with a complaint, if there is none of this name.
template <typename Material>
const Material* find_material(const Value& value, const std::map<std::string, Material>& materials,
                              Diagnostics& diagnostics) {
  const std::string& name = value.text("material");
  const auto found = materials.find(name);
  if (found != materials.end()) return &found->second;
  std::vector<std::string> names;
  for (const auto& [known, material] : materials) names.push_back(known);
  diagnostics.error(value.where("material"), "material: there is no material '" + name + "'" + suggestion(name, names));
  return nullptr;
}

/// Calls use(entry, from) for each block of the mesh that has a material; `from` is the block's own mapping under
/// `blocks`, or that of the component. Complains about blocks without one, and about names that are none.
template <typename Entries, typename Use>
void each_block(const Value& value, const Entries& entries, const std::string& source, Diagnostics& diagnostics,
                const Use& use) {
  std::map<std::string, Value> own;
  if (value.has("blocks"))
    for (const auto& [name, block] : value.entries("blocks")) own.emplace(name, block);
  std::vector<std::string> names;
  for (const auto& entry : entries) {
    names.push_back(entry.name);
    const auto found = own.find(entry.name);
    if (found != own.end())
      use(entry, found->second);
    else if (value.has("material"))
      use(entry, value);
    else
      diagnostics.error(value.where(), "block '" + entry.name +
                                           "' of the mesh has no material; give 'material' for all blocks or an entry "
                                           "under 'blocks'");
  }
  for (const auto& [name, block] : own)
    if (std::ranges::find(names, name) == names.end())
      diagnostics.error(value.where_name("blocks", name),
                        "blocks: the mesh " + source + " has no block '" + name + "'" + suggestion(name, names));
}

}  // namespace tenon::scene

// SPDX-License-Identifier: BSD-3-Clause
// What reading a block of the scene needs all the time: names checked against the mesh, directions, components.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "components/mechanics/mechanics_options.hpp"
#include "framework/mesh/mesh_data.hpp"
#include "framework/scene/known_names.hpp"

namespace tenon {

/// What reading needs all the time.
struct SceneReader {
  const MeshSummary& mesh;
  scene::Diagnostics& diagnostics;

  void check_name(const scene::Value& value, const std::string& key, const std::string& name,
                  const std::vector<MeshSummary::Entry>& entries, const std::string& what) const {
    scene::check_name(value, key, name, entries, what, mesh.source, diagnostics);
  }

  std::vector<std::string> names(const scene::Value& value, const char* key,
                                 const std::vector<MeshSummary::Entry>& entries, const std::string& what) const {
    if (!value.has(key)) return {};
    const std::vector<std::string> given = value.texts(key);
    for (const std::string& name : given) check_name(value, key, name, entries, what);
    return given;
  }
  std::vector<std::string> node_sets(const scene::Value& value) const {
    return names(value, "node_sets", mesh.node_sets, "node set");
  }
  std::vector<std::string> side_sets(const scene::Value& value) const {
    return names(value, "side_sets", mesh.side_sets, "side set");
  }
  std::vector<std::string> blocks(const scene::Value& value) const {
    return names(value, "blocks", mesh.blocks, "block");
  }

  /// "what of a, b"
  static std::string label(const std::string& what, const std::vector<std::string>& sets) {
    std::string text = what;
    for (const std::string& set : sets) text += (&set == &sets.front() ? " of " : ", ") + set;
    return text;
  }

  std::array<bool, 3> components(const scene::Value& value) const {
    if (!value.has("components")) return {true, true, true};
    std::array<bool, 3> chosen{};
    const std::vector<std::string> names{"x", "y", "z"};
    for (const std::string& c : value.texts("components")) {
      const auto found = std::ranges::find(names, c);
      if (found != names.end())
        chosen[static_cast<std::size_t>(found - names.begin())] = true;
      else
        diagnostics.error(value.where("components"), fmt::format("components: '{}' is not one of x, y, z", c));
    }
    return chosen;
  }

  std::array<double, 9> gradient(const scene::Value& value) const {
    std::array<double, 9> result{};
    if (!value.has("gradient")) return result;
    const std::vector<double> given = value.reals("gradient");
    if (given.size() != 9)
      diagnostics.error(value.where("gradient"),
                        fmt::format("gradient: has {} numbers; expected nine, row by row", given.size()));
    std::copy_n(given.begin(), std::min<std::size_t>(given.size(), 9), result.begin());
    return result;
  }

  Vec3 direction(const scene::Value& value, const std::string& key) const {
    const Vec3 v = value.vector(key);
    if (!(norm(v) > 0)) diagnostics.error(value.where(key), key + ": has no length; expected a direction");
    return norm(v) > 0 ? v : Vec3{0, 0, 1};
  }

  std::vector<scene::Value> items(const scene::Value& value, const char* key) const {
    return value.has(key) ? value.items(key) : std::vector<scene::Value>{};
  }

  PrescribedMotion motion(const scene::Value& value, PrescribedMotion::Kind kind, const std::string& what) const {
    PrescribedMotion m;
    m.kind = kind;
    m.node_sets = node_sets(value);
    m.label = label(what, m.node_sets);
    return m;
  }
};

}  // namespace tenon

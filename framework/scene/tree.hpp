// SPDX-License-Identifier: BSD-3-Clause
// The bare tree of a YAML text, with a place for every key and value; private to this room.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/scene/schema.hpp"
#include "framework/scene/value.hpp"

namespace tenon::scene {

/// Like Where, with the name of the file shared by all places.
struct Place {
  std::shared_ptr<const std::string> file;
  int line = 0, column = 0;
  Where where() const { return {file ? *file : std::string(), line, column}; }
};

/// What is refused before it costs memory or stack.
struct TreeLimits {
  static constexpr std::size_t bytes = 10'000'000;
  static constexpr std::size_t nodes = 2'000'000;  ///< after the expansion of aliases
  static constexpr int depth = 50;
};

struct TreeMember;

/// A scalar, list or mapping as written. Aliases are expanded into copies.
struct TreeNode {
  enum class Kind { null, scalar, list, mapping };
  Kind kind = Kind::null;
  Place place;
  std::string text;                 ///< of a scalar
  std::vector<TreeNode> items;      ///< of a list
  std::vector<TreeMember> members;  ///< of a mapping, in the order of the file, keys unique

  TreeMember* find(const std::string& key);
  const TreeMember* find(const std::string& key) const;
  /// "a list", "a mapping", "'5 m'", "nothing"
  std::string described() const;
};

struct TreeMember {
  std::string key;
  Place place;
  TreeNode value;
};

/// Reads one YAML document. Complains about syntax (one error) and duplicate keys; returns nothing if there is no tree.
/// With `fixed_place` (values of --set) every node gets that place.
std::optional<TreeNode> read_tree(const std::string& text, const std::string& file, const Place* fixed_place,
                                  Diagnostics& diagnostics);

/// Puts the values of --set into the tree.
void apply_overrides(TreeNode& root, const std::vector<Override>& overrides, Diagnostics& diagnostics);

/// Takes the block `parameters` out of the tree and puts the values of `$(formula)` in the place of these formulas.
/// Whether all of them made sense; otherwise `diagnostics` has complaints.
bool apply_parameters(TreeNode& root, Diagnostics& diagnostics);

/// The user's words for a message: quoted, shortened, without control characters.
std::string quoted(const std::string& text);

/// "a, b, c"; shortened if long.
std::string listed(const std::vector<std::string>& words);

}  // namespace tenon::scene

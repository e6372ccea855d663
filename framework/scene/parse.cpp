// SPDX-License-Identifier: BSD-3-Clause
// From the text of a scene to its values.
#include "framework/scene/schema.hpp"
#include "framework/scene/tree.hpp"
#include "framework/scene/validate.hpp"

namespace tenon::scene {

Value parse_scene(const std::string& text, const std::string& file, const std::vector<Override>& overrides,
                  const Schema& schema, Diagnostics& diagnostics) {
  std::optional<TreeNode> root = read_tree(text, file, nullptr, diagnostics);
  if (root) {
    apply_overrides(*root, overrides, diagnostics);
    if (!apply_parameters(*root, diagnostics)) root.reset();
  }
  if (!root) {
    // Complaints about syntax and formulas are enough; validating nothing would only add missing keys.
    auto nothing = std::make_shared<Value::Data>();
    nothing->place = {std::make_shared<const std::string>(file), 1, 1};
    return Value(std::move(nothing));
  }
  if (root->kind == TreeNode::Kind::null) root->kind = TreeNode::Kind::mapping;
  return Validator(diagnostics).mapping(*root, schema, {"", root->place});
}

}  // namespace tenon::scene

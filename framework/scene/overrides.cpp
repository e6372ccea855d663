// SPDX-License-Identifier: BSD-3-Clause
// Puts the values of --set into the tree of the scene, before it is validated.
#include <algorithm>
#include <charconv>

#include "framework/scene/tree.hpp"

namespace tenon::scene {
namespace {

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = path.find('.', begin)) != std::string::npos; begin = end + 1)
    parts.push_back(path.substr(begin, end - begin));
  parts.push_back(path.substr(begin));
  return parts;
}

/// Names begin with letters, so a number is always a place in a list.
std::optional<std::size_t> list_index(const std::string& part) {
  std::size_t index = 0;
  const auto result = std::from_chars(part.data(), part.data() + part.size(), index);
  if (result.ec != std::errc() || result.ptr != part.data() + part.size()) return std::nullopt;
  return index;
}

std::string standing_at(const Place& place) {
  return place.line == 0 ? "" : " (" + to_string(place.where()) + ")";
}

/// One step down; creates what the scene leaves out. Returns nullptr after a complaint. Whether the schema knows the
/// key is found out by the validation, which complains with this same place.
TreeNode* step_into(TreeNode& node, const std::string& part, const Place& place, Diagnostics& diagnostics) {
  const std::optional<std::size_t> index = list_index(part);
  if (node.kind == TreeNode::Kind::null) {
    node.kind = index ? TreeNode::Kind::list : TreeNode::Kind::mapping;
    node.place = place;
  }
  const auto refuse = [&](const std::string& message) {
    diagnostics.error(place.where(), message);
    return nullptr;
  };
  if (node.kind == TreeNode::Kind::scalar)
    return refuse("there is nothing inside the value " + quoted(node.text) + standing_at(node.place) +
                  "; shorten the path");
  if (node.kind == TreeNode::Kind::list) {
    const std::size_t size = node.items.size();
    if (!index)
      return refuse(quoted(part) + " is not a place in the list" + standing_at(node.place) +
                    "; expected a number from 0 to " + std::to_string(size) + " (the last one adds to the list)");
    if (*index > size)
      return refuse("the list" + standing_at(node.place) + " has " + std::to_string(size) +
                    " elements; expected a number from 0 to " + std::to_string(size) +
                    " (the last one adds to the list)");
    if (*index == size) node.items.emplace_back().place = place;
    return &node.items[*index];
  }
  if (TreeMember* member = node.find(part)) return &member->value;
  node.members.push_back({part, place, {}});
  node.members.back().value.place = place;
  return &node.members.back().value;
}

}  // namespace

void apply_overrides(TreeNode& root, const std::vector<Override>& overrides, Diagnostics& diagnostics) {
  for (const Override& change : overrides) {
    const Place place{std::make_shared<const std::string>(change.path), 0, 0};
    const std::vector<std::string> parts = split_path(change.path);
    if (std::find(parts.begin(), parts.end(), std::string()) != parts.end() ||
        parts.size() > static_cast<std::size_t>(TreeLimits::depth)) {
      diagnostics.error(place.where(), quoted(change.path) +
                                           " is not a path; expected keys with dots between them, such as "
                                           "outputs.0.fields");
      continue;
    }
    std::optional<TreeNode> value = read_tree(change.value, "--set", &place, diagnostics);
    if (!value) continue;
    TreeNode* node = &root;
    for (std::size_t i = 0; node != nullptr && i < parts.size(); ++i)
      node = step_into(*node, parts[i], place, diagnostics);
    if (node != nullptr) *node = std::move(*value);
  }
}

}  // namespace tenon::scene

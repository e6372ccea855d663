// SPDX-License-Identifier: BSD-3-Clause
// Checks mappings, lists of mappings and named blocks against their schemas.
#include "framework/scene/validate.hpp"

#include <algorithm>

namespace tenon::scene {
namespace {

std::vector<std::string> key_names(const Schema& schema, bool typed) {
  std::vector<std::string> names;
  if (typed) names.emplace_back("type");
  for (const Key& key : schema.keys())
    if (!typed || key.name != "type") names.push_back(key.name);
  return names;
}

bool is_given(const TreeNode& node, const std::string& key) {
  return node.find(key) != nullptr;
}

std::string quoted_list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "'" : ", '") + word + "'";
  return text;
}

bool is_name(const std::string& word) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto more = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-'; };
  return !word.empty() && letter(word.front()) && std::all_of(word.begin(), word.end(), more);
}

/// A block that the scene leaves out stands for its defaults if nothing in it must be given.
bool may_be_absent(const Schema& schema) {
  const auto needed = [](const Key& key) { return key.required; };
  const auto one_needed = [](const Schema::Group& group) { return group.one_needed; };
  return std::none_of(schema.keys().begin(), schema.keys().end(), needed) &&
         std::none_of(schema.groups().begin(), schema.groups().end(), one_needed);
}

/// Where the name of a block stands; on the command line if its value came from there.
const Place& place_of(const TreeMember& member) {
  return member.value.place.line == 0 ? member.value.place : member.place;
}

}  // namespace

void Validator::complain(const Place& place, const Context& context, const std::string& message) {
  const bool said = context.path.empty() || (place.line == 0 && place.file && *place.file == context.path);
  diagnostics_.error(place.where(), said ? message : context.path + ": " + message);
}

void Validator::unknown_keys(const TreeNode& node, const Schema& schema, const Context& context, bool typed) {
  for (const TreeMember& member : node.members) {
    if (schema.find(member.key) != nullptr || (typed && member.key == "type")) continue;
    complain(member.place, context,
             "unknown key " + quoted(member.key) + suggestion(member.key, key_names(schema, typed)));
  }
}

void Validator::missing_keys(const TreeNode& node, const Schema& schema, const Context& context) {
  std::vector<std::string> misspelt;  // their unknown keys have been reported already
  for (const TreeMember& member : node.members)
    if (schema.find(member.key) == nullptr) misspelt.push_back(nearest_word(member.key, key_names(schema, false)));
  for (const Key& key : schema.keys()) {
    if (!key.required || is_given(node, key.name)) continue;
    if (std::find(misspelt.begin(), misspelt.end(), key.name) != misspelt.end()) continue;
    std::string such_as;
    if (key.type == Key::Type::quantity) {
      const UnitExample example = unit_example(key.unit);
      such_as = ", " + example.name + " such as " + example.example;
    } else if (key.type == Key::Type::choice) {
      such_as = "; valid: " + listed(key.choices);
    }
    complain(context.place, context, "missing key '" + key.name + "' (" + key.doc + ")" + such_as);
  }
}

void Validator::groups(const TreeNode& node, const Schema& schema, const Context& context) {
  for (const Schema::Group& group : schema.groups()) {
    std::vector<const TreeMember*> given;
    for (const TreeMember& member : node.members)
      if (std::find(group.keys.begin(), group.keys.end(), member.key) != group.keys.end()) given.push_back(&member);
    if (given.empty() && group.one_needed)
      complain(context.place, context, "missing key: one of " + quoted_list(group.keys) + " must be given");
    for (std::size_t i = 1; i < given.size(); ++i)
      complain(given[i]->place, context,
               "'" + given[i]->key + "' and '" + given[0]->key + "' exclude each other; give " +
                   (group.one_needed ? "exactly one of " : "at most one of ") + quoted_list(group.keys));
  }
}

Value Validator::mapping(const TreeNode& node, const Schema& schema, const Context& context, const std::string* type) {
  auto data = std::make_shared<Value::Data>();
  data->place = context.place;
  if (type != nullptr) {
    const TreeMember* member = node.find("type");
    data->slots.push_back({"type", true, true, member != nullptr ? member->value.place : context.place, *type});
  }
  data->slots.reserve(schema.keys().size() + 1);
  const bool is_mapping = node.kind == TreeNode::Kind::mapping;
  if (is_mapping) {
    unknown_keys(node, schema, context, type != nullptr);
    missing_keys(node, schema, context);
    groups(node, schema, context);
  } else {
    complain(node.place, context,
             "found " + node.described() + ", expected a mapping with the keys " +
                 listed(key_names(schema, type != nullptr)));
  }
  for (const Key& key : schema.keys()) {
    if (type != nullptr && key.name == "type") continue;
    Value::Data::Slot& slot = data->slots.emplace_back();
    slot.name = key.name;
    if (const TreeMember* member = node.find(key.name)) {
      slot.given = true;
      slot.place = member->value.place;
      slot.content = content(member->value, key, context.inside(key.name, place_of(*member)));
      slot.has = !std::holds_alternative<std::monostate>(slot.content);
    } else {
      slot.content = default_of(key, context);
      slot.has = !key.required && !key.default_value.empty();
    }
  }
  return Value(std::move(data));
}

Validator::Content Validator::default_of(const Key& key, const Context& context) {
  if (key.required) return {};
  if (key.type == Key::Type::object && key.nested && may_be_absent(*key.nested)) {
    TreeNode nothing;
    nothing.kind = TreeNode::Kind::mapping;
    nothing.place = context.place;
    return mapping(nothing, *key.nested, context);
  }
  if (key.default_value.empty()) return {};
  const auto found = defaults_.find(&key);
  if (found != defaults_.end()) return found->second;
  // The schema has checked its defaults when it was built, so nothing can go wrong here.
  const Place place{nullptr, 0, 0};
  const auto tree = read_tree(key.default_value, "default", &place, diagnostics_);
  return defaults_.emplace(&key, tree ? content(*tree, key, {key.name, place}) : Content{}).first->second;
}

/// An entry of a block: of the only schema, or of the one that its `type` chooses.
std::optional<Value> Validator::block(const TreeNode& node, const Key& key, const Context& context) {
  if (key.variants.empty()) return mapping(node, *key.nested, context);
  std::vector<std::string> types;
  for (const auto& [type, schema] : key.variants) types.push_back(type);
  if (node.kind != TreeNode::Kind::mapping) {
    complain(node.kind == TreeNode::Kind::null ? context.place : node.place, context,
             "found " + node.described() + ", expected a mapping with the key 'type'; valid types: " + listed(types));
    return std::nullopt;
  }
  const TreeMember* member = node.find("type");
  if (member == nullptr) {
    complain(context.place, context, "missing key 'type'; valid: " + listed(types));
    return std::nullopt;
  }
  if (member->value.kind != TreeNode::Kind::scalar) {
    complain(member->value.place, context,
             "type: found " + member->value.described() + ", expected one of " + listed(types));
    return std::nullopt;
  }
  const std::string& wanted = member->value.text;
  for (const auto& [type, schema] : key.variants)
    if (type == wanted) return mapping(node, *schema, context, &type);
  complain(member->value.place, context, "unknown type " + quoted(wanted) + suggestion(wanted, types));
  return std::nullopt;
}

Validator::Content Validator::list(const TreeNode& node, const Key& key, const Context& context) {
  if (node.kind != TreeNode::Kind::list) {
    complain(node.place, context, "found " + node.described() + ", expected a list of mappings, each after a '-'");
    return {};
  }
  if (key.required && node.items.empty())
    complain(node.place, context, "the list is empty, expected at least one mapping");
  std::vector<Value> values;
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const TreeNode& item = node.items[i];
    if (const auto value = block(item, key, context.inside(std::to_string(i), item.place))) values.push_back(*value);
  }
  return values;
}

Validator::Content Validator::named(const TreeNode& node, const Key& key, const Context& context) {
  if (node.kind != TreeNode::Kind::mapping) {
    complain(node.place, context, "found " + node.described() + ", expected named blocks, one mapping below each name");
    return {};
  }
  if (key.required && node.members.empty())
    complain(node.place, context, "is empty, expected at least one named block");
  std::vector<NamedBlock> blocks;
  std::vector<std::string> names_in_file;
  for (const TreeMember& member : node.members)
    if (member.place.line != 0) names_in_file.push_back(member.key);
  for (const TreeMember& member : node.members) {
    const Context inside = context.inside(member.key, place_of(member));
    if (!is_name(member.key))
      complain(member.place, context,
               quoted(member.key) + " is not a name; a name is a letter, then letters, digits, '_' and '-'");
    const std::size_t before = diagnostics_.errors().size();
    if (const auto value = block(member.value, key, inside)) blocks.push_back({member.key, member.place, *value});
    if (member.place.line == 0 && diagnostics_.errors().size() > before) {
      const std::string near = nearest_word(member.key, names_in_file);
      if (!near.empty())
        complain(member.place, context, "the scene has no " + quoted(member.key) + ", did you mean '" + near + "'?");
    }
  }
  return blocks;
}

}  // namespace tenon::scene

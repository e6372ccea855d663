// SPDX-License-Identifier: BSD-3-Clause
// Checks single values and lists of them, and converts them to SI.
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "framework/scene/validate.hpp"

namespace tenon::scene {
namespace {

/// What is expected in the place of a key's value.
std::string expected(const Key& key) {
  const UnitExample example = unit_example(key.unit);
  switch (key.type) {
    case Key::Type::quantity:
      return example.name + " such as " + example.example;
    case Key::Type::integer:
      return "a whole number";
    case Key::Type::flag:
      return "true or false";
    case Key::Type::text:
      return "a word or text";
    case Key::Type::choice:
      return "one of " + listed(key.choices);
    case Key::Type::reals:
      return "a list of quantities such as [" + example.example + "]";
    case Key::Type::vector:
      return "three quantities such as [0, 0, " + example.example + "]";
    case Key::Type::texts:
      return "a word or a list of words";
    case Key::Type::function:
      return example.name + " such as " + example.example +
             ", or a function of time: {table: ...}, {sine: ...}, {smooth_step: ...}, {expression: ...}";
    case Key::Type::field_function:
      return example.name + " such as " + example.example +
             ", or a function of time and place: {expression: ...}, {table: ...}, {sine: ...}, {smooth_step: ...}";
    case Key::Type::table:
      return example.name + " such as " + example.example + ", or points [" + key.x_name + ", value]";
    case Key::Type::list:
      return "a list of mappings, each after a '-'";
    case Key::Type::named:
      return "named blocks, one mapping below each name";
    case Key::Type::object:
      return "a mapping with the keys of the block, or {} for all defaults";
    case Key::Type::variants:
      break;
  }
  return "a mapping with the key 'type'";
}

}  // namespace

std::string described(const Range& range, const Conversion& conversion, const std::string& unit) {
  std::string text;
  if (std::isfinite(range.low))
    text = (range.low_open ? "greater than " : "at least ") + with_unit(conversion.from_si(range.low), unit);
  if (std::isfinite(range.high))
    text += (text.empty() ? "" : " and ") + std::string(range.high_open ? "less than " : "at most ") +
            with_unit(conversion.from_si(range.high), unit);
  return text;
}

Validator::Content Validator::content(const TreeNode& node, const Key& key, const Context& context) {
  if (node.kind == TreeNode::Kind::null || (node.kind == TreeNode::Kind::scalar && node.text.empty())) {
    complain(context.place, context, "has no value; expected " + expected(key));
    return {};
  }
  switch (key.type) {
    case Key::Type::reals:
    case Key::Type::vector:
      return reals(node, key, context);
    case Key::Type::texts:
      return texts(node, context);
    case Key::Type::function:
    case Key::Type::field_function:
      return function(node, key, context);
    case Key::Type::table:
      return table(node, key, context);
    case Key::Type::object:
      return mapping(node, *key.nested, context);
    case Key::Type::list:
      return list(node, key, context);
    case Key::Type::named:
      return named(node, key, context);
    case Key::Type::variants: {
      const std::optional<Value> value = block(node, key, context);
      return value ? Content(*value) : Content();
    }
    default:
      return scalar(node, key, context);
  }
}

Validator::Content Validator::scalar(const TreeNode& node, const Key& key, const Context& context) {
  if (node.kind != TreeNode::Kind::scalar) {
    complain(node.place, context, "found " + node.described() + ", expected " + expected(key));
    return {};
  }
  switch (key.type) {
    case Key::Type::integer:
      return integer(node, key, context);
    case Key::Type::flag:
      return flag(node, context);
    case Key::Type::choice:
      return choice(node, key, context);
    case Key::Type::text:
      return node.text;
    default:
      break;
  }
  const std::optional<double> value = quantity(node, key, context);
  return value ? Content(*value) : Content();
}

std::optional<double> Validator::quantity(const TreeNode& node, const Key& key, const Context& context) {
  if (node.kind != TreeNode::Kind::scalar) {
    const UnitExample example = unit_example(key.unit);
    complain(node.place, context,
             "found " + node.described() + ", expected " + example.name + " such as " + example.example);
    return std::nullopt;
  }
  try {
    const Quantity value = read_quantity(node.text, key.unit);
    if (key.range.contains(value.si)) return value.si;
    complain(node.place, context,
             quoted(node.text) + " is out of range; it must be " + described(key.range, value.conversion, value.unit));
  } catch (const std::invalid_argument& wrong) {
    complain(node.place, context, wrong.what());
  }
  return std::nullopt;
}

Validator::Content Validator::integer(const TreeNode& node, const Key& key, const Context& context) {
  const char* begin = node.text.data() + (node.text.front() == '+' ? 1 : 0);
  const char* end = node.text.data() + node.text.size();
  std::int64_t value = 0;
  const auto result = std::from_chars(begin, end, value);
  if (result.ec == std::errc::result_out_of_range) {
    complain(node.place, context, quoted(node.text) + " is too large for a whole number");
  } else if (result.ec != std::errc() || result.ptr != end) {
    complain(node.place, context,
             "found " + node.described() + ", expected a whole number without a unit, such as 100");
  } else if (!key.range.contains(static_cast<double>(value))) {
    complain(node.place, context, quoted(node.text) + " is out of range; it must be " + described(key.range, {}, ""));
  } else {
    return value;
  }
  return {};
}

Validator::Content Validator::flag(const TreeNode& node, const Context& context) {
  for (const char* word : {"true", "yes", "on", "True", "TRUE"})
    if (node.text == word) return true;
  for (const char* word : {"false", "no", "off", "False", "FALSE"})
    if (node.text == word) return false;
  const std::string near = nearest_word(node.text, {"true", "false"});
  complain(node.place, context,
           "found " + node.described() + ", expected true or false" +
               (near.empty() ? "" : ", did you mean '" + near + "'?"));
  return {};
}

Validator::Content Validator::choice(const TreeNode& node, const Key& key, const Context& context) {
  if (std::find(key.choices.begin(), key.choices.end(), node.text) != key.choices.end()) return node.text;
  const std::string near = nearest_word(node.text, key.choices);
  complain(node.place, context,
           quoted(node.text) + " is none of the choices; valid: " + listed(key.choices) +
               (near.empty() ? "" : "; did you mean '" + near + "'?"));
  return {};
}

Validator::Content Validator::reals(const TreeNode& node, const Key& key, const Context& context) {
  if (node.kind != TreeNode::Kind::list) {
    complain(node.place, context, "found " + node.described() + ", expected " + expected(key));
    return {};
  }
  if (key.type == Key::Type::vector && node.items.size() != 3) {
    complain(node.place, context, fmt::format("found {} components, expected {}", node.items.size(), expected(key)));
    return {};
  }
  std::vector<double> values;
  for (const TreeNode& item : node.items)
    if (const auto value = quantity(item, key, context)) values.push_back(*value);
  return values.size() == node.items.size() ? Content(std::move(values)) : Content();
}

Validator::Content Validator::texts(const TreeNode& node, const Context& context) {
  if (node.kind == TreeNode::Kind::scalar) return std::vector<std::string>{node.text};
  if (node.kind != TreeNode::Kind::list) {
    complain(node.place, context, "found " + node.described() + ", expected a word or a list of words");
    return {};
  }
  std::vector<std::string> words;
  for (const TreeNode& item : node.items) {
    if (item.kind == TreeNode::Kind::scalar && !item.text.empty()) {
      words.push_back(item.text);
    } else {
      complain(item.place, context, "found " + item.described() + " in a list of words, expected a word");
    }
  }
  return words;
}

}  // namespace tenon::scene

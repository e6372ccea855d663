// SPDX-License-Identifier: BSD-3-Clause
// Makes the smallest scene text that a section of the schema allows.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/scene/reference.hpp"
#include "framework/scene/units.hpp"

namespace tenon::scene {
namespace {

using Lines = std::vector<std::string>;

Lines block_lines(const Schema& schema, const std::string& type);

Lines indented(const Lines& lines, const std::string& first, const std::string& rest) {
  Lines result;
  for (const std::string& line : lines) result.push_back((result.empty() ? first : rest) + line);
  return result;
}

bool allowed(const std::string& text, const Key& key) {
  try {
    return key.range.contains(read_quantity(text, key.unit).si);
  } catch (const std::invalid_argument&) {
    return false;
  }
}

/// A plausible value inside the range: default, usual example of the unit, or a number between the bounds.
std::string quantity_example(const Key& key) {
  const bool low = std::isfinite(key.range.low), high = std::isfinite(key.range.high);
  const double between = low && high ? 0.5 * (key.range.low + key.range.high)
                         : low       ? key.range.low + std::max(1.0, std::abs(key.range.low))
                         : high      ? key.range.high - std::max(1.0, std::abs(key.range.high))
                                     : 1.0;
  const std::string si = key.unit == temperature_difference ? "K" : key.unit;
  for (const std::string& candidate : {key.default_value, unit_example(key.unit).example})
    if (!candidate.empty() && allowed(candidate, key)) return candidate;
  return with_unit(between, si);
}

std::string integer_example(const Key& key) {
  if (!key.default_value.empty()) return key.default_value;
  for (const double candidate :
       {1.0, 2.0, std::ceil(key.range.low), std::ceil(key.range.low) + 1, std::floor(key.range.high)})
    if (std::isfinite(candidate) && key.range.contains(candidate)) return fmt::format("{:.0f}", candidate);
  return "1";
}

/// The value of a key that fits on its line; empty for blocks.
std::string inline_example(const Key& key) {
  const std::string quantity = key.unit.empty() ? std::string() : quantity_example(key);
  switch (key.type) {
    case Key::Type::quantity:
    case Key::Type::function:
    case Key::Type::field_function:
      return quantity;
    case Key::Type::table:
      return fmt::format("[[{}, {}]]", with_unit(0, key.x_unit), quantity);
    case Key::Type::integer:
      return integer_example(key);
    case Key::Type::flag:
      return key.default_value.empty() ? "true" : key.default_value;
    case Key::Type::text:
      return key.default_value.empty() ? "my_" + key.name : key.default_value;
    case Key::Type::choice:
      return key.default_value.empty() ? key.choices.front() : key.default_value;
    case Key::Type::reals:
      return fmt::format("[{}]", quantity);
    case Key::Type::vector:
      return key.default_value.empty() ? fmt::format("[0, 0, {}]", quantity) : key.default_value;
    case Key::Type::texts:
      return key.default_value.empty() ? fmt::format("[my_{}]", key.name) : key.default_value;
    default:
      return {};
  }
}

/// "my_material" for a block in `materials`.
std::string block_name(const Key& key) {
  const bool plural = key.name.size() > 2 && key.name.back() == 's' && key.name[key.name.size() - 2] != 's';
  const std::size_t ending = key.name.ends_with("shes") ? 2 : 1;  // meshes, but materials
  return "my_" + (plural ? key.name.substr(0, key.name.size() - ending) : key.name);
}

/// The lines of a block below the key that holds it.
Lines held(const Key& key, const Lines& block) {
  if (block.empty()) return {key.name + ": {}"};
  Lines lines{key.name + ":"};
  Lines inside = block;
  if (key.type == Key::Type::named) {
    inside = indented(block, "  ", "  ");
    inside.insert(inside.begin(), block_name(key) + ":");
  }
  const bool list = key.type == Key::Type::list;
  for (const std::string& line : indented(inside, list ? "  - " : "  ", list ? "    " : "  ")) lines.push_back(line);
  return lines;
}

Lines key_lines(const Key& key) {
  const std::string value = inline_example(key);
  if (!value.empty()) return {key.name + ": " + value};
  if (key.variants.empty()) return held(key, block_lines(*key.nested, ""));
  return held(key, block_lines(*key.variants.front().second, key.variants.front().first));
}

/// Required keys, and the first key of every group of which one is needed; if there are none, the first key.
Lines block_lines(const Schema& schema, const std::string& type) {
  Lines lines;
  if (!type.empty()) lines.push_back("type: " + type);
  const auto append = [&](const Key& key) {
    if (!type.empty() && key.name == "type") return;
    for (std::string& line : key_lines(key)) lines.push_back(std::move(line));
  };
  std::vector<std::string> chosen;
  for (const Key& key : schema.keys())
    if (key.required) chosen.push_back(key.name);
  for (const Schema::Group& group : schema.groups()) {
    const auto taken = [&](const std::string& name) {
      return std::find(chosen.begin(), chosen.end(), name) != chosen.end();
    };
    if (group.one_needed && std::none_of(group.keys.begin(), group.keys.end(), taken))
      chosen.push_back(group.keys.front());
  }
  for (const Key& key : schema.keys())
    if (std::find(chosen.begin(), chosen.end(), key.name) != chosen.end()) append(key);
  if (lines.empty() && !schema.keys().empty()) append(schema.keys().front());
  return lines;
}

}  // namespace

std::string example_of(const Section& section) {
  const std::string type = section.frames.empty() ? "" : section.frames.back().type;
  Lines lines = block_lines(*section.schema, type);
  for (std::size_t i = section.frames.size(); i-- > 0;) {
    lines = held(*section.frames[i].key, lines);
    if (i > 0 && !section.frames[i - 1].type.empty())
      lines.insert(lines.begin(), "type: " + section.frames[i - 1].type);
  }
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace tenon::scene

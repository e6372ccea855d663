// SPDX-License-Identifier: BSD-3-Clause
// Functions and tables as a scene writes them.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/scene/expression.hpp"
#include "framework/scene/validate.hpp"

namespace tenon::scene {
namespace {

Schema sine_schema(const Key& key) {
  // An amplitude is a difference: 5 degC would be ambiguous.
  const std::string difference = key.unit == "K" ? std::string(temperature_difference) : key.unit;
  Schema schema("offset + amplitude sin(2 pi t / period + phase)");
  schema.required_quantity("amplitude", difference, "greatest departure from the offset")
      .required_quantity("period", "s", "time of one oscillation", Range::positive())
      .quantity("phase", "rad", "phase at time zero", "0");
  // A mean of zero kelvin is no sensible default.
  if (key.unit == "K") return schema.required_quantity("offset", key.unit, "mean value", key.range);
  return schema.quantity("offset", key.unit, "mean value", "0");
}

Schema smooth_step_schema(const Key& key) {
  Schema schema("quintic step without a jump in the first and second derivative");
  return schema.required_quantity("from", key.unit, "value before the start", key.range)
      .required_quantity("to", key.unit, "value after the end", key.range)
      .quantity("start", "s", "time at which the step begins", "0 s")
      .required_quantity("end", "s", "time at which the step is complete");
}

/// Every key of a form has its value; otherwise there was a complaint.
bool complete(const Value& form, const Schema& schema) {
  return std::all_of(schema.keys().begin(), schema.keys().end(), [&](const Key& key) { return form.has(key.name); });
}

}  // namespace

Schema function_schema(const Key& key) {
  Schema schema("a function of time");
  return schema.reals("table", key.unit, "points [time, value], times ascending")
      .object("sine", sine_schema(key), "harmonic oscillation")
      .object("smooth_step", smooth_step_schema(key), "smooth step")
      .text("expression", "formula in SI")
      .text("unit", "unit of the expression's result")
      .exactly_one({"table", "sine", "smooth_step", "expression"})
      .at_most_one({"unit", "table"})
      .at_most_one({"unit", "sine"})
      .at_most_one({"unit", "smooth_step"});
}

const Schema& Validator::forms_of(const Key& key) {
  const auto found = forms_.find(&key);
  return found != forms_.end() ? found->second : forms_.emplace(&key, function_schema(key)).first->second;
}

/// Points [x, value], x ascending.
std::optional<std::vector<std::pair<double, double>>> Validator::points(const TreeNode& node, const Key& key,
                                                                        const Context& context) {
  Key first;
  first.unit = key.x_unit;
  if (node.kind != TreeNode::Kind::list || node.items.empty()) {
    complain(node.place, context,
             fmt::format("found {}, expected points such as [[{}, {}], ...]",
                         node.kind == TreeNode::Kind::list ? "an empty list" : node.described(),
                         with_unit(0, key.x_unit), unit_example(key.unit).example));
    return std::nullopt;
  }
  std::vector<std::pair<double, double>> points;
  bool good = true;
  for (const TreeNode& row : node.items) {
    if (row.kind != TreeNode::Kind::list || row.items.size() != 2) {
      complain(row.place, context,
               fmt::format(
                   "found {}, expected a point [{}, value]",
                   row.kind == TreeNode::Kind::list ? fmt::format("a list of {}", row.items.size()) : row.described(),
                   key.x_name));
      good = false;
      continue;
    }
    const auto x = quantity(row.items[0], first, context), value = quantity(row.items[1], key, context);
    if (x && !points.empty() && *x <= points.back().first) {
      complain(row.items[0].place, context,
               fmt::format("{0} {1} does not come after {2}; {0}s must ascend", key.x_name, quoted(row.items[0].text),
                           with_unit(points.back().first, key.x_unit)));
      good = false;
    }
    good = good && x && value;
    if (x) points.emplace_back(*x, value.value_or(0));
  }
  return good ? std::optional(std::move(points)) : std::nullopt;
}

Validator::Content Validator::table(const TreeNode& node, const Key& key, const Context& context) {
  if (node.kind == TreeNode::Kind::scalar) {
    const std::optional<double> value = quantity(node, key, context);
    return value ? Content(std::vector<std::pair<double, double>>{{0.0, *value}}) : Content();
  }
  auto made = points(node, key, context);
  return made ? Content(std::move(*made)) : Content();
}

/// `node` holds the keys expression and unit.
std::optional<SpaceTimeFunction> Validator::expression(const TreeNode& node, const Key& key, const Context& context) {
  const TreeMember &text = *node.find("expression"), *const unit = node.find("unit");
  const Context inside = context.inside("expression", text.place);
  try {
    Conversion conversion;
    if (unit != nullptr) {
      if (unit->value.kind != TreeNode::Kind::scalar)
        throw std::invalid_argument("unit: found " + unit->value.described() + ", expected a unit");
      conversion = read_quantity("1 " + unit->value.text, key.unit).conversion;
    }
    if (text.value.kind != TreeNode::Kind::scalar)
      throw std::invalid_argument("found " + text.value.described() +
                                  ", expected a formula such as 4 * exp(-t / 1e-3)");
    SpaceTimeFunction made = parse_field_expression(text.value.text, conversion.scale, conversion.offset);
    if (key.type == Key::Type::function && !made.is_uniform())
      throw std::invalid_argument(
          fmt::format("expression {}: it uses the place (x, y, z), but '{}' takes a function of the time t only",
                      quoted(text.value.text), key.name));
    const double value = made.is_constant() ? made(0, {0, 0, 0}) : 0.0;
    if (made.is_constant() && !(key.range.contains(value) && std::isfinite(value)))
      throw std::invalid_argument(fmt::format("expression {} gives {}, which is out of range; it must be {}",
                                              quoted(text.value.text), with_unit(value, key.unit),
                                              std::isfinite(value) ? described(key.range, {}, key.unit) : "finite"));
    return made;
  } catch (const std::invalid_argument& wrong) {
    complain(text.value.place, inside, wrong.what());
    return std::nullopt;
  }
}

Validator::Content Validator::function(const TreeNode& node, const Key& key, const Context& context) {
  std::optional<SpaceTimeFunction> made = any_function(node, key, context);
  if (!made) return {};
  return key.type == Key::Type::function ? Content(made->in_time()) : Content(std::move(*made));
}

std::optional<SpaceTimeFunction> Validator::any_function(const TreeNode& node, const Key& key, const Context& context) {
  using Made = std::optional<SpaceTimeFunction>;
  if (node.kind != TreeNode::Kind::mapping) {
    const std::optional<double> value = quantity(node, key, context);
    return value ? Made(SpaceTimeFunction::constant(*value)) : Made();
  }
  const Schema& forms = forms_of(key);
  unknown_keys(node, forms, context, false);
  groups(node, forms, context);
  for (const TreeMember& member : node.members) {
    const Context inside = context.inside(member.key, member.place);
    if (member.key == "table") {
      Key over_time = key;
      over_time.x_name = std::string("time"), over_time.x_unit = std::string("s");
      auto made = points(member.value, over_time, inside);
      return made ? Made(TimeFunction::table(std::move(*made))) : Made();
    }
    if (member.key == "expression") return expression(node, key, context);
    if (member.key != "sine" && member.key != "smooth_step") continue;
    const Value form = mapping(member.value, *forms.find(member.key)->nested, inside);
    if (!complete(form, *forms.find(member.key)->nested)) return std::nullopt;
    if (member.key == "sine")
      return Made(
          TimeFunction::sine(form.real("amplitude"), form.real("period"), form.real("phase"), form.real("offset")));
    if (form.real("end") <= form.real("start")) {
      complain(member.place, inside, "'end' must come after 'start'");
      return std::nullopt;
    }
    return Made(TimeFunction::smooth_step(form.real("from"), form.real("to"), form.real("start"), form.real("end")));
  }
  return std::nullopt;
}

}  // namespace tenon::scene

// SPDX-License-Identifier: BSD-3-Clause
// Functions of time as a scene writes them.
#include <fmt/core.h>

#include <algorithm>

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
      .exactly_one({"table", "sine", "smooth_step"});
}

const Schema& Validator::forms_of(const Key& key) {
  const auto found = forms_.find(&key);
  return found != forms_.end() ? found->second : forms_.emplace(&key, function_schema(key)).first->second;
}

std::optional<TimeFunction> Validator::table(const TreeNode& node, const Key& key, const Context& context) {
  if (node.kind != TreeNode::Kind::list || node.items.empty()) {
    complain(node.place, context,
             "found " + (node.kind == TreeNode::Kind::list ? "an empty list" : node.described()) +
                 ", expected points such as [[0 s, " + unit_example(key.unit).example + "], ...]");
    return std::nullopt;
  }
  Key time;
  time.unit = "s";
  std::vector<std::pair<double, double>> points;
  bool good = true;
  for (const TreeNode& row : node.items) {
    if (row.kind != TreeNode::Kind::list || row.items.size() != 2) {
      complain(
          row.place, context,
          "found " +
              (row.kind == TreeNode::Kind::list ? fmt::format("a list of {}", row.items.size()) : row.described()) +
              ", expected a point [time, value]");
      good = false;
      continue;
    }
    const auto t = quantity(row.items[0], time, context), value = quantity(row.items[1], key, context);
    if (t && !points.empty() && *t <= points.back().first) {
      complain(row.items[0].place, context,
               fmt::format("time {} does not come after {} s; times must ascend", quoted(row.items[0].text),
                           points.back().first));
      good = false;
    }
    good = good && t && value;
    if (t) points.emplace_back(*t, value.value_or(0));
  }
  return good ? std::optional(TimeFunction::table(std::move(points))) : std::nullopt;
}

Validator::Content Validator::function(const TreeNode& node, const Key& key, const Context& context) {
  if (node.kind != TreeNode::Kind::mapping) {
    const std::optional<double> value = quantity(node, key, context);
    return value ? Content(TimeFunction::constant(*value)) : Content();
  }
  const Schema& forms = forms_of(key);
  unknown_keys(node, forms, context, false);
  groups(node, forms, context);
  for (const TreeMember& member : node.members) {
    const Context inside = context.inside(member.key, member.place);
    if (member.key == "table") {
      const auto made = table(member.value, key, inside);
      return made ? Content(*made) : Content();
    }
    if (member.key != "sine" && member.key != "smooth_step") continue;
    const Value form = mapping(member.value, *forms.find(member.key)->nested, inside);
    if (!complete(form, *forms.find(member.key)->nested)) return {};
    if (member.key == "sine")
      return TimeFunction::sine(form.real("amplitude"), form.real("period"), form.real("phase"), form.real("offset"));
    if (form.real("end") <= form.real("start")) {
      complain(member.place, inside, "'end' must come after 'start'");
      return {};
    }
    return TimeFunction::smooth_step(form.real("from"), form.real("to"), form.real("start"), form.real("end"));
  }
  return {};
}

}  // namespace tenon::scene

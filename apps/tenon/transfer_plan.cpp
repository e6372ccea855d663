// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/transfer_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "framework/base/error.hpp"
#include "framework/scene/schema.hpp"
#include "framework/scene/value.hpp"

namespace tenon {

namespace {

using transfer::Method;
using transfer::OutsidePolicy;

template <typename T>
using Names = std::vector<std::pair<std::string, T>>;

const Names<Method>& methods() {
  static const Names<Method> all{{"automatic", Method::automatic},
                                 {"interpolate", Method::interpolate},
                                 {"nearest_projection", Method::nearest_projection},
                                 {"conserve", Method::conserve},
                                 {"project", Method::project},
                                 {"moving_least_squares", Method::moving_least_squares},
                                 {"copy", Method::copy}};
  return all;
}

const Names<FieldKind>& kinds() {
  static const Names<FieldKind> all{
      {"point_value", FieldKind::point_value}, {"density", FieldKind::density}, {"total", FieldKind::total}};
  return all;
}

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ExitCode::usage, what);
}

template <typename T>
T named(const Names<T>& all, const std::string& word, const std::string& option, const std::string& what) {
  std::vector<std::string> words;
  for (const auto& [name, value] : all) {
    if (name == word) return value;
    words.push_back(name);
  }
  refuse(fmt::format("{}: there is no {} '{}'{}", option, what, word, scene::suggestion(word, words)));
}

double quantity(const std::string& text, const std::string& unit, const std::string& option) {
  try {
    return scene::parse_quantity(text, unit);
  } catch (const std::invalid_argument& problem) {
    refuse(option + ": " + problem.what());
  }
}

/// "mm" or "0.5 mm" in m.
double length(const std::string& text, const std::string& option) {
  const bool number = !text.empty() && (std::isdigit(static_cast<unsigned char>(text[0])) != 0 || text[0] == '.');
  const double metres = quantity(number ? text : "1 " + text, "m", option);
  if (!(metres > 0)) refuse(option + ": expected a length above 0");
  return metres;
}

/// "name:word" -> both; the word is empty without a colon. A field of the source may have a colon in its name.
std::pair<std::string, std::string> parted(const std::string& text, const std::vector<std::string>& fields) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || std::ranges::find(fields, text) != fields.end()) return {text, ""};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

/// What fields of these names are where nothing is said: amounts, and amounts per volume. All others are point values.
const Names<FieldKind>& standard_kinds() {
  static const Names<FieldKind> all = [] {
    Names<FieldKind> names;
    for (const char* name : {"density", "mass_density", "energy_density", "internal_energy_density",
                             "strain_energy_density", "plastic_work_density", "heat_source_density"})
      names.emplace_back(name, FieldKind::density);
    for (const char* name :
         {"mass", "lumped_mass", "nodal_mass", "volume", "force", "internal_force", "external_force", "contact_force",
          "reaction_force", "heat", "plastic_heat", "internal_energy", "kinetic_energy", "strain_energy", "momentum"})
      names.emplace_back(name, FieldKind::total);
    return names;
  }();
  return all;
}

FieldKind kind_of(const std::string& name, Method method) {
  for (const auto& [standard, kind] : standard_kinds())
    if (standard == name) return kind;
  // Who asks for an unknown field to be conserved has an amount.
  return method == Method::conserve ? FieldKind::total : FieldKind::point_value;
}

OutsidePolicy outside_policy(const std::string& text, double& value) {
  if (text.starts_with("value=")) {
    const std::string number = text.substr(6);
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error != std::errc{} || end != number.data() + number.size())
      refuse(fmt::format("--outside: '{}' is not a number; write --outside value=0", number));
    return OutsidePolicy::value;
  }
  const Names<OutsidePolicy> all{{"nearest", OutsidePolicy::nearest},
                                 {"extrapolate", OutsidePolicy::extrapolate},
                                 {"value=X", OutsidePolicy::value},
                                 {"error", OutsidePolicy::error}};
  if (text == "value" || text == "value=X") refuse("--outside value needs the value: --outside value=0");
  return named(all, text, "--outside", "policy");
}

PlannedField planned(const TransferArguments& arguments, const FieldData& stored, const std::string& method) {
  const std::string& name = stored.description.name;
  if (!stored.missing.empty())
    refuse(fmt::format("--fields: '{}' has no values on {} of {}", name, stored.missing, arguments.source));
  const Names<Location> places{{"nodes", Location::node}, {"elements", Location::element}};
  PlannedField field;
  field.method = method.empty() ? named(methods(), arguments.method, "--method", "method")
                                : named(methods(), method, "--fields " + name, "method");
  field.description = stored.description;
  field.description.kind = kind_of(name, field.method);
  field.to = arguments.at.empty() ? stored.description.location : named(places, arguments.at, "--at", "place");
  return field;
}

std::string output_path(const TransferArguments& arguments) {
  namespace fs = std::filesystem;
  const bool by_default = arguments.output.empty();
  const std::string output = by_default ? fs::path(arguments.target).stem().string() + ".fields.vtu" : arguments.output;
  const std::string extension = fs::path(output).extension().string();
  if (extension != ".vtu" && extension != ".pvtu")
    refuse(fmt::format("--output: '{}' ends neither as .vtu (one file) nor as .pvtu (a piece for each rank)", output));
  // By their names only: every rank comes here, and files need not be there for all.
  const auto named = [](const std::string& path) { return fs::absolute(path).lexically_normal(); };
  for (const std::string& input : {arguments.source, arguments.target})
    if (named(input) == named(output))
      refuse(fmt::format("--output: {}'{}' would replace the input; give another name",
                         by_default ? "the default " : "", output));
  return output;
}

}  // namespace

std::string method_name(transfer::Method method) {
  for (const auto& [name, value] : methods())
    if (value == method) return name;
  return "";
}

std::string method_names() {
  std::string text;
  for (const auto& [name, value] : methods()) text += (text.empty() ? "" : ", ") + name;
  return text;
}

TransferSettings transfer_settings(const TransferArguments& arguments) {
  TransferSettings settings;
  settings.options.outside = outside_policy(arguments.outside, settings.options.outside_value);
  if (!arguments.greatest_distance.empty()) {
    settings.options.greatest_distance = quantity(arguments.greatest_distance, "m", "--greatest-distance");
    if (!(settings.options.greatest_distance >= 0)) refuse("--greatest-distance: expected no less than 0 m");
  }
  settings.options.bounded = arguments.bounded;
  settings.options.neighbours = arguments.neighbours;
  if (arguments.neighbours < 4 || arguments.neighbours > 64)
    refuse(fmt::format("--neighbours: {} is not between 4 and 64", arguments.neighbours));
  if (arguments.time != "last") settings.state.time = quantity(arguments.time, "s", "--time");
  settings.source_unit = length(arguments.source_unit, "--source-unit");
  settings.target_unit = length(arguments.target_unit, "--target-unit");
  named(methods(), arguments.method, "--method", "method");
  settings.output = output_path(arguments);
  return settings;
}

bool PlannedField::shares_map(const PlannedField& other) const {
  return description.location == other.description.location && description.kind == other.description.kind &&
         to == other.to && method == other.method;
}

std::vector<PlannedField> plan_fields(const TransferArguments& arguments, const std::vector<FieldData>& fields) {
  if (fields.empty()) refuse(fmt::format("{}: has no fields to transfer", arguments.source));
  std::vector<std::string> names;
  for (const FieldData& field : fields) names.push_back(field.description.name);
  const auto index = [&](const std::string& name, const char* option) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
      refuse(fmt::format("{}: {} has no field '{}'{}", option, arguments.source, name, scene::suggestion(name, names)));
    return static_cast<std::size_t>(found - names.begin());
  };
  std::vector<PlannedField> plan;
  const auto add = [&](std::size_t stored, const std::string& method) {
    if (std::ranges::any_of(plan, [&](const PlannedField& p) { return p.stored == stored; })) return;
    plan.push_back(planned(arguments, fields[stored], method));
    plan.back().stored = stored;
  };
  for (const std::string& text : arguments.fields) {
    const auto [name, method] = parted(text, names);
    add(index(name, "--fields"), method);
  }
  if (arguments.fields.empty())
    for (std::size_t stored = 0; stored < fields.size(); ++stored) add(stored, "");
  const auto collides = [&](const PlannedField& field) {
    const auto same = [&](const PlannedField& p) {
      return p.description.name == field.description.name && p.to == field.to;
    };
    const std::string& name = field.description.name;
    return std::ranges::count_if(plan, same) > 1 ||
           (arguments.status && (name == "transfer_status" || name == "transfer_distance"));
  };
  for (const PlannedField& field : plan)
    if (collides(field))
      refuse(
          fmt::format("--fields: two fields would be called '{}' in the output; choose fields by name, or leave out "
                      "--at or --status",
                      field.description.name));
  for (const std::string& text : arguments.kinds) {
    const auto [name, kind] = parted(text, {});
    if (kind.empty()) refuse(fmt::format("--kind: '{}' is not of the form NAME:KIND, as heat:total", text));
    index(name, "--kind");
    const FieldKind value = named(kinds(), kind, "--kind " + text, "kind");
    for (PlannedField& field : plan)
      if (field.description.name == name) field.description.kind = value;
  }
  return plan;
}

}  // namespace tenon

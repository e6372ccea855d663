// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/study_plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "apps/tenon/load_scene.hpp"
#include "apps/tenon/scene_schema.hpp"
#include "apps/tenon/study_arguments.hpp"

namespace tenon {

namespace {

namespace fs = std::filesystem;
using scene::Diagnostics;
using scene::Schema;
using scene::Value;

constexpr std::size_t most_runs = 10000;

Schema history_schema() {
  Schema s("A number from a column of history.csv.");
  s.text("column", "Column of history.csv, as `max_eqps` or the name of a point history.").required();
  s.choice("take", {"last", "maximum", "minimum", "at"}, "Which value of the column.", "last");
  s.quantity("time", "s", "Time of `take: at`; linear between the rows.");
  s.text("reference",
         "Value to compare with: a number in SI, or an expression of the time `t` (end, or time of the value) and the "
         "names of the varied keys. Without it the value is compared with the Richardson extrapolation of the finest "
         "runs.");
  return s;
}

Schema field_schema() {
  Schema s("A field at the end of the run against an exact solution: relative L2 norm and greatest error.");
  add_shown_field(s);
  s.choice("part", {"value", "x", "y", "z", "xx", "yy", "zz", "xy", "yz", "zx"},
           "Component of a vector or tensor; `value` for a scalar.", "value");
  s.text("exact", "Exact solution in SI: an expression of t, x, y, z (place in the undeformed body).").required();
  return s;
}

/// Letters that are safe in names of folders.
std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool keep = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' ||
                      c == '-' || c == '+' || c == '_';
    if (keep)
      result += c;
    else if (!result.empty() && result.back() != '_')
      result += '_';
  }
  return result;
}

/// "axial" of "meshes.bar.axial"; "elements" of "meshes.bar.elements.0".
std::string last_word(const std::string& key) {
  std::string rest = key;
  for (;;) {
    const std::size_t point = rest.rfind('.');
    std::string word = point == std::string::npos ? rest : rest.substr(point + 1);
    const bool number = !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
    if (!number || point == std::string::npos) return word;
    rest.resize(point);
  }
}

std::vector<StudyVariation> read_variations(const Value& study, bool grid, Diagnostics& diagnostics) {
  std::vector<StudyVariation> vary;
  for (const Value& item : study.items("vary")) {
    StudyVariation v{item.text("key"), item.has("name") ? item.text("name") : last_word(item.text("key")),
                     item.texts("values")};
    if (v.values.empty()) diagnostics.error(item.where("values"), "values: is empty, expected at least one value");
    for (const StudyVariation& other : vary) {
      if (other.name == v.name)
        diagnostics.error(item.where(), "vary: the name '" + v.name + "' is taken; give another by the key `name`");
      if (!grid && other.values.size() != v.values.size())
        diagnostics.error(item.where("values"),
                          fmt::format("values: {} of '{}', but {} of '{}'; keys that vary in step need as many values "
                                      "each (or set `grid: true` for all combinations)",
                                      v.values.size(), v.name, other.values.size(), other.name));
    }
    vary.push_back(std::move(v));
  }
  return vary;
}

/// Makes something of an expression; complains at the key.
template <typename Make>
void parse(const Value& block, const std::string& key, Diagnostics& diagnostics, const Make& make) {
  try {
    make(block.text(key));
  } catch (const std::invalid_argument& problem) {
    diagnostics.error(block.where(key), key + ": " + problem.what());
  }
}

/// Complains about values that a formula uses and that are no numbers.
void check_values(const scene::Expression& formula, const Value& block, const std::string& key,
                  const std::vector<StudyVariation>& vary, Diagnostics& diagnostics) {
  for (const StudyVariation& v : vary)
    for (const std::string& value : v.values)
      if (formula.uses(v.name) && !scene::number_in_si(value))
        diagnostics.error(block.where(key), fmt::format("{}: uses '{}', whose value '{}' is not a number, with or "
                                                        "without a unit",
                                                        key, v.name, value));
}

StudyQuantity read_quantity(const std::string& name, const Value& block, const std::vector<StudyVariation>& vary,
                            const std::vector<std::string>& names, Diagnostics& diagnostics) {
  StudyQuantity q;
  q.name = name;
  q.is_field = block.text("type") == "field";
  if (q.is_field) {
    if (block.has("component")) q.component = block.text("component");
    q.field = block.text("field");
    q.part = block.text("part");
    parse(block, "exact", diagnostics, [&](const std::string& text) { q.exact = scene::parse_field_expression(text); });
    return q;
  }
  q.column = block.text("column");
  const std::string& take = block.text("take");
  q.take = take == "maximum"   ? StudyQuantity::Take::maximum
           : take == "minimum" ? StudyQuantity::Take::minimum
           : take == "at"      ? StudyQuantity::Take::at
                               : StudyQuantity::Take::last;
  if (block.has("time")) q.time = block.real("time");
  if ((take == "at") != block.has("time"))
    diagnostics.error(block.where(), "time: is needed with `take: at`, and only with it");
  std::vector<std::string> variables{"t"};
  variables.insert(variables.end(), names.begin(), names.end());
  if (block.has("reference"))
    parse(block, "reference", diagnostics,
          [&](const std::string& text) { q.reference = scene::Expression(text, variables); });
  if (q.reference) check_values(*q.reference, block, "reference", vary, diagnostics);
  return q;
}

std::vector<double> numbers_of(const StudyRun& run) {
  std::vector<double> numbers;
  for (const std::string& value : run.values)
    numbers.push_back(scene::number_in_si(value).value_or(std::numeric_limits<double>::quiet_NaN()));
  return numbers;
}

/// Every run takes one value of every variation: in step, or all combinations with the last variation running fastest.
std::vector<StudyRun> make_runs(const StudyPlan& plan, const std::vector<std::string>& settings) {
  std::size_t count = plan.grid ? 1 : plan.vary.front().values.size();
  if (plan.grid)
    for (const StudyVariation& v : plan.vary) count = std::min(count * v.values.size(), most_runs + 1);
  if (count > most_runs)
    throw Error(ExitCode::usage, fmt::format("the study has more than {} runs; vary fewer values", most_runs));
  std::vector<StudyRun> runs(count);
  std::set<std::string> folders;
  for (std::size_t r = 0; r < count; ++r) {
    StudyRun& run = runs[r];
    run.settings = settings;
    run.values.resize(plan.vary.size());
    std::size_t rest = r;
    for (std::size_t v = plan.vary.size(); v-- > 0;) {
      const std::vector<std::string>& values = plan.vary[v].values;
      run.values[v] = values[plan.grid ? rest % values.size() : r];
      rest /= values.size();
    }
    for (std::size_t v = 0; v < plan.vary.size(); ++v) {
      run.settings.push_back(plan.vary[v].key + "=" + run.values[v]);
      if (v > 0) run.folder += '_';
      run.folder += plain(plan.vary[v].name + "-" + run.values[v]);
    }
    run.numbers = numbers_of(run);
    if (run.folder.size() > 120) run.folder.resize(120);
    const std::string base = run.folder;
    for (int n = 2; !folders.insert(run.folder).second; ++n) run.folder = fmt::format("{}~{}", base, n);
  }
  return runs;
}

void check_sizes(const StudyPlan& plan, const Value& study, Diagnostics& diagnostics) {
  if (!plan.size) return;
  for (const StudyRun& run : plan.runs)
    if (const double size = (*plan.size)(run.numbers); !(size > 0) || !std::isfinite(size))
      diagnostics.error(study.where("size"), fmt::format("size: is {} for the run '{}'; expected more than 0 (values "
                                                         "with units count in SI)",
                                                         size, run.folder));
}

/// Every scene of the study is read before the first one runs: a key that does not exist is found at once.
void check_scenes(const Communicator& comm, const StudyPlan& plan) {
  std::set<std::string> complaints;
  std::string text;
  for (const StudyRun& run : plan.runs) {
    try {
      load_scene(comm, plan.scene, parse_overrides(run.settings));
    } catch (const Error& error) {
      if (error.code() != ExitCode::usage) throw;
      if (!complaints.insert(error.what()).second) continue;
      if (!text.empty()) text += '\n';
      text += error.what();
    }
  }
  if (!text.empty()) throw Error(ExitCode::usage, text);
}

}  // namespace

Schema study_schema() {
  Schema vary("A key of the scene and its values.");
  vary.text("key", "Path of the key, as `meshes.bar.axial`; a number in it is a place in a list, counted from 0.")
      .required();
  vary.texts("values", "Values as they would stand in the scene.").required();
  vary.text("name", "Name in expressions, folders and tables. Without it: the last word of the key.");
  Schema s("A study: one scene, run for each of several values.");
  s.text("title", "One line that says what is studied.");
  s.text("scene", "Path of the scene, relative to the study's folder.").required();
  s.list("vary", vary, "What varies, several keys in step.").required();
  s.flag("grid", "All combinations of the values instead of keys in step; the last key runs fastest.", "false");
  s.texts("settings", "Further changes of the scene, as `end_time=5 us`, for every run.");
  s.text("size",
         "Size h of the elements or steps that the error belongs to: an expression of the names of the varied keys, as "
         "`1/axial`. Without it: the mean element size, (volume / elements)^(1/3).");
  s.flag("frames", "Also write the frames of every run for ParaView.", "false");
  s.variants("quantities", scene::Key::Type::named, {{"history", history_schema()}, {"field", field_schema()}},
             "What is measured, by name.")
      .required();
  return s;
}

StudyPlan load_study(const Communicator& comm, const StudyArguments& arguments) {
  const StudyText text = study_text(comm, arguments);
  Diagnostics diagnostics;
  const Value study = scene::parse_scene(text.text, text.file, {}, study_schema(), diagnostics);
  diagnostics.throw_if_any();
  StudyPlan plan;
  const fs::path base = text.from_command_line ? fs::path() : fs::path(arguments.file).parent_path();
  plan.scene = (base / study.text("scene")).string();
  plan.title = study.has("title") ? study.text("title") : "study of " + plan.scene;
  plan.folder = arguments.folder.empty() ? fs::path(arguments.file).stem().string() + ".results" : arguments.folder;
  if (text.from_command_line && arguments.folder.empty())
    plan.folder = fs::path(arguments.file).stem().string() + ".study";
  plan.grid = study.flag("grid") || arguments.grid;
  plan.frames = study.flag("frames");
  plan.picture = arguments.picture;
  plan.vary = read_variations(study, plan.grid, diagnostics);
  std::vector<std::string> names;
  for (const StudyVariation& v : plan.vary) names.push_back(v.name);
  if (study.has("size"))
    parse(study, "size", diagnostics, [&](const std::string& t) { plan.size = scene::Expression(t, names); });
  if (plan.size) check_values(*plan.size, study, "size", plan.vary, diagnostics);
  for (const auto& [name, block] : study.entries("quantities"))
    plan.quantities.push_back(read_quantity(name, block, plan.vary, names, diagnostics));
  diagnostics.throw_if_any();
  std::vector<std::string> settings = study.texts("settings");
  settings.insert(settings.end(), arguments.settings.begin(), arguments.settings.end());
  plan.runs = make_runs(plan, settings);
  check_sizes(plan, study, diagnostics);
  diagnostics.throw_if_any();
  check_scenes(comm, plan);
  return plan;
}

}  // namespace tenon

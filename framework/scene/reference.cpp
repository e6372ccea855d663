// SPDX-License-Identifier: BSD-3-Clause
// Writes the scene reference from the schema.
#include "framework/scene/reference.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "framework/base/error.hpp"
#include "framework/scene/tree.hpp"
#include "framework/scene/units.hpp"
#include "framework/scene/validate.hpp"

namespace tenon::scene {
namespace {

constexpr const char* introduction = R"text(# Scene reference

A scene is a YAML file. It is checked as a whole before any work: unknown and missing keys, wrong dimensions and values out
of range are all reported together, each with its file, line and column.

**Units.** A quantity is a number with its unit: `density: 8930 kg/m^3`, `youngs_modulus: 117 GPa`, `end_time: 80 us`,
`conductivity: 386 W/(m K)`, `temperature: 20 degC`. A number without a unit is SI. Every unit that UDUNITS-2 knows is
accepted if it has the dimension that the tables below state. Differences of temperature, "K (difference)", are given in K,
since 5 degC would be a point on a scale.

**Functions of time.** A key of the type "function" holds a quantity (constant in time), or one of

```yaml
velocity: {table: [[0 s, 0 m/s], [2 us, 4 m/s], [5 us, 0 m/s]]}  # linear between the points, constant outside
velocity: {sine: {amplitude: 4 m/s, period: 1 ms, phase: 90 degree, offset: 1 m/s}}
velocity: {smooth_step: {from: 0 m/s, to: 4 m/s, start: 0 s, end: 5 us}}  # without a jump in the acceleration
velocity: {expression: 4 * exp(-t / 1e-3), unit: m/s}
```

The sine is offset + amplitude sin(2 pi t / period + phase). The phase is 0 and the start 0 s if left out; so is the
offset, but not that of a temperature. The times of a table ascend. In an expression all is SI: `t` is the time in s, and
where the type is "function of place" `x`, `y`, `z` are the place in the undeformed body in m. The result is in the SI unit
of the key, or in `unit`. It has `+ - * / ^`, comparisons, `&& ||`, `condition ? a : b`, `pi` and the functions sin, cos,
tan, asin, acos, atan, sinh, cosh, tanh, asinh, acosh, atanh, exp, ln (also as log), log10, sqrt, abs, erf, erfc, floor,
ceil, round, step (0 below zero, 1 from zero on), sign, atan2(y, x), pow, mod, min, max (of two) and bessel_j(whole order, x);
with a comma inside it stands in quotes. The range of the key is not checked where it varies.

**Tables.** A key of the type "table" holds points over something else than time, such as
`[[0, 400 MPa], [0.1, 450 MPa]]`, ascending in the first column; a quantity alone is one point at zero.

**Names.** Named blocks (materials and the like) bear names of your choice: a letter, then letters, digits, `_` and `-`.
Anchors, aliases and merge keys of YAML (`&name`, `*name`, `<<: *name`) save repetition.

**Changes from the command line.** `--set key.path=value` replaces or adds a value: `--set end_time="5 us"`. The path has
a dot between keys and names; a number, counted from 0, is an entry of a list.

**Parameters.** A scene may begin with numbers of its own, which `$(formula)` then stands for anywhere in its values:

```yaml
parameters: {doublings: 0, spacing: 2 mm}
meshes:
  bar: {type: box, high: [$(10*spacing) m, 10 mm, 10 mm], elements: [$(5*2^doublings), 5, 5]}
```

One `--set parameters.doublings=3` then changes all that hangs on it. A quantity is seen by formulas in SI. A parameter
may itself be a formula of those above it. Formulas are those of functions of time, without t, x, y, z.

)text";

void collect(const Schema& schema, const Section& around, std::vector<Section>& sections) {
  const std::string prefix = around.path.empty() ? "" : around.path + ".";
  for (const Key& key : schema.keys()) {
    Section section{prefix + key.name, around.frames, key.nested.get(), &key};
    section.frames.push_back({&key, ""});
    if (key.nested) {
      sections.push_back(section);
      collect(*key.nested, section, sections);
    } else if (!key.variants.empty()) {
      sections.push_back(section);
      for (const auto& [type, variant] : key.variants) {
        Section inner{section.path + "." + type, section.frames, variant.get(), &key};
        inner.frames.back().type = type;
        sections.push_back(inner);
        collect(*variant, inner, sections);
      }
    }
  }
}

/// The anchors that GitHub makes of the headings: lower case without dots, numbered if they repeat.
std::map<std::string, std::string> anchors_of(const std::vector<Section>& sections) {
  std::map<std::string, std::string> anchors;
  std::map<std::string, int> used;
  for (const Section& section : sections) {
    std::string anchor;
    for (const char c : section.path)
      if (c != '.') anchor += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const int before = used[anchor]++;
    anchors[section.path] = before == 0 ? anchor : fmt::format("{}-{}", anchor, before);
  }
  return anchors;
}

/// What would break a table cell.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|') result += '\\';
    result += c == '\n' ? ' ' : c;
  }
  return result;
}

std::string code(const std::string& text) {
  return text.empty() ? std::string() : fmt::format("`{}`", cell(text));
}

std::string code_list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + code(word);
  return text;
}

std::string unit_text(const Key& key) {
  if (key.unit == "1") return "number";
  return key.unit == temperature_difference ? "K (difference)" : key.unit;
}

std::string type_text(const Key& key, const std::string& link) {
  switch (key.type) {
    case Key::Type::quantity:
      return unit_text(key);
    case Key::Type::integer:
      return "whole number";
    case Key::Type::flag:
      return "true or false";
    case Key::Type::text:
      return "text";
    case Key::Type::choice:
      return "one of " + code_list(key.choices);
    case Key::Type::reals:
      return "list, " + unit_text(key);
    case Key::Type::vector:
      return "three components, " + unit_text(key);
    case Key::Type::texts:
      return "word or list of words";
    case Key::Type::function:
      return "function, " + unit_text(key);
    case Key::Type::field_function:
      return "function of place, " + unit_text(key);
    case Key::Type::table:
      return fmt::format("table, {} over {}{}", unit_text(key), key.x_name, key.x_unit == "1" ? "" : ", " + key.x_unit);
    case Key::Type::object:
    case Key::Type::variants:
      return "[block](#" + link + ")";
    case Key::Type::list:
      return "[list of blocks](#" + link + ")";
    case Key::Type::named:
      break;
  }
  return "[named blocks](#" + link + ")";
}

class Writer {
 public:
  explicit Writer(const std::vector<Section>& sections) : sections_(sections), anchors_(anchors_of(sections)) {}

  std::string contents() const {
    std::string text = "## Contents\n\n";
    for (const Section& section : sections_) {
      const std::string indent(2 * (depth(section) - 1), ' ');
      text += fmt::format("{}- [`{}`](#{})\n", indent, section.path, anchors_.at(section.path));
    }
    return text + "\n";
  }

  std::string root(const Schema& schema) const {
    return "## The scene\n\n" + schema.doc() + "\n\n" + keys({"", {}, &schema}) + example({"", {}, &schema});
  }

  std::string section(const Section& section) const {
    const std::string marks(std::min<std::size_t>(depth(section) + 1, 6), '#');
    std::string text = fmt::format("{} `{}`\n\n", marks, section.path);
    if (section.schema == nullptr) return text + section.key->doc + "\n\n" + types(section);
    const std::string& type = section.frames.back().type;
    if (type.empty()) {
      text += section.key->doc + "\n\n";
      if (section.key->type == Key::Type::named) text += "Named blocks; each has these keys:\n\n";
      if (section.key->type == Key::Type::list) text += "A list; each entry has these keys:\n\n";
    } else {
      text += section.schema->doc() + "\n\nWith `type: " + type + "`:\n\n";
    }
    return text + keys(section) + example(section);
  }

 private:
  static std::size_t depth(const Section& section) {
    return static_cast<std::size_t>(std::count(section.path.begin(), section.path.end(), '.')) + 1;
  }

  std::string types(const Section& head) const {
    const char* container = head.key->type == Key::Type::named  ? "Named blocks; the key `type` of each"
                            : head.key->type == Key::Type::list ? "A list; the key `type` of each entry"
                                                                : "A block; its key `type`";
    std::string text = fmt::format("{} says what it is:\n\n| `type` | Meaning |\n|---|---|\n", container);
    for (const auto& [type, schema] : head.key->variants)
      text += fmt::format("| [`{}`](#{}) | {} |\n", type, anchors_.at(head.path + "." + type), cell(schema->doc()));
    return text + "\n";
  }

  std::string keys(const Section& section) const {
    if (section.schema->keys().empty()) return "It has no keys of its own.\n\n";
    std::string text = "| Key | Type or unit | Default | Range | Required | Meaning |\n|---|---|---|---|---|---|\n";
    for (const Key& key : section.schema->keys()) {
      const auto link = anchors_.find(section.path.empty() ? key.name : section.path + "." + key.name);
      const std::string unit = key.type == Key::Type::integer       ? ""
                               : key.unit == temperature_difference ? "K"
                                                                    : key.unit;
      text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", code(key.name),
                          type_text(key, link == anchors_.end() ? "" : link->second), code(key.default_value),
                          described(key.range, {}, unit), key.required ? "yes" : "", cell(key.doc));
    }
    text += "\n";
    for (const Schema::Group& group : section.schema->groups())
      text += (group.one_needed ? "Exactly one of " : "At most one of ") + code_list(group.keys) +
              (group.one_needed ? " must be given.\n\n" : " can be given.\n\n");
    return text;
  }

  std::string example(const Section& section) const { return "```yaml\n" + example_of(section) + "```\n\n"; }

  const std::vector<Section>& sections_;
  std::map<std::string, std::string> anchors_;
};

/// The path that the user means: as given, or the only one that ends with it.
std::string find_path(const std::vector<Section>& sections, const std::string& wanted) {
  std::vector<std::string> paths, endings;
  for (const Section& section : sections) {
    if (section.path == wanted) return wanted;
    paths.push_back(section.path);
    const std::string end = "." + wanted;
    if (section.path.size() > end.size() &&
        section.path.compare(section.path.size() - end.size(), end.size(), end) == 0)
      endings.push_back(section.path);
  }
  if (endings.size() == 1) return endings.front();
  if (!endings.empty())
    throw Error(ExitCode::usage, "the scene reference has several sections " + quoted(wanted) + ": " + listed(endings));
  std::string near = nearest_word(wanted, paths);
  if (near.empty()) {
    // The last word may be near that of a nested section.
    std::vector<std::string> last_words;
    for (const std::string& path : paths) last_words.push_back(path.substr(path.rfind('.') + 1));
    const auto at = std::find(last_words.begin(), last_words.end(), nearest_word(wanted, last_words));
    if (at != last_words.end()) near = paths[static_cast<std::size_t>(at - last_words.begin())];
  }
  throw Error(ExitCode::usage, "the scene reference has no section " + quoted(wanted) +
                                   (near.empty() ? "; valid: " + listed(paths) : ", did you mean '" + near + "'?"));
}

}  // namespace

std::vector<Section> sections_of(const Schema& schema) {
  std::vector<Section> sections;
  collect(schema, {"", {}, &schema}, sections);
  return sections;
}

std::string scene_reference(const Schema& schema, const std::string& section) {
  const std::vector<Section> sections = sections_of(schema);
  const Writer writer(sections);
  std::string text;
  if (section.empty()) {
    text = introduction + writer.contents() + writer.root(schema);
    for (const Section& each : sections) text += writer.section(each);
  } else {
    const std::string path = find_path(sections, section);
    for (const Section& each : sections)
      if (each.path == path || each.path.compare(0, path.size() + 1, path + ".") == 0) text += writer.section(each);
  }
  text.pop_back();  // one line end is enough at the end of a file
  return text;
}

}  // namespace tenon::scene

// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/study_arguments.hpp"

#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/tenon/load_scene.hpp"

namespace tenon {

namespace {

using Json = nlohmann::ordered_json;  // JSON is YAML, and quotes whatever was written

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

Json variation(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw Error(ExitCode::usage, "--vary " + text + ": expected key.path=value,value,... as meshes.bar.axial=20,40,80");
  return {{"key", text.substr(0, equals)}, {"values", split_values(text.substr(equals + 1))}};
}

/// "column", "column:maximum", "column:at 10 us"; "component.field.part" or "field" with an exact solution.
std::pair<std::string, Json> quantity(const std::string& text, const StudyArguments& arguments) {
  std::string name;
  for (const char c : text) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (!arguments.exact.empty()) {
    std::vector<std::string> words;
    std::istringstream rest(text);
    for (std::string word; std::getline(rest, word, '.');) words.push_back(word);
    if (words.empty() || words.size() > 3)
      throw Error(ExitCode::usage, "--quantity " + text + ": expected field, field.part or component.field.part");
    Json q{{"type", "field"}, {"exact", arguments.exact}};
    if (words.size() == 3) q["component"] = words[0];
    q["field"] = words[words.size() == 3 ? 1 : 0];
    if (words.size() > 1) q["part"] = words.back();
    return {name, q};
  }
  const std::size_t colon = text.find(':');
  Json q{{"type", "history"}, {"column", trimmed(text.substr(0, colon))}};
  if (colon != std::string::npos) {
    const std::string take = trimmed(text.substr(colon + 1));
    const bool at = take.rfind("at ", 0) == 0;
    q["take"] = at ? "at" : take;
    if (at) q["time"] = trimmed(take.substr(3));
  }
  if (!arguments.reference.empty()) q["reference"] = arguments.reference;
  return {name, q};
}

}  // namespace

std::vector<std::string> split_values(const std::string& text) {
  std::vector<std::string> values;
  std::string value;
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (c == quote)
      quote = 0;
    else if (quote == 0 && (c == '"' || c == '\''))
      quote = c;
    else if (quote == 0 && (c == '[' || c == '{' || c == '('))
      ++depth;
    else if (quote == 0 && (c == ']' || c == '}' || c == ')'))
      --depth;
    if (c == ',' && depth <= 0 && quote == 0) {
      values.push_back(trimmed(value));
      value.clear();
    } else {
      value += c;
    }
  }
  values.push_back(trimmed(value));
  return values;
}

StudyText study_text(const Communicator& comm, const StudyArguments& arguments) {
  const std::string text = read_scene_text(comm, arguments.file);
  const bool own = !arguments.vary.empty() || !arguments.quantities.empty();
  if (is_study(text)) {
    if (own)
      throw Error(ExitCode::usage, arguments.file +
                                       ": is a study already; --vary and --quantity go with a scene (put them into the "
                                       "study's `vary` and `quantities`)");
    return {text, arguments.file, false};
  }
  if (arguments.vary.empty() || arguments.quantities.empty())
    throw Error(ExitCode::usage, arguments.file +
                                     ": is not a study (it has no `vary`); for a scene say what varies and what is "
                                     "measured, as --vary meshes.bar.axial=20,40,80 --quantity max_eqps");
  Json study{{"scene", arguments.file}, {"vary", Json::array()}, {"quantities", Json::object()}};
  for (const std::string& v : arguments.vary) study["vary"].push_back(variation(v));
  for (const std::string& q : arguments.quantities) {
    auto [name, block] = quantity(q, arguments);
    study["quantities"][name] = std::move(block);
  }
  if (!arguments.size.empty()) study["size"] = arguments.size;
  return {study.dump(), "command line", true};
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Numbers that a scene defines for itself, and the formulas of them in its values.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "framework/scene/expression.hpp"
#include "framework/scene/tree.hpp"

namespace tenon::scene {
namespace {

/// The parameters so far.
struct Parameters {
  std::vector<std::string> names;
  std::vector<double> values;
  std::vector<char> used;  ///< by a formula
};

/// Where the parenthesis that opens at `begin` closes; npos if it does not.
std::size_t closing(const std::string& text, std::size_t begin) {
  int depth = 0;
  for (std::size_t i = begin; i < text.size(); ++i) {
    if (text[i] == '(') ++depth;
    if (text[i] == ')' && --depth == 0) return i;
  }
  return std::string::npos;
}

/// Puts values in the place of formulas; the shortest text that reads back as the same number.
void substitute(TreeNode& node, Parameters& known, Diagnostics& diagnostics) {
  std::string result;
  std::size_t at = 0;
  for (std::size_t begin; (begin = node.text.find("$(", at)) != std::string::npos;) {
    const std::size_t end = closing(node.text, begin + 1);
    if (end == std::string::npos)
      return diagnostics.error(node.place.where(), quoted(node.text) + ": '$(' has no ')' that closes it");
    const std::string formula = node.text.substr(begin + 2, end - begin - 2);
    double value = 0;
    try {
      const Expression expression(formula, known.names);
      value = expression(known.values);
      for (std::size_t i = 0; i < known.names.size(); ++i) known.used[i] |= expression.uses(known.names[i]) ? 1 : 0;
    } catch (const std::invalid_argument& error) {
      return diagnostics.error(node.place.where(), "$(" + formula + "): " + error.what());
    }
    if (!std::isfinite(value))
      return diagnostics.error(node.place.where(),
                               fmt::format("$({}) is {}, expected a finite number", formula, value));
    // Never "1e+06", so that what counts something stays a whole number.
    const bool whole = value == std::floor(value) && std::abs(value) < 1e15;
    result += node.text.substr(at, begin - at) + (whole ? fmt::format("{:.0f}", value) : fmt::format("{}", value));
    at = end + 1;
  }
  node.text = result + node.text.substr(at);
}

void substitute_below(TreeNode& node, Parameters& known, Diagnostics& diagnostics) {
  if (node.kind == TreeNode::Kind::scalar) substitute(node, known, diagnostics);
  for (TreeNode& item : node.items) substitute_below(item, known, diagnostics);
  for (TreeMember& member : node.members) substitute_below(member.value, known, diagnostics);
}

bool is_name(const std::string& text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return !text.empty() && letter(text[0]) &&
         std::all_of(text.begin(), text.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

/// A name that nothing uses is a mistyped one.
void complain_of_unused(const Parameters& known, const std::vector<Place>& places, Diagnostics& diagnostics) {
  std::vector<std::string> used;
  for (std::size_t i = 0; i < known.names.size(); ++i)
    if (known.used[i]) used.push_back(known.names[i]);
  for (std::size_t i = 0; i < known.names.size(); ++i)
    if (!known.used[i])
      diagnostics.error(places[i].where(), "parameters." + known.names[i] + ": no formula uses it" +
                                               (used.empty() ? "" : suggestion(known.names[i], used)));
}

}  // namespace

bool apply_parameters(TreeNode& root, Diagnostics& diagnostics) {
  const TreeMember* const block = root.find("parameters");
  if (block == nullptr) return true;
  const std::size_t before = diagnostics.errors().size();
  Parameters known;
  if (block->value.kind != TreeNode::Kind::mapping)
    diagnostics.error(block->place.where(), "parameters: found " + block->value.described() +
                                                ", expected a mapping of names to numbers, such as {n: 4}");
  std::vector<Place> places;
  for (TreeMember member : block->value.members) {
    const auto complain = [&](const std::string& message) {
      diagnostics.error(member.value.place.where(), "parameters." + member.key + ": " + message);
    };
    if (!is_name(member.key)) {
      complain("a name has letters, digits and _ and begins with a letter");
      continue;
    }
    substitute(member.value, known, diagnostics);
    const std::optional<double> value =
        member.value.kind == TreeNode::Kind::scalar ? number_in_si(member.value.text) : std::nullopt;
    if (!value) complain("found " + member.value.described() + ", expected a number or a quantity such as 2 mm");
    // Known all the same, so that formulas with it bring no complaints of their own.
    known.names.push_back(member.key);
    known.values.push_back(value.value_or(1));
    known.used.push_back(0);
    places.push_back(member.place);
  }
  std::erase_if(root.members, [](const TreeMember& member) { return member.key == "parameters"; });
  substitute_below(root, known, diagnostics);
  if (diagnostics.errors().size() == before) complain_of_unused(known, places, diagnostics);
  return diagnostics.errors().size() == before;
}

}  // namespace tenon::scene

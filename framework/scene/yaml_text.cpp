// SPDX-License-Identifier: BSD-3-Clause
// Bytes, columns and messages of YAML text.
#include "framework/scene/yaml_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "framework/scene/tree.hpp"

namespace tenon::scene {
namespace {

bool continues_letter(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

/// Length of the UTF-8 letter at `at`, 0 if it is none.
std::size_t letter_length(std::string_view text, std::size_t at) {
  const auto lead = static_cast<unsigned char>(text[at]);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xC2 && lead < 0xE0   ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0 || at + length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if (!continues_letter(text[at + i])) return 0;
  return length;
}

/// Brackets that open one after the other cost the parser its time and stack; a quoted text of that kind is no scene
/// either.
struct BracketRun {
  int length = 0;
  bool too_long(char c) {
    if (c == '[' || c == '{') {
      ++length;
    } else if (c != ' ' && c != '\n' && c != '\r' && c != '\t') {
      length = 0;
    }
    return length > TreeLimits::depth;
  }
};

}  // namespace

LineIndex::LineIndex(std::string_view text) : starts_{0} {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') starts_.push_back(i + 1);
    if (continues_letter(text[i])) continuations_.push_back(i);
  }
  if (starts_.size() > 1 && starts_.back() == text.size()) starts_.pop_back();
}

int LineIndex::column(int line, int bytes) const {
  if (line < 0 || line >= count()) return bytes + 1;
  const std::size_t begin = starts_[static_cast<std::size_t>(line)];
  const auto first = std::lower_bound(continuations_.begin(), continuations_.end(), begin);
  const auto last = std::lower_bound(first, continuations_.end(), begin + static_cast<std::size_t>(std::max(bytes, 0)));
  return 1 + bytes - static_cast<int>(last - first);
}

std::optional<TextFault> fault_in_bytes(std::string_view text) {
  if (text.size() > TreeLimits::bytes)
    return TextFault{1, 1,
                     fmt::format("the scene has {} bytes, at most {} are read; large data belong into mesh files",
                                 text.size(), TreeLimits::bytes)};
  int line = 1, column = 1;
  BracketRun run;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    const auto byte = static_cast<unsigned char>(c);
    const std::size_t length = letter_length(text, at);
    const bool control = (byte < 0x20 && c != '\n' && c != '\r' && c != '\t') || byte == 0x7F;
    if (length == 0 || control)
      return TextFault{line, column, fmt::format("byte 0x{:02x} is not text; a scene is a UTF-8 text file", byte)};
    if (run.too_long(c))
      return TextFault{line, column, fmt::format("more than {} brackets open at once", TreeLimits::depth)};
    at += length;
    ++column;
    if (c == '\n') ++line, column = 1;
  }
  return std::nullopt;
}

std::string plain_words(const std::string& message) {
  // Beginnings of the messages of yaml-cpp.
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 21> words{{
      {"illegal map value", "a ':' that belongs to no key (is a quote missing, or the indentation wrong?)"},
      {"illegal map key", "a key cannot stand here (is the indentation wrong?)"},
      {"illegal block entry", "a '-' of a list cannot stand here (is the indentation wrong?)"},
      {"end of map flow not found", "a '{' without its '}' or ','"},
      {"end of sequence flow not found", "a '[' without its ']' or ','"},
      {"end of map not found", "this line does not fit the block above (is the indentation wrong, or a ':' missing?)"},
      {"end of sequence not found",
       "this line does not fit the list above (is the indentation wrong, or a '-' missing?)"},
      {"illegal tab", "a tab in the indentation; use spaces"},
      {"illegal flow end", "a ']' or '}' that nothing opened"},
      {"illegal EOF in scalar", "a quote that opens here or above is never closed"},
      {"illegal document indicator in scalar", "a line '---' or '...' inside quotes"},
      {"illegal character in scalar", "a character that cannot stand in a value; put the value in quotes"},
      {"unknown token", "a character that cannot begin a value; put the value in quotes"},
      {"unknown escape character", "an unknown escape after '\\'; write '\\\\' for a backslash or use single quotes"},
      {"the referenced anchor is not defined", "an alias ('*name') whose anchor ('&name') is not defined above"},
      {"alias not found after *", "a '*' without a name; put the value in quotes if it is no alias"},
      {"anchor not found after &", "a '&' without a name; put the value in quotes if it is no anchor"},
      {"illegal character found while scanning al", "a character that cannot stand in the name of an alias"},
      {"illegal character found while scanning an", "a character that cannot stand in the name of an anchor"},
      {"aliases can't have any content", "a value after an alias; an alias stands alone"},
      {"bad file", "blocks are nested too deeply"},
  }};
  for (const auto& [begin, plain] : words)
    if (message.compare(0, begin.size(), begin) == 0) return "YAML syntax: " + std::string(plain);
  return "YAML syntax: " + message;
}

}  // namespace tenon::scene

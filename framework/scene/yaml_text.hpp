// SPDX-License-Identifier: BSD-3-Clause
// What is looked at in YAML text besides its meaning: bytes, columns and the parser's messages; private to this room.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tenon::scene {

/// Translates the parser's byte columns into columns of letters, as editors count them.
class LineIndex {
 public:
  explicit LineIndex(std::string_view text);
  int count() const { return static_cast<int>(starts_.size()); }
  /// 1-based column of the letter `bytes` after the begin of the 0-based `line`.
  int column(int line, int bytes) const;

 private:
  std::vector<std::size_t> starts_;         ///< first byte of each line
  std::vector<std::size_t> continuations_;  ///< bytes that begin no letter
};

struct TextFault {
  int line, column;
  std::string message;
};

/// The first thing that no scene contains and the parser should not see: too many bytes, bytes that are not UTF-8 text,
/// brackets nested without end.
std::optional<TextFault> fault_in_bytes(std::string_view text);

/// The parser's complaint in words for someone who does not know YAML's grammar.
std::string plain_words(const std::string& message);

}  // namespace tenon::scene

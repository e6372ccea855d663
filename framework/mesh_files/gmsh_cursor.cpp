// SPDX-License-Identifier: BSD-3-Clause
// A place in the text or bytes of a Gmsh file, which reads one checked value after another.
#include "framework/mesh_files/gmsh_cursor.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include "framework/mesh_files/read_support.hpp"

namespace tenon::mesh_file {
namespace {

constexpr std::size_t longest_number = 64;

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

/// Part of the file as it may be shown in a message.
std::string shown(std::string_view text) {
  std::string out(1, '\'');
  return out.append(printable(text.substr(0, 40))).append(text.size() > 40 ? "...'" : "'");
}

}  // namespace

void GmshCursor::refuse_here(const std::string& what) const {
  std::string where;
  if (binary_)
    where = "byte " + std::to_string(at_);
  else
    where = "line " + std::to_string(1 + std::count(contents_.begin(),
                                                    contents_.begin() + static_cast<std::ptrdiff_t>(at_), '\n'));
  if (!section_.empty()) where += " in $" + printable(section_);
  refuse(path_ + ":" + where, what);
}

void GmshCursor::skip_space() {
  while (at_ < contents_.size() && is_space(contents_[at_])) ++at_;
}

std::string_view GmshCursor::token(const char* what) {
  skip_space();
  const std::size_t start = at_;
  while (at_ < contents_.size() && !is_space(contents_[at_])) ++at_;
  if (start == at_) refuse_here(std::string("the file ends (truncated?), expected ") + what);
  return std::string_view(contents_).substr(start, at_ - start);
}

std::string GmshCursor::next_section() {
  section_.clear();
  skip_space();
  if (at_ == contents_.size()) return "";
  const std::string_view word = token("a section");
  if (word.size() < 2 || word.front() != '$' || word.starts_with("$End"))
    refuse_here("expected the start of a section such as $Nodes, found " + shown(word));
  section_ = word.substr(1);
  if (section_.size() > longest_number) refuse_here("the name of a section is too long: " + shown(word));
  finish_line();
  return section_;
}

void GmshCursor::end_section(const std::string& name) {
  const std::string_view word = token(("$End" + name).c_str());
  if (word != "$End" + name) refuse_here("expected $End" + name + ", found " + shown(word));
  section_.clear();
}

void GmshCursor::skip_section(const std::string& name) {
  const std::string mark = "$End" + name;
  std::size_t end = at_;
  do {
    const std::size_t found = contents_.find(mark, end);
    if (found == std::string::npos) refuse_here("there is no " + printable(mark) + " (truncated?)");
    end = found + mark.size();
  } while (end < contents_.size() && !is_space(contents_[end]));  // the name may be the start of a longer one
  at_ = end;
  finish_line();
  section_.clear();
}

void GmshCursor::finish_line() {
  while (at_ < contents_.size() && contents_[at_] != '\n') {
    if (!is_space(contents_[at_])) refuse_here("expected the end of the line");
    ++at_;
  }
  if (at_ < contents_.size()) ++at_;
}

std::int64_t GmshCursor::text_integer(const char* what) {
  const std::string_view word = token(what);
  std::string_view digits = word;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size())
    refuse_here(std::string("expected ") + what + " (a whole number), found " + shown(word));
  return value;
}

double GmshCursor::text_real(const char* what) {
  const std::string_view word = token(what);
  std::string_view digits = word;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range && digits.size() < longest_number) {
    // Too small is zero or denormal, too large is infinite and refused as such later.
    value = std::strtod(std::string(digits).c_str(), nullptr);
    error = std::errc();
  }
  if (error != std::errc() || end != digits.data() + digits.size())
    refuse_here(std::string("expected ") + what + " (a number), found " + shown(word));
  return value;
}

std::int32_t GmshCursor::raw_integer32(const char* what) {
  return raw<std::int32_t>(what);
}

std::int32_t GmshCursor::integer32(const char* what) {
  if (binary_) return raw<std::int32_t>(what);
  const std::int64_t value = text_integer(what);
  if (value != static_cast<std::int32_t>(value)) refuse_here(std::string("impossible ") + what);
  return static_cast<std::int32_t>(value);
}

std::int64_t GmshCursor::integer64(const char* what) {
  return binary_ ? raw<std::int64_t>(what) : text_integer(what);
}

double GmshCursor::real(const char* what) {
  return binary_ ? raw<double>(what) : text_real(what);
}

std::int64_t GmshCursor::count(const char* what, std::size_t bytes, std::size_t fields) {
  const std::int64_t value = integer64(what);
  require_room(value, what, bytes, fields);
  return value;
}

void GmshCursor::require_room(std::int64_t count, const char* what, std::size_t bytes, std::size_t fields) const {
  // A number in a text takes a digit and a separator at least.
  const std::size_t each = std::max<std::size_t>(binary_ ? bytes : 2 * fields, 1);
  if (count < 0 || static_cast<std::uint64_t>(count) > (contents_.size() - at_ + 1) / each)
    refuse_here(std::string("impossible ") + what + " " + std::to_string(count) +
                ": the rest of the file cannot hold as many");
}

std::string GmshCursor::quoted_text(const char* what) {
  skip_space();
  const std::size_t start = at_;
  const std::size_t line_end = std::min(contents_.find('\n', start), contents_.size());
  const std::size_t close = contents_.rfind('"', line_end);
  if (start == contents_.size() || contents_[start] != '"' || close == std::string::npos || close <= start)
    refuse_here(std::string("expected ") + what + " in double quotes");
  at_ = close + 1;
  return printable(std::string_view(contents_).substr(start + 1, close - start - 1));
}

}  // namespace tenon::mesh_file

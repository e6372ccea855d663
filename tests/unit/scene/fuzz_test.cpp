// SPDX-License-Identifier: BSD-3-Clause
// Whatever the text: parse_scene returns, quickly, with values or complaints.
#include <gtest/gtest.h>

#include <ctime>
#include <random>

#include "rich_schema.hpp"

namespace tenon::testing {
namespace {

/// CPU time, which a busy machine does not stretch.
double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines{""};
  for (const char c : text) {
    lines.back() += c;
    if (c == '\n') lines.emplace_back();
  }
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line;
  return text;
}

/// One random edit of the kinds that hands, editors and disks make.
std::string edited(std::string text, std::mt19937& random) {
  static const std::vector<std::string> tokens{
      "!", "!!x ", "&a ",  "*a",    "*copper", "[",         "]",     "{",  "}",   "? ", "- ",           ": ",
      "|", ">",    "\t",   "---\n", "...\n",   "%YAML 9\n", "\"",    "'",  "#",   ",",  "\n",           "  ",
      "@", "`",    "<<: ", "null",  "~",       "nan",       "1e999", "-1", "5 m", "°C", "\xef\xbb\xbf", "type"};
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  const std::size_t at = below(text.size());
  std::vector<std::string> lines = lines_of(text);
  const std::size_t line = below(lines.size()), other = below(lines.size());
  switch (below(9)) {
    case 0:
      text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
      return text;
    case 1:
      text.erase(at, 1);
      return text;
    case 2:
      text.erase(at, 1 + below(40));
      return text;
    case 3:
      text.insert(at, 1, static_cast<char>(random() & 0xFFU));
      return text;
    case 4:
      text.insert(at, tokens[below(tokens.size())]);
      return text;
    case 5:
      text.replace(at, std::min<std::size_t>(1 + below(8), text.size() - at), tokens[below(tokens.size())]);
      return text;
    case 6:
      std::swap(lines[line], lines[other]);
      return joined(lines);
    case 7:
      lines[line].insert(0, std::string(1 + below(4), ' '));
      return joined(lines);
    default:
      lines[line].erase(0, std::min<std::size_t>(1 + below(4), lines[line].size()));
      return joined(lines);
  }
}

/// Parses; fails the test on a throw or if it takes over a second. Returns the number of complaints.
std::size_t parse_safely(const std::string& text, const std::vector<scene::Override>& overrides = {}) {
  static const scene::Schema schema = rich_schema();
  scene::Diagnostics diagnostics;
  const double begin = cpu_seconds();
  EXPECT_NO_THROW(scene::parse_scene(text, "s", overrides, schema, diagnostics)) << text;
  const double seconds = cpu_seconds() - begin;
  EXPECT_LT(seconds, 1.0) << text.substr(0, 2000);
  for (const std::string& error : diagnostics.errors()) {
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_TRUE(error.compare(0, 2, "s:") == 0 || error.compare(0, 6, "--set ") == 0 ||
                error.compare(0, 6, "--set:") == 0)
        << error;
  }
  return diagnostics.errors().size();
}

TEST(Fuzz, TwoThousandSingleEdits) {
  int refused = 0;
  for (unsigned seed = 0; seed < 2000; ++seed) {
    std::mt19937 random(seed);
    if (parse_safely(edited(good_scene, random)) > 0) ++refused;
  }
  // Edits of comments and of numbers leave a good scene; most others do not.
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 1950);
}

TEST(Fuzz, ManyEditsAtOnce) {
  int refused = 0;
  for (unsigned seed = 0; seed < 500; ++seed) {
    std::mt19937 random(100000 + seed);
    std::string text = good_scene;
    for (int i = 0; i < 20; ++i) text = edited(text + " ", random);
    if (parse_safely(text) > 0) ++refused;
  }
  EXPECT_GT(refused, 490);
}

TEST(Fuzz, TruncatedScenes) {
  const std::string text = good_scene;
  for (std::size_t length = 0; length < text.size(); ++length) parse_safely(text.substr(0, length));
}

TEST(Fuzz, Garbage) {
  const std::string letters = "abz019 \n\n:-[]{},&*!|>'\"%@#?\t.\\<~";
  for (unsigned seed = 0; seed < 500; ++seed) {
    std::mt19937 random(200000 + seed);
    std::string bytes, marks;
    for (unsigned i = 0; i < 1 + random() % 500; ++i) {
      bytes += static_cast<char>(random() & 0xFFU);
      marks += letters[random() % letters.size()];
    }
    EXPECT_GT(parse_safely(bytes), 0U);
    EXPECT_GT(parse_safely(marks), 0U);
  }
}

TEST(Fuzz, Overrides) {
  const std::vector<std::string> parts{
      "components", "body",  "boundary", "0",        "99",     "",      "materials", "copper",
      "velocity",   "table", "1",        "end_time", "output", "times", "-1",        "18446744073709551616",
      "ä",          "<<"};
  const std::vector<std::string> values{"",     "5 m",  "[",       "{a: 1}", "[1, 2, 3]", "*copper",
                                        "null", "\xff", "x: y: z", "- 1",    "!!a b"};
  for (unsigned seed = 0; seed < 1000; ++seed) {
    std::mt19937 random(300000 + seed);
    std::vector<scene::Override> overrides(1 + random() % 3);
    for (scene::Override& change : overrides) {
      for (unsigned i = 0; i < 1 + random() % 5; ++i)
        change.path += (i == 0 ? "" : ".") + parts[random() % parts.size()];
      change.value = values[random() % values.size()];
    }
    parse_safely(good_scene, overrides);
  }
}

}  // namespace
}  // namespace tenon::testing

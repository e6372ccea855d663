// SPDX-License-Identifier: BSD-3-Clause
// Text that is no YAML, or more than a scene may be.
#include <gtest/gtest.h>

#include <ctime>
#include <sstream>

#include "rich_schema.hpp"

namespace tenon::testing {
namespace {

/// CPU time, which a busy machine does not stretch.
double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

using Errors = std::vector<std::string>;

TEST(Syntax, OneComplaintInPlainWords) {
  EXPECT_EQ(complaints("end_time: 1 s\ncomponents: {a: 1\n"),
            (Errors{"3:1: YAML syntax: a '{' without its '}' or ','"}));
  EXPECT_EQ(complaints("end_time: [1 s\n"), (Errors{"2:1: YAML syntax: a '[' without its ']' or ','"}));
  EXPECT_EQ(
      complaints("end_time: 1: 2\n"),
      (Errors{"1:12: YAML syntax: a ':' that belongs to no key (is a quote missing, or the indentation wrong?)"}));
  EXPECT_EQ(
      complaints("end_time: 1\n  components: 2\n"),
      (Errors{"2:13: YAML syntax: a ':' that belongs to no key (is a quote missing, or the indentation wrong?)"}));
  EXPECT_EQ(complaints("a: *b\n"),
            (Errors{"1:4: YAML syntax: an alias ('*name') whose anchor ('&name') is not defined above"}));
}

TEST(Syntax, AnEmptySceneMissesItsKeys) {
  for (const char* text : {"", "\n\n", "# nothing\n", "---\n", "~"}) {
    const Errors errors = complaints(text);
    ASSERT_EQ(errors.size(), 2U) << text;
    EXPECT_NE(errors[0].find("missing key 'end_time'"), std::string::npos) << errors[0];
    EXPECT_NE(errors[1].find("missing key 'components'"), std::string::npos) << errors[1];
  }
}

TEST(Syntax, BytesThatAreNoText) {
  EXPECT_EQ(complaints(std::string("end_time: 1\0 s", 14)),
            (Errors{"1:12: byte 0x00 is not text; a scene is a UTF-8 text file"}));
  EXPECT_EQ(complaints("a: b\nµ: \xff"), (Errors{"2:4: byte 0xff is not text; a scene is a UTF-8 text file"}));
  EXPECT_EQ(complaints("a: \xc3"), (Errors{"1:4: byte 0xc3 is not text; a scene is a UTF-8 text file"}));
  EXPECT_EQ(complaints("a: \x1b[31m"), (Errors{"1:4: byte 0x1b is not text; a scene is a UTF-8 text file"}));
}

TEST(Syntax, LineEndsAndByteOrderMarkOfOtherSystems) {
  std::string text;
  for (const char c : std::string(good_scene)) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(complaints(text), Errors{});
  EXPECT_EQ(complaints(std::string("\xef\xbb\xbf").append(good_scene)), Errors{});
}

TEST(Syntax, OneDocumentWithPlainKeysAndNoTags) {
  EXPECT_EQ(complaints("end_time: 1\n---\nend_time: 2\n"),
            (Errors{"2:1: text after the end of the scene; a scene is one YAML document"}));
  EXPECT_EQ(complaints("? [a, b]\n: 3\n"),
            (Errors{"1:3: found a list in the place of a key; expected a word, then ':'"}));
  EXPECT_EQ(complaints(": 3\n"), (Errors{"1:1: found nothing in the place of a key; expected a word, then ':'"}));
  EXPECT_EQ(complaints("end_time: !!float 3\n"),
            (Errors{"1:11: a YAML tag 'tag:yaml.org,2002:float'; scenes use no tags, remove it"}));
  EXPECT_EQ(complaints("a: &a {b: *a}\n"), (Errors{"1:11: an alias inside the block that it names"}));
  EXPECT_EQ(complaints("<<: 3\n"), (Errors{"1:5: found '3' after '<<'; expected an alias of a mapping"}));
}

TEST(Syntax, DeepNestingIsRefusedQuickly) {
  for (const std::string part : {"[", "{", "[ ", "{a: ", "[a, ", "- ", "? ", ": ", "[[\n"}) {
    std::string text;
    while (text.size() < 300'000) text += part;
    const double begin = cpu_seconds();
    EXPECT_EQ(complaints(text).size(), 1U) << part;
    EXPECT_LT(cpu_seconds() - begin, 2.0) << part;
  }
  std::string text;
  for (int depth = 0; depth < 60; ++depth) text += std::string(static_cast<std::size_t>(depth), ' ') + "a:\n";
  EXPECT_EQ(complaints(text), (Errors{"51:51: blocks are nested more than 50 deep; a scene needs fewer than ten"}));
}

TEST(Syntax, AliasBombsAreRefused) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 12; ++i) {
    std::ostringstream line;
    line << "a" << i << ": &a" << i << " [*a" << i - 1;
    for (int k = 1; k < 10; ++k) line << ", *a" << i - 1;
    text += line.str() + "]\n";
  }
  const Errors errors = complaints(text);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NE(errors[0].find("more than 2000000 values"), std::string::npos) << errors[0];
}

TEST(Syntax, HugeFilesAreRefused) {
  const Errors errors = complaints(std::string(10'000'001, '#'));
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0],
            "1:1: the scene has 10000001 bytes, at most 10000000 are read; large data belong into mesh files");
}

TEST(Syntax, TwoMegabytesTakeAboutASecond) {
  std::string text = "end_time: 1\ncomponents: {i: {type: idle}}\nmaterials:\n";
  for (int i = 0; text.size() < 1'000'000; ++i)
    text += "  m" + std::to_string(i) + ":\n    type: elastic\n    density: 8930 kg/m^3\n    youngs_modulus: 117 GPa\n";
  // All on one line.
  text += "output: {times: [";
  for (const std::size_t end = text.size() + 1'000'000; text.size() < end;) text += "1 µs, ";
  text += "1]}\n";
  const double begin = cpu_seconds();
  EXPECT_EQ(complaints(text), Errors{});
  const double seconds = cpu_seconds() - begin;
  RecordProperty("seconds", std::to_string(seconds));
  EXPECT_LT(seconds, 5.0);  // about 1 s alone; the bound allows for a busy machine
}

}  // namespace
}  // namespace tenon::testing

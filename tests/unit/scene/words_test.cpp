// SPDX-License-Identifier: BSD-3-Clause
// Suggestions, and the order of complaints.
#include <gtest/gtest.h>

#include "framework/base/error.hpp"
#include "framework/scene/value.hpp"

namespace tenon::scene {
namespace {

const std::vector<std::string> keys{"density", "youngs_modulus", "poissons_ratio", "yield_stress", "type"};

TEST(Suggestion, FindsTheNearestWord) {
  EXPECT_EQ(nearest_word("densty", keys), "density");
  EXPECT_EQ(nearest_word("denisty", keys), "density");  // a swap counts once
  EXPECT_EQ(nearest_word("Youngs-Modulus", keys), "youngs_modulus");
  EXPECT_EQ(nearest_word("youngs", keys), "youngs_modulus");
  EXPECT_EQ(nearest_word("ratio", keys), "poissons_ratio");
  EXPECT_EQ(nearest_word("tpye", keys), "type");
  EXPECT_EQ(nearest_word("temperature", keys), "");
  EXPECT_EQ(nearest_word("", keys), "");
  EXPECT_EQ(nearest_word("x", {"y"}), "");
  EXPECT_EQ(nearest_word("k", {"m", "K"}), "K");
  EXPECT_EQ(nearest_word(std::string(100000, 'd'), keys), "");
}

TEST(Suggestion, TiesGoToTheFirst) {
  EXPECT_EQ(nearest_word("bat", {"cat", "rat"}), "cat");
}

TEST(Suggestion, OffersTheNearestOrAll) {
  EXPECT_EQ(suggestion("densty", keys), ", did you mean 'density'?");
  EXPECT_EQ(suggestion("foo", {"a", "b"}), "; valid: a, b");
  EXPECT_EQ(suggestion("foo", {}), "; there is none to choose from");
}

TEST(Diagnostics, SortsByPlaceAndKeepsOneOfEach) {
  Diagnostics diagnostics;
  diagnostics.error({"components.x", 0, 0}, "from the command line");
  diagnostics.error({"s.yaml", 12, 5}, "late");
  diagnostics.error({"s.yaml", 2, 9}, "early, right");
  diagnostics.error({"s.yaml", 2, 1}, "early, first said");
  diagnostics.error({"s.yaml", 2, 1}, "early, then said");
  diagnostics.error({"s.yaml", 2, 1}, "early, first said");
  EXPECT_EQ(diagnostics.errors(),
            (std::vector<std::string>{"s.yaml:2:1: early, first said", "s.yaml:2:1: early, then said",
                                      "s.yaml:2:9: early, right", "s.yaml:12:5: late",
                                      "--set components.x: from the command line"}));
  EXPECT_TRUE(diagnostics.any());
}

TEST(Diagnostics, ThrowsOneUsageErrorWithAll) {
  Diagnostics diagnostics;
  diagnostics.throw_if_any();
  diagnostics.warning({"s.yaml", 1, 1}, "hm");
  diagnostics.throw_if_any();
  EXPECT_EQ(diagnostics.warnings(), (std::vector<std::string>{"s.yaml:1:1: warning: hm"}));
  diagnostics.error({"s.yaml", 3, 1}, "b");
  diagnostics.error({"s.yaml", 2, 1}, "a");
  try {
    diagnostics.throw_if_any();
    FAIL() << "nothing thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_STREQ(error.what(), "s.yaml:2:1: a\ns.yaml:3:1: b");
  }
}

}  // namespace
}  // namespace tenon::scene

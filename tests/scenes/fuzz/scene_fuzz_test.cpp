// SPDX-License-Identifier: BSD-3-Clause
// 1,000 random single edits of a valid scene: each runs, or is refused with exit code 2 or 3; a run may still end as
// unstable (4) or inverted (5), as any scene may.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "apps/tenon/build_simulation.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

std::string valid_scene() {
  std::ifstream file(TENON_SOURCE_DIR "/tests/scenes/fuzz/small.yaml");
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string edited(const std::string& scene, std::mt19937& random) {
  const auto pick = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  static const std::string letters = " \n\t:-[]{}'\"#,.&*!|>%@`0123456789eEabcxyzµ\x00\x01\xff";
  static const std::vector<std::string> words{"nan",   "inf",    "-1",   "0",      "1e400",  "~",      "[]",
                                              "{}",    "true",   "5 m",  "1 K",    "null",   "bottom", "box",
                                              "steel", "1e-300", "-0.0", "<<: *a", "999999", "type"};
  std::string text = scene;
  const std::size_t at = pick(text.size());
  switch (pick(6)) {
    case 0:
      text[at] = letters[pick(letters.size())];
      break;
    case 1:
      text.erase(at, 1 + pick(8));
      break;
    case 2:
      text.insert(at, 1, letters[pick(letters.size())]);
      break;
    case 3:
      text.insert(at, words[pick(words.size())]);
      break;
    case 4: {  // a whole line goes
      const std::size_t begin = text.rfind('\n', at) + 1, end = text.find('\n', at);
      text.erase(begin, (end == std::string::npos ? text.size() : end + 1) - begin);
      break;
    }
    default: {  // a word is replaced
      const std::size_t begin = text.find_last_of(" \n:,{[", at) + 1, end = text.find_first_of(" \n:,}]", at);
      text.replace(begin, (end == std::string::npos ? text.size() : end) - begin, words[pick(words.size())]);
    }
  }
  return text;
}

// A few steps prove that what was accepted can run.
int outcome(const std::string& path) {
  Log log(false);
  try {
    const LoadedScene scene = load_scene(testing::communicator(), path, {});
    BuiltScene built = build_simulation(testing::communicator(), log, scene);
    built.simulation->initialize();
    for (int step = 0; step < 5 && !built.simulation->done(); ++step) built.simulation->step();
    return 0;
  } catch (const Error& error) {
    EXPECT_STRNE(error.what(), "");
    return static_cast<int>(error.code());
  }
}

TEST(SceneFuzz, ValidSceneRuns) {
  EXPECT_EQ(outcome(TENON_SOURCE_DIR "/tests/scenes/fuzz/small.yaml"), 0);
}

TEST(SceneFuzz, EveryEditRunsOrIsRefused) {
  const std::string scene = valid_scene(), path = "fuzzed.yaml";
  std::map<int, int> outcomes;
  for (unsigned seed = 0; seed < 1000; ++seed) {
    std::mt19937 random(seed);
    const std::string text = edited(scene, random);
    std::ofstream(path, std::ios::binary) << text;
    const auto start = std::chrono::steady_clock::now();
    const int code = outcome(path);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ++outcomes[code];
    EXPECT_TRUE(code == 0 || code == 2 || code == 3 || code == 4 || code == 5) << "seed " << seed << "\n" << text;
    EXPECT_LT(seconds, 30) << "seed " << seed;
  }
  for (const auto& [code, count] : outcomes) std::printf("exit %d: %d times\n", code, count);
  EXPECT_GT(outcomes[0], 100);
  EXPECT_GT(outcomes[2], 100);
}

}  // namespace
}  // namespace tenon

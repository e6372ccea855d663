// SPDX-License-Identifier: BSD-3-Clause
#include "search_bench.hpp"

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <cstring>
#include <memory>

#include "../transfer/bench_clock.hpp"
#include "framework/search/box_join.hpp"
#include "scenes.hpp"

namespace tenon::bench {

namespace {

struct Options {
  std::int64_t items = 1'000'000;
  int repeats = 5;
  std::vector<std::string> scenes{"sheet", "shuffled", "random", "graded", "coarse"};
};

// Bytes that any search has to touch: boxes read once, pairs written once.
std::size_t least_bytes(const BoxScene& scene, std::size_t pairs) {
  return (scene.boxes.size() + scene.points.size()) * sizeof(Box) + pairs * sizeof(BoxJoin::Pair);
}

void time_scene(const BoxScene& scene, int repeats) {
  const Communicator self = Communicator::self();
  BoxJoin join;
  std::vector<BoxJoin::Pair> pairs;
  const auto once = [&](Times& build, Times& search) {
    build.take(self, [&] { return join.build(scene.boxes, scene.points), 0; });
    search.take(self, [&] { return join.find_pairs(pairs), 0; });
  };
  Times grown_build, grown_search, build, search, copy;
  once(grown_build, grown_search);
  for (int r = 0; r < repeats; ++r) once(build, search);
  std::vector<std::byte> from(least_bytes(scene, pairs.size()) / 2), to(from.size());
  for (int r = 0; r <= repeats; ++r)
    copy.take(self, [&] { return std::memcpy(to.data(), from.data(), from.size()), 0; });
  const double count = static_cast<double>(pairs.size()), total = build.median() + search.median();
  fmt::print("{:38} {:9} {:6.2f} {:7.1f} {:7.1f} {:7.1f} {:8.1f} {:8.1f} {:8.1f} {:8.1f}\n", scene.name, pairs.size(),
             static_cast<double>(join.tests()) / count, 1e3 * build.median(), 1e3 * search.median(),
             1e3 * (grown_build.best() + grown_search.best()), 1e-6 * count / total,
             1e-6 * count / (build.best() + search.best()), 1e3 * copy.best(),
             static_cast<double>(join.memory()) / static_cast<double>(scene.boxes.size() + scene.points.size()));
}

void run(const Options& options) {
  fmt::print("{:38} {:>9} {:>6} {:>7} {:>7} {:>7} {:>8} {:>8} {:>8} {:>8}\n", "scene", "pairs", "tests/", "build",
             "search", "first", "M pairs/s", "best", "memcpy", "bytes/");
  fmt::print("{:38} {:>9} {:>6} {:>7} {:>7} {:>7} {:>8} {:>8} {:>8} {:>8}\n", "", "", "pair", "ms", "ms", "ms", "", "",
             "ms", "item");
  for (const std::string& scene : options.scenes) {
    if (scene == "sheet") time_scene(wavy_sheet(options.items), options.repeats);
    if (scene == "shuffled") time_scene(shuffled(wavy_sheet(options.items)), options.repeats);
    if (scene == "random") time_scene(random_boxes(options.items), options.repeats);
    if (scene == "graded") time_scene(wavy_sheet(options.items, 100), options.repeats);
    if (scene == "coarse") time_scene(fine_and_coarse(options.items), options.repeats);
  }
}

}  // namespace

void add_search(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* const search = app.add_subcommand("search", "boxes of faces against points, on one core");
  search->add_option("scene", options->scenes, "which")
      ->check(CLI::IsMember({"sheet", "shuffled", "random", "graded", "coarse"}));
  search->add_option("--items", options->items, "faces, and as many points")->check(CLI::PositiveNumber);
  search->add_option("--repeats", options->repeats)->check(CLI::PositiveNumber);
  search->callback([options] { run(*options); });
}

}  // namespace tenon::bench

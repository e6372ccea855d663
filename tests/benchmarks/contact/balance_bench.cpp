// SPDX-License-Identifier: BSD-3-Clause
#include "balance_bench.hpp"

#include <fmt/core.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "../transfer/bench_clock.hpp"
#include "framework/decomposition/graph_partition.hpp"
#include "framework/search/box_pairs.hpp"
#include "scenes.hpp"

namespace tenon::bench {

namespace {

struct Options {
  std::vector<std::string> decompositions{"rcb", "slices", "owner_boxes"};
  std::int64_t items = 100'000;
  int stages = 120;
};

const char* name_of(SearchDecomposition decomposition) {
  switch (decomposition) {
    case SearchDecomposition::rcb:
      return "rcb";
    case SearchDecomposition::slices:
      return "slices";
    default:
      return "owner_boxes";
  }
}

void crumple(SearchDecomposition decomposition, const Options& options) {
  const Communicator comm = Communicator::world();
  BoxPairSearch search(comm, decomposition, "balance");
  std::vector<BoxPair> pairs;
  Times times;
  double worst = 0, sum = 0;
  for (int stage = 0; stage <= options.stages; ++stage) {
    const double progress = static_cast<double>(stage) / options.stages;
    const BoxScene can = crumpled_can(options.items, progress, comm.rank(), comm.size());
    times.take(comm, [&] { return search.find(can.boxes, can.points, pairs), 0; });
    const double ratio = imbalance(comm, static_cast<double>(search.work().total()));
    const std::int64_t all_pairs = comm.sum(static_cast<std::int64_t>(pairs.size()));
    const std::int64_t received = comm.sum(search.work().boxes_received);
    if (stage >= 2) worst = std::max(worst, ratio), sum += ratio;  // the first cuts know nothing of the work
    if (comm.rank() == 0 && stage % std::max(1, options.stages / 6) == 0)
      fmt::print("{:12} {:5} {:9} {:9} {:6} {:8.3f} {:8.1f}\n", name_of(decomposition), stage, all_pairs, received,
                 search.cuts(), ratio, 1e3 * times.wall.back());
  }
  if (comm.rank() == 0)
    fmt::print("{:12} from the third search on: mean {:.3f}, greatest {:.3f}; {} cuts in {} searches\n",
               name_of(decomposition), sum / (options.stages - 1), worst, search.cuts(), search.searches());
}

void run(const Options& options) {
  if (Communicator::world().rank() == 0)
    fmt::print("{:12} {:>5} {:>9} {:>9} {:>6} {:>8} {:>8}\n", "", "search", "pairs", "boxes", "cuts", "max/mean", "ms");
  for (const auto decomposition :
       {SearchDecomposition::rcb, SearchDecomposition::slices, SearchDecomposition::owner_boxes})
    if (std::ranges::count(options.decompositions, name_of(decomposition)) > 0) crumple(decomposition, options);
}

}  // namespace

void add_balance(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* const balance = app.add_subcommand("balance", "work of the search per rank while a can is crumpled");
  balance->add_option("decomposition", options->decompositions, "which")
      ->check(CLI::IsMember({"rcb", "slices", "owner_boxes"}));
  balance->add_option("--items", options->items, "faces, and as many nodes")->check(CLI::PositiveNumber);
  balance->add_option("--stages", options->stages)->check(CLI::Range(2, 100000));
  balance->callback([options] { run(*options); });
}

}  // namespace tenon::bench

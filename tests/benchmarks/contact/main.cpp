// SPDX-License-Identifier: BSD-3-Clause
// Contact, timed part by part.
//   contact_bench search [sheet|shuffled|random|graded|coarse ...] [--items N] [--repeats N]
//   mpirun -n 16 --oversubscribe contact_bench balance [rcb|slices|owner_boxes ...] [--items N] [--stages N]
//   contact_bench can [--elements N] [--layers 0..4] [--steps N] [--decomposition rcb|slices|owner_boxes]
//   contact_bench apart [--n N] [--steps N] [--repeats N]
#include <CLI/CLI.hpp>

#include "balance_bench.hpp"
#include "can_bench.hpp"
#include "framework/comm/communicator.hpp"
#include "search_bench.hpp"

int main(int argc, char** argv) {
  tenon::MpiEnvironment environment(argc, argv);
  CLI::App app("Times contact.");
  app.require_subcommand(1);
  tenon::bench::add_search(app);
  tenon::bench::add_balance(app);
  tenon::bench::add_can(app);
  tenon::bench::add_apart(app);
  CLI11_PARSE(app, argc, argv);
  return 0;
}

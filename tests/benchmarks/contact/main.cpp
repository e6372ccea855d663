// SPDX-License-Identifier: BSD-3-Clause
// Contact, timed part by part.
//   contact_bench search [--items N] [--repeats N]
#include <CLI/CLI.hpp>

#include "framework/comm/communicator.hpp"
#include "search_bench.hpp"

int main(int argc, char** argv) {
  tenon::MpiEnvironment environment(argc, argv);
  CLI::App app("Times contact.");
  app.require_subcommand(1);
  tenon::bench::add_search(app);
  CLI11_PARSE(app, argc, argv);
  return 0;
}

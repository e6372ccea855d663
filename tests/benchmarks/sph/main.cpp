// SPDX-License-Identifier: BSD-3-Clause
// Particles, timed through the real component.
//   sph_bench fluid [--particles N] [--steps N] [--repeats N] [--speed M]    on one rank, or under mpirun
//   mpirun -n 16 --oversubscribe sph_bench balance [--spacing M] [--end S] [--stages N]
//   sph_bench taylor_green [--across 25 50 ...] [--shifting none|shifting|transport_velocity] [--kernel NAME] ...
#include <CLI/CLI.hpp>

#include "balance_bench.hpp"
#include "box_bench.hpp"
#include "framework/comm/communicator.hpp"
#include "taylor_green_bench.hpp"

int main(int argc, char** argv) {
  tenon::MpiEnvironment environment(argc, argv);
  CLI::App app("Times particles.");
  app.require_subcommand(1);
  tenon::bench::add_balance(app);
  tenon::bench::add_fluid(app);
  tenon::bench::add_taylor_green(app);
  CLI11_PARSE(app, argc, argv);
  return 0;
}

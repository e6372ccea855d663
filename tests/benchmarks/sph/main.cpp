// SPDX-License-Identifier: BSD-3-Clause
// Particles, timed through the real component.
//   sph_bench fluid [--particles N] [--steps N] [--repeats N] [--speed M]    on one rank, or under mpirun
#include <CLI/CLI.hpp>

#include "box_bench.hpp"
#include "framework/comm/communicator.hpp"

int main(int argc, char** argv) {
  tenon::MpiEnvironment environment(argc, argv);
  CLI::App app("Times particles.");
  app.require_subcommand(1);
  tenon::bench::add_fluid(app);
  CLI11_PARSE(app, argc, argv);
  return 0;
}

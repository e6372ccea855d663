// SPDX-License-Identifier: BSD-3-Clause
// Particles, timed through the real component.
//   sph_bench fluid [--particles N] [--steps N] [--repeats N] [--speed M]    on one rank, or under mpirun
//   mpirun -n 16 --oversubscribe sph_bench balance [--spacing M] [--end S] [--stages N]
//   sph_bench taylor_green [--across 25 50 ...] [--shifting none|shifting|transport_velocity] [--kernel NAME] ...
//   sph_bench spheric2 [--spacing M] [--end S] [--alpha A] [--csv FILE]     a dam onto a box (B09)
//   sph_bench work_precision [--vortices 16 32 ...] [--tubes 160 320 ...] [--csv FILE] [--png FILE]
#include <CLI/CLI.hpp>
#include <string_view>

#include "balance_bench.hpp"
#include "box_bench.hpp"
#include "framework/comm/communicator.hpp"
#include "framework/io/pictures.hpp"
#include "spheric2_bench.hpp"
#include "taylor_green_bench.hpp"
#include "work_precision_bench.hpp"

int main(int argc, char** argv) {
  for (int a = 1; a < argc; ++a)
    if (std::string_view(argv[a]) == "--png") tenon::ensure_display(argc, argv);
  tenon::MpiEnvironment environment(argc, argv);
  CLI::App app("Times particles.");
  app.require_subcommand(1);
  tenon::bench::add_balance(app);
  tenon::bench::add_fluid(app);
  tenon::bench::add_spheric2(app);
  tenon::bench::add_taylor_green(app);
  tenon::bench::add_work_precision(app);
  CLI11_PARSE(app, argc, argv);
  return 0;
}

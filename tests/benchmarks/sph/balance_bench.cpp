// SPDX-License-Identifier: BSD-3-Clause
#include "balance_bench.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "components/sph/particle_decomposition.hpp"
#include "dam_break_case.hpp"

namespace tenon::bench {

namespace {

struct BalanceSize {
  double spacing = 0.02, end = 0.9;
  int stages = 6;
};

/// Greatest over mean work of the ranks: pairs, and what a particle costs beside them.
double imbalance(const testing::SphRun& run) {
  const double work = static_cast<double>(run.lists().pairs()) +
                      ParticleDecomposition::pairs_of_a_particle * static_cast<double>(run.particles().owned());
  const double most = run.comm().max(work), sum = static_cast<double>(run.comm().sum(static_cast<std::int64_t>(work)));
  return most * run.comm().size() / sum;
}

void run(const BalanceSize& size) {
  const Communicator comm = Communicator::world();
  testing::SphRun run(testing::water({1, 2, 0}, {4, 3, 0}, size.spacing, 0.05), comm);
  if (comm.rank() == 0) fmt::print("t, steps, renewals, new parts, work after renewals: mean and greatest imbalance\n");
  const double start = imbalance(run);
  if (comm.rank() == 0) fmt::print("0.000, 0, 0, 0, {:.4f}, {:.4f}\n", start, start);
  for (int stage = 1; stage <= size.stages; ++stage) {
    double worst = 1, total = 0;
    std::int64_t looks = 0, version = -1;
    run.run(size.end * stage / size.stages, [&] {
      if (run.body().decomposition().version() == version) return;
      version = run.body().decomposition().version();
      const double now = imbalance(run);
      worst = std::max(worst, now), total += now, ++looks;
    });
    const DecompositionCounts& counts = run.body().decomposition().counts();
    if (comm.rank() == 0)
      fmt::print("{:.3f}, {}, {}, {}, {:.4f}, {:.4f}\n", run.time(), run.simulation().steps(), counts.renewals,
                 counts.rebalances, total / static_cast<double>(std::max<std::int64_t>(1, looks)), worst);
  }
}

}  // namespace

void add_balance(CLI::App& app) {
  auto size = std::make_shared<BalanceSize>();
  CLI::App* const command = app.add_subcommand("balance", "work of the ranks through a dam break");
  command->add_option("--spacing", size->spacing, "of particles, m");
  command->add_option("--end", size->end, "s");
  command->add_option("--stages", size->stages);
  command->callback([size] { run(*size); });
}

}  // namespace tenon::bench

// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "apps/tenon/build_simulation.hpp"
#include "apps/tenon/commands.hpp"
#include "apps/tenon/plan_scaling.hpp"
#include "framework/decomposition/graph_partition.hpp"
#include "framework/simulation/run_report.hpp"

namespace tenon {

namespace {

double megabytes(std::int64_t bytes) {
  return static_cast<double>(bytes) / 1048576.0;
}

void print_component(Simulation& simulation, Component& component) {
  const Communicator& comm = simulation.comm();
  const Mesh& mesh = component.mesh();
  std::int64_t owned = 0;
  for (const ElementBlock& block : mesh.blocks)
    owned += std::count(block.owners.begin(), block.owners.end(), comm.rank());
  const double balance = imbalance(comm, static_cast<double>(owned));
  const std::int64_t empty = comm.sum(static_cast<std::int64_t>(owned == 0));
  const double dt = component.time_step();
  const StepLimiter limiter = component.limiter();
  const std::int64_t memory = comm.sum(component.memory());
  Log& log = simulation.log();
  log.print("\ncomponent {} ({})", component.name(), component.type());
  log.print("  {} elements, {} nodes in {} parts ({} empty), max/mean elements {:.3f}", mesh.global_elements,
            mesh.global_nodes, comm.size(), empty, balance);
  if (std::isfinite(dt))
    log.print("  time step {:.4e} s, limited by {}", dt, limiter.reason);
  else
    log.print("  no limit of the time step: it follows the other components");
  log.print("  state {:.1f} MiB in all", megabytes(memory));
}

/// What the scene will not pay for, from what it holds.
void print_skips(Simulation& simulation) {
  Log& log = simulation.log();
  log.line("\nskipped, because the scene does not need it");
  if (simulation.comm().size() == 1) log.line("  all messages: one rank");
  if (simulation.couplings().empty()) log.line("  all transfers and their searches: no transfers");
  for (const auto& coupling : simulation.couplings())
    if (coupling->schedule() == CouplingSchedule::slower_step)
      log.print("  transfer {} in all but the steps of the slower component", coupling->name());
  for (const auto& component : simulation.components())
    for (const SkipCount& skip : component->skips()) log.print("  {}: {}", component->name(), skip.what);
  if (simulation.interactions().empty()) log.line("  all contact searches and impulses: no contact");
  for (const auto& interaction : simulation.interactions())
    for (const SkipCount& skip : interaction->skips()) log.print("  {}: {}", interaction->name(), skip.what);
}

}  // namespace

void plan_scene(const Communicator& comm, const PlanArguments& arguments) {
  Log log(comm.rank() == 0);
  check_plan(comm, arguments);
  const LoadedScene scene = load_scene(comm, arguments.scene, parse_overrides(arguments.settings));
  log.print("{}\n{} on {} ranks", version_text(), scene.title, comm.size());
  BuiltScene built = build_simulation(comm, log, scene);
  Simulation& simulation = *built.simulation;
  simulation.initialize();
  print_warnings(log, built);
  for (const auto& component : simulation.components()) print_component(simulation, *component);
  for (const auto& interaction : simulation.interactions()) {
    log.print("\n{}", interaction->name());
    for (const std::string& line : interaction->report()) log.print("  {}", line);
    log.print("  state {:.1f} MiB in all", megabytes(comm.sum(interaction->memory())));
  }
  std::int64_t maps = 0;
  for (const auto& coupling : simulation.couplings()) {
    log.print("\ntransfer {}", coupling->name());
    for (const std::string& line : coupling->report()) log.print("  {}", line);
    maps += coupling->memory();
  }
  const double duration = simulation.end_time() - simulation.start_time();
  const Trial trial = try_steps(simulation, trial_options(arguments));
  const double done = simulation.time() - simulation.start_time();
  const double predicted = done > 0 ? static_cast<double>(simulation.steps()) * duration / done : 0.0;
  print_skips(simulation);
  log.print(
      "\npredicted: about {:.0f} steps in {:.0f} s on these {} ranks, without output (from {} trial steps; the step "
      "shrinks as elements deform); memory {:.0f} MiB in all, of which transfer maps {:.1f} MiB",
      predicted, predicted * trial.seconds, comm.size(), trial.steps, megabytes(comm.sum(peak_memory())),
      megabytes(comm.sum(maps)));
  if (arguments.trial > 0 || !arguments.measure_until.empty() || !arguments.ranks.empty())
    print_trial(log, comm, trial);
  if (!arguments.ranks.empty()) plan_scaling(built, arguments, trial);
}

}  // namespace tenon

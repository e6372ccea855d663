// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tenon/plan_scaling.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <numeric>
#include <stdexcept>

#include "apps/tenon/scaling_machine.hpp"
#include "apps/tenon/scaling_parts.hpp"
#include "apps/tenon/scaling_table.hpp"
#include "components/contact/contact.hpp"
#include "components/sph/sph.hpp"
#include "framework/scene/schema.hpp"

namespace tenon {

namespace {

struct NamedDecomposition {
  std::string name;
  SearchDecomposition kind;
  double least_work = 0;
};

NamedDecomposition decomposition_of(const std::string& name) {
  if (name == "auto") return {name, SearchDecomposition::rcb, sensible_least_work};
  if (name == "own") return {name, SearchDecomposition::rcb};
  if (name == "slices") return {name, SearchDecomposition::slices};
  if (name == "static") return {name, SearchDecomposition::owner_boxes};
  throw Error(ExitCode::usage, "decomposition '" + name + "': expected auto, own, slices or static");
}

std::size_t place_of(const Simulation& simulation, const Component* component) {
  const auto& all = simulation.components();
  return static_cast<std::size_t>(std::ranges::find_if(all, [&](const auto& c) { return c.get() == component; }) -
                                  all.begin());
}

bool is_party(const Simulation& simulation, const Component* component) {
  for (const auto& interaction : simulation.interactions())
    if (dynamic_cast<const Contact*>(interaction.get()) &&
        std::ranges::find(interaction->parties(), component) != interaction->parties().end())
      return true;
  return false;
}

/// What no timer has seen, and transfers: shared out as nodes are.
void add_rest(std::vector<PhaseLoad>& phases, const std::vector<MeshParts>& meshes, const Trial& trial) {
  const auto parts = static_cast<std::size_t>(meshes.front().parts);
  std::vector<double> nodes(parts);
  double all = 0;
  for (const MeshParts& mesh : meshes) {
    for (std::size_t p = 0; p < parts; ++p) nodes[p] += mesh.local_nodes[p];
    all += static_cast<double>(mesh.node_part.size());
  }
  double transfers = 0, known = 0;
  for (const auto& [name, seconds] : trial.phases) {
    if (name.starts_with("transfer")) transfers += seconds;
    known += seconds;
  }
  const auto add = [&](const char* name, double seconds) {
    PhaseLoad load;
    load.phase = load.group = name, load.seconds = seconds;
    load.whole = all, load.work = nodes;
    if (seconds > 0) phases.push_back(std::move(load));
  };
  add("transfers", transfers);
  add("other", std::max(0.0, trial.processor_seconds - known));
}

StepLoads loads_of(BuiltScene& built, const std::vector<MeshParts>& meshes, const Trial& trial,
                   const NamedDecomposition& decomposition) {
  const Simulation& simulation = *built.simulation;
  const ScalingTrial scaling{trial, decomposition.kind, decomposition.least_work};
  StepLoads step{meshes.front().parts, decomposition.name, {}};
  const auto add = [&](std::vector<PhaseLoad> loads) {
    for (PhaseLoad& load : loads) step.phases.push_back(std::move(load));
  };
  for (std::size_t c = 0; c < meshes.size(); ++c) {
    Component& component = *simulation.components()[c];
    if (auto* const sph = dynamic_cast<Sph*>(&component))
      add(particle_loads(*sph, meshes[c], scaling, is_party(simulation, &component)));
    else
      add(mesh_loads(component, built.divisions[c], meshes[c], trial));
  }
  for (const auto& interaction : simulation.interactions())
    if (const auto* const contact = dynamic_cast<const Contact*>(interaction.get())) {
      std::vector<const MeshParts*> homes;
      for (const Component* party : contact->parties()) homes.push_back(&meshes[place_of(simulation, party)]);
      add(contact_loads(*contact, homes, scaling));
    }
  add_rest(step.phases, meshes, trial);
  return step;
}

}  // namespace

namespace {

double time_of(const std::string& text, const char* option) {
  if (text.empty()) return 0;
  try {
    return scene::parse_quantity(text, "s");
  } catch (const std::invalid_argument& problem) {
    throw Error(ExitCode::usage, fmt::format("plan {}: {}", option, problem.what()));
  }
}

/// A file that cannot be written is found before the work, not after it.
void try_csv(const std::string& path) {
  if (!path.empty() && !std::ofstream(path, std::ios::app)) throw Error(ExitCode::file, path + ": cannot be written");
}

}  // namespace

TrialOptions trial_options(const PlanArguments& arguments) {
  TrialOptions options{arguments.after, time_of(arguments.until, "--until"), arguments.trial,
                       time_of(arguments.measure_until, "--measure-until")};
  if (options.end > 0 && options.steps > 0)
    throw Error(ExitCode::usage, "plan: --trial and --measure-until both say how long is measured; give one of them");
  if (options.end > 0 && options.end <= options.until)
    throw Error(ExitCode::usage, "plan --measure-until: is not after --until; nothing would be measured");
  return options;
}

void check_plan(const Communicator& comm, const PlanArguments& arguments) {
  trial_options(arguments);
  if (arguments.ranks.empty()) {
    const char* given = !arguments.machines.empty()         ? "--machine"
                        : !arguments.decompositions.empty() ? "--decomposition"
                        : !arguments.csv.empty()            ? "--csv"
                                                            : nullptr;
    if (given)
      throw Error(ExitCode::usage, fmt::format("plan {}: says nothing without --ranks; add the numbers of ranks to "
                                               "predict for, as --ranks 64,256",
                                               given));
    return;
  }
  if (comm.size() > 1) throw Error(ExitCode::usage, "plan --ranks: decomposes in one process; start it without mpirun");
  for (const std::string& name : arguments.machines) find_machine(name);
  for (const std::string& name : arguments.decompositions) decomposition_of(name);
  try_csv(arguments.csv);
}

void plan_scaling(BuiltScene& built, const PlanArguments& arguments, const Trial& trial) {
  Simulation& simulation = *built.simulation;
  if (trial.steps == 0) throw Error(ExitCode::usage, "plan --ranks: the run is over before the trial steps");
  std::vector<Machine> machines;
  for (const std::string& name : arguments.machines) machines.push_back(find_machine(name));
  if (machines.empty()) machines.push_back(find_machine("here"));
  std::vector<NamedDecomposition> decompositions;
  for (const std::string& name : arguments.decompositions) decompositions.push_back(decomposition_of(name));
  if (decompositions.empty()) decompositions.push_back(decomposition_of("auto"));
  std::vector<StepLoads> steps;
  for (const int ranks : arguments.ranks) {
    std::vector<MeshParts> meshes;
    for (std::size_t c = 0; c < simulation.components().size(); ++c)
      meshes.push_back(divide_mesh(simulation.components()[c]->mesh(), built.divisions[c], ranks));
    for (const NamedDecomposition& decomposition : decompositions)
      steps.push_back(loads_of(built, meshes, trial, decomposition));
  }
  for (const Machine& machine : machines) {
    for (const StepLoads& step : steps) print_step(simulation.log(), step, machine);
    print_speed_up(simulation.log(), steps, machine);
  }
  if (!arguments.csv.empty()) write_scaling(arguments.csv, steps, machines);
}

void print_trial(Log& log, const Communicator& comm, const Trial& trial) {
  log.print("\nmeasured per step of {} on {} ranks: {:.4e} s by the clock, {:.4e} s of the processor", trial.steps,
            comm.size(), trial.seconds, trial.processor_seconds);
  for (const auto& [name, seconds] : trial.phases)
    if (seconds > 0) log.print("  {:<34} {:>11.4e} s", name, seconds);
  for (const auto& [name, count] : trial.counts) log.print("  {:<34} {:>11.4f}", name, count);
}

}  // namespace tenon

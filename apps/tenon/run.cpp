// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <filesystem>

#include "apps/tenon/build_simulation.hpp"
#include "apps/tenon/commands.hpp"
#include "framework/simulation/checkpoint_output.hpp"
#include "framework/simulation/progress.hpp"
#include "framework/simulation/run_report.hpp"

namespace tenon {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

std::string results_folder(const RunArguments& arguments) {
  if (!arguments.folder.empty()) return arguments.folder;
  return fs::path(arguments.scene).stem().string() + ".results";
}

/// The checkpoint to continue from; empty for a fresh start.
std::string find_checkpoint(const Communicator& comm, Log& log, const RunArguments& arguments,
                            const std::string& folder) {
  if (arguments.restart.empty()) return "";
  if (arguments.restart != "latest") return arguments.restart;
  std::vector<std::string> damaged;
  const std::string newest = CheckpointFiles::newest_valid(comm, folder, &damaged);
  for (const std::string& message : damaged) log.warning(message);
  if (!newest.empty()) return newest;
  if (!damaged.empty())
    throw Error(ExitCode::file,
                folder +
                    ": every checkpoint is damaged; name another file with --restart FILE, or run without "
                    "--restart to start again");
  const std::string final_state = folder + "/final.h5";
  if (comm.any(comm.rank() == 0 && fs::exists(final_state))) return final_state;
  log.print("no checkpoint in {} yet: starting at the beginning", folder);
  return "";
}

// Checkpoints of an earlier run in the same folder would be taken for ours by a later `--restart latest`.
void prepare_folder(const Communicator& comm, const std::string& folder, const std::string& checkpoint) {
  comm.vote_on_root([&] {
    std::error_code problem;
    fs::create_directories(folder, problem);
    if (problem)
      throw Error(ExitCode::file, folder + ": cannot be made: " + problem.message() + "; choose another with -o");
    fs::remove(folder + "/summary.json");
    const fs::path final_state = fs::path(folder) / "final.h5";
    const bool source = !checkpoint.empty() && fs::exists(final_state) && fs::equivalent(checkpoint, final_state);
    if (!source) fs::remove(final_state);
    if (!checkpoint.empty()) return;
    for (const std::string& old : CheckpointFiles::list(folder)) fs::remove(old);
  });
}

void add_observers(Simulation& simulation, const OutputPlan& plan, const std::string& folder, bool frames,
                   HistoryOutput*& history) {
  if (frames) simulation.add(std::make_unique<FrameOutput>(FrameOptions{folder, plan.frames, plan.frame_fields}));
  history = static_cast<HistoryOutput*>(&simulation.add(
      std::make_unique<HistoryOutput>(HistoryOptions{folder + "/history.csv", plan.history, plan.points})));
  simulation.add(std::make_unique<CheckpointOutput>(CheckpointOptions{folder, plan.checkpoint}));
  simulation.add(std::make_unique<Progress>(plan.log));
}

void print_exchanges(Simulation& simulation) {
  if (!simulation.couplings().empty()) simulation.log().line("");
  for (const auto& coupling : simulation.couplings()) {
    simulation.log().print("transfer {}:", coupling->name());
    for (const std::string& line : coupling->report()) simulation.log().print("  {}", line);
  }
  for (const auto& interaction : simulation.interactions()) {
    simulation.log().print("\n{}:", interaction->name());
    for (const std::string& line : interaction->report()) simulation.log().print("  {}", line);
  }
}

double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

double output_seconds(Simulation& simulation) {
  double seconds = 0;
  for (const PhaseTimer& phase : simulation.timers().phases())
    if (phase.name.rfind("output: ", 0) == 0) seconds += phase.seconds;
  return seconds;
}

void step_to_the_end(Simulation& simulation, const RunHooks& hooks, Clock::time_point began) {
  simulation.start();
  if (hooks.started) hooks.started(simulation);
  const double set_up = seconds_since(began), before = output_seconds(simulation);
  const Clock::time_point first_step = Clock::now();
  simulation.run();
  if (simulation.stopped() || !hooks.finished) return;
  const double stepping = seconds_since(first_step) - (output_seconds(simulation) - before);
  hooks.finished(simulation, simulation.comm().max(set_up), simulation.comm().max(stepping));
}

void print_results(Log& log, const std::string& folder, bool stopped) {
  log.print("\nresults in {0}: all.pvd (ParaView), history.csv, summary.json, {1}", folder,
            stopped ? "checkpoint" : "final.h5");
  if (stopped)
    log.print("stopped on request; continue with: tenon run SCENE -o {} --restart latest", folder);
  else
    log.print("pictures: tenon picture {}", folder);
}

}  // namespace

ExitCode run_scene(const Communicator& comm, const RunArguments& arguments, const RunHooks& hooks) {
  const Clock::time_point began = Clock::now();
  Log log(comm.rank() == 0, hooks.to_terminal);
  const LoadedScene scene = load_scene(comm, arguments.scene, parse_overrides(arguments.settings));
  log.print("{}\n{} on {} ranks", version_text(), scene.title, comm.size());
  BuiltScene built = build_simulation(comm, log, scene);
  Simulation& simulation = *built.simulation;

  const std::string folder = results_folder(arguments);
  const std::string checkpoint = find_checkpoint(comm, log, arguments, folder);
  std::unique_ptr<CheckpointReader> reader;
  if (!checkpoint.empty()) reader = std::make_unique<CheckpointReader>(comm, checkpoint);
  if (reader) log.print("continuing from {}", checkpoint);

  StopRequest stop;
  simulation.watch(stop);
  HistoryOutput* history = nullptr;
  add_observers(simulation, built.output, folder, hooks.frames, history);
  simulation.initialize(reader.get());
  const bool restarted = reader != nullptr;
  reader.reset();
  // All that can be refused has been: only now is anything written.
  prepare_folder(comm, folder, checkpoint);
  comm.vote([&] { log.open(folder + "/log.txt", restarted); });
  print_warnings(log, built);
  step_to_the_end(simulation, hooks, began);

  print_exchanges(simulation);
  const double wall = seconds_since(began);
  RunFacts facts{scene.title, scene.path, version_text(), wall, history->greatest_energy_error(), simulation.ending()};
  report_run(simulation, facts, folder + "/summary.json");
  print_results(log, folder, simulation.stopped());
  return simulation.stopped() ? ExitCode::stopped : ExitCode::done;
}

void check_scene(const Communicator& comm, const RunArguments& arguments) {
  Log log(comm.rank() == 0);
  const LoadedScene scene = load_scene(comm, arguments.scene, parse_overrides(arguments.settings));
  BuiltScene built = build_simulation(comm, log, scene);
  built.simulation->initialize();
  print_warnings(log, built);
  log.print("{}: valid", arguments.scene);
}

}  // namespace tenon

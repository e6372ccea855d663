// SPDX-License-Identifier: BSD-3-Clause
// What each command of `tenon` does, free of the command line's syntax.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/tenon/study_plan.hpp"
#include "apps/tenon/transfer_plan.hpp"
#include "framework/base/error.hpp"
#include "framework/comm/communicator.hpp"

namespace tenon {

struct RunArguments {
  std::string scene;
  std::string folder;                 ///< empty: the scene's name with `.results`
  std::vector<std::string> settings;  ///< key.path=value
  std::string restart;                ///< empty, a file, or "latest"
};

struct PlanArguments {
  std::string scene;
  std::vector<std::string> settings;                  ///< key.path=value
  std::vector<int> ranks;                             ///< to predict for; empty: only what is here
  std::vector<std::string> machines, decompositions;  ///< empty: "here"; "auto"
  std::string csv;                                    ///< file for the predictions; empty: none
  std::string until;                  ///< time to which steps are taken before the trial, as "1 ms"; empty: none
  std::string measure_until;          ///< time to which steps are measured; empty: as many as `trial` says
  std::int64_t after = 0, trial = 0;  ///< steps before the trial, and of it (0: a second)
};

class Simulation;

/// What a study looks at in each of its runs; all collective.
struct RunHooks {
  /// When the outputs have begun, before the first step.
  std::function<void(Simulation&)> started;
  /// After the last step; seconds of set-up, and of stepping without output (greatest of the ranks).
  std::function<void(Simulation&, double set_up, double stepping)> finished;
  bool to_terminal = true;  ///< the log; it always goes to log.txt
  bool frames = true;
};

/// Collective. Runs a scene; ExitCode::done or ExitCode::stopped. Throws Error.
ExitCode run_scene(const Communicator& comm, const RunArguments& arguments, const RunHooks& hooks = {});
/// Collective. Runs a scene once for each of several values; writes study.csv and study.png. Runs that fail are
/// recorded and the rest goes on: then the exit code is that of the first failure. Throws Error.
ExitCode study_scene(const Communicator& comm, const StudyArguments& arguments);
/// Collective. Maps fields of a result onto another mesh, writes them and prints a report. Throws Error, and has
/// written nothing then.
ExitCode transfer_results(const Communicator& comm, const TransferArguments& arguments);
/// Collective. Everything that can be refused without running. Throws Error.
void check_scene(const Communicator& comm, const RunArguments& arguments);
/// Collective. Prints sizes, time step and its limit, steps, predicted seconds and memory, and what will be skipped; on
/// request what a step would take on other numbers of ranks. Throws Error.
void plan_scene(const Communicator& comm, const PlanArguments& arguments);

/// Tenon's version with those of compiler, MPI, HDF5, VTK and Zoltan.
std::string version_text();

}  // namespace tenon

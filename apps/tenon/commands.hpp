// SPDX-License-Identifier: BSD-3-Clause
// What each command of `tenon` does, free of the command line's syntax.
#pragma once

#include <string>
#include <vector>

#include "framework/base/error.hpp"
#include "framework/comm/communicator.hpp"

namespace tenon {

struct RunArguments {
  std::string scene;
  std::string folder;                 ///< empty: the scene's name with `.results`
  std::vector<std::string> settings;  ///< key.path=value
  std::string restart;                ///< empty, a file, or "latest"
};

/// Collective. Runs a scene; ExitCode::done or ExitCode::stopped. Throws Error.
ExitCode run_scene(const Communicator& comm, const RunArguments& arguments);
/// Collective. Everything that can be refused without running. Throws Error.
void check_scene(const Communicator& comm, const RunArguments& arguments);
/// Collective. Prints sizes, time step and its limit, steps, predicted seconds and memory, and what will be skipped.
void plan_scene(const Communicator& comm, const RunArguments& arguments);

/// Tenon's version with those of compiler, MPI, HDF5, VTK and Zoltan.
std::string version_text();

}  // namespace tenon

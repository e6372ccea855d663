// SPDX-License-Identifier: BSD-3-Clause
// From a checked scene to components and couplings.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/tenon/load_scene.hpp"
#include "framework/simulation/frame_output.hpp"
#include "framework/simulation/history_output.hpp"
#include "framework/simulation/simulation.hpp"

namespace tenon {

/// How often what is written.
struct OutputPlan {
  Interval frames, history, checkpoint, log;
  std::vector<std::string> frame_fields;
  std::vector<PointHistory> points;
};

struct BuiltScene {
  std::unique_ptr<Simulation> simulation;
  OutputPlan output;
  std::vector<std::string> warnings;
  struct Division {
    ElementCost cost;
    PartitionMethod method;
  };
  std::vector<Division> divisions;  ///< of the meshes of the components, in their order
};

/// Collective. Reads the meshes, checks every name of the scene against them, distributes, makes components and
/// couplings; nothing is initialized and nothing written. Throws Error(usage) with all complaints, Error(file),
/// Error(geometry); together on all ranks.
BuiltScene build_simulation(const Communicator& comm, Log& log, const LoadedScene& scene);

/// Local. What a user should know of the scene and of its components; to be called after `initialize`.
void print_warnings(Log& log, const BuiltScene& built);

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// The predicted step on many ranks as tables, and as CSV.
#pragma once

#include <string>
#include <vector>

#include "apps/tenon/scaling_load.hpp"
#include "apps/tenon/scaling_machine.hpp"
#include "framework/base/log.hpp"

namespace tenon {

/// The phases of a step on so many ranks.
struct StepLoads {
  int ranks = 1;
  std::string decomposition;  ///< "rcb", "slices", "static"
  std::vector<PhaseLoad> phases;
};

void print_step(Log& log, const StepLoads& step, const Machine& machine);
/// One row per number of ranks: seconds per step of each group of phases, their sum, and the speed-up over the first.
void print_speed_up(Log& log, const std::vector<StepLoads>& steps, const Machine& machine);
/// A row per step and phase. Throws Error(file).
void write_scaling(const std::string& path, const std::vector<StepLoads>& steps, const std::vector<Machine>& machines);

}  // namespace tenon

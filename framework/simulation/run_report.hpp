// SPDX-License-Identifier: BSD-3-Clause
// The last table of a run and summary.json.
#pragma once

#include <string>

#include "framework/simulation/simulation.hpp"

namespace tenon {

struct RunFacts {
  std::string title, scene, version;
  double wall_seconds = 0;
  double greatest_energy_error = 0;
  std::string end;  ///< "done", "stopped on request" ...
};

/// Collective. Prints seconds, share and imbalance (greatest over mean of the ranks) of every phase, messages and bytes
/// of every exchange, peak memory, what was skipped how often; writes the same as JSON to `path`.
void report_run(Simulation& simulation, const RunFacts& facts, const std::string& path);

/// Peak resident memory of this process, bytes.
std::int64_t peak_memory();

}  // namespace tenon

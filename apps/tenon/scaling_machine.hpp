// SPDX-License-Identifier: BSD-3-Clause
// A parallel machine in four numbers, and the time that it needs for a phase.
#pragma once

#include <string>

#include "apps/tenon/scaling_load.hpp"

namespace tenon {

/// A message costs its latency and its bytes over the bandwidth, one after the other on each rank (no overlap); a
/// reduction costs one latency for each doubling of the ranks; a unit of work costs `slowness` times what it was
/// measured to cost here.
struct Machine {
  std::string name, source;
  double latency = 0;    ///< s
  double bandwidth = 0;  ///< bytes/s of a rank
  double slowness = 1;
};

/// "here", "tflops", "cluster", or a YAML file with latency, bandwidth (quantities) and slowness. Throws Error(usage).
Machine find_machine(const std::string& name);

struct PhaseTime {
  double work_max = 0, work_mean = 0;
  double messages = 0, bytes = 0;  ///< of the rank that has most of each
  double seconds = 0;              ///< of the slowest rank, reductions included
  double computing = 0;            ///< s, of the rank with most work
};
PhaseTime predict(const PhaseLoad& load, const Machine& machine);

}  // namespace tenon

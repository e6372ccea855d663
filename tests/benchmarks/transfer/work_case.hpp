// SPDX-License-Identifier: BSD-3-Clause
// Time, memory and errors of the map of point values on one pair of meshes, with VTK's locator beside it.
#pragma once

#include "bench_cases.hpp"

namespace tenon::bench {

struct WorkOptions {
  int repeats = 5;
  bool vtk = true;    ///< the static locator, on one rank
  bool probe = true;  ///< the probe filter too
};

/// Collective. Prints on rank 0.
void run_work_case(const std::string& title, const Mesh& source, const Targets& targets, const WorkOptions& options);

}  // namespace tenon::bench

// SPDX-License-Identifier: BSD-3-Clause
// A few real steps, to know what each phase costs.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "framework/simulation/simulation.hpp"

namespace tenon {

struct TrialOptions {
  std::int64_t after = 0;  ///< steps before those that are measured
  double until = 0;        ///< s: and those to this time
  std::int64_t steps = 0;  ///< measured; 0: as many as fit in a second
  double end = 0;          ///< s: measured to this time instead, if positive
};

/// What was measured, per step of the leader; the same on every rank.
struct Trial {
  std::int64_t steps = 0;
  double seconds = 0;                    ///< of the clock, greatest of the ranks
  double processor_seconds = 0;          ///< likewise
  std::map<std::string, double> phases;  ///< processor seconds, mean of the ranks: the clock's, less what others took
  std::map<std::string, double> counts;  ///< see trial_counts

  double phase(const std::string& name) const {
    const auto found = phases.find(name);
    return found == phases.end() ? 0.0 : found->second;
  }
  double count(const std::string& name) const {
    const auto found = counts.find(name);
    return found == counts.end() ? 0.0 : found->second;
  }
};

/// Collective. Takes steps; fewer if the run ends.
Trial try_steps(Simulation& simulation, const TrialOptions& options);

}  // namespace tenon

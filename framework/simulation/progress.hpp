// SPDX-License-Identifier: BSD-3-Clause
// One line in the log every so often, so that a user sees where the run is and how it fares.
#pragma once

#include <chrono>

#include "framework/simulation/interval.hpp"
#include "framework/simulation/simulation.hpp"

namespace tenon {

/// Step, time, dt, what limits it, energies, ledger error, time to go; before it, warnings that have arisen since the
/// start.
class Progress : public Observer {
 public:
  explicit Progress(Interval every) : every_(every) {}
  void start(Simulation& simulation, bool restarted) override;
  void after_step(Simulation& simulation, bool last) override;

 private:
  void header(Simulation& simulation);
  void line(Simulation& simulation);
  void new_warnings(Simulation& simulation);
  double seconds_left(const Simulation& simulation) const;
  Interval every_;
  IntervalClock clock_;
  std::chrono::steady_clock::time_point began_;
  double first_time_ = 0;
  std::vector<std::size_t> told_;  // warnings of each component
};

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Checkpoints at intervals, at a requested stop, and the final state.
#pragma once

#include <string>

#include "framework/simulation/interval.hpp"
#include "framework/simulation/simulation.hpp"

namespace tenon {

struct CheckpointOptions {
  std::string folder;
  Interval every;
};

/// Writes FOLDER/checkpoint-<step>.h5 (the last two are kept) and, at the end, FOLDER/final.h5.
class CheckpointOutput : public Observer {
 public:
  explicit CheckpointOutput(CheckpointOptions options) : options_(std::move(options)) {}
  void start(Simulation& simulation, bool restarted) override;
  void after_step(Simulation& simulation, bool last) override;

 private:
  void write(Simulation& simulation, const std::string& path);
  CheckpointOptions options_;
  IntervalClock clock_;
};

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
#include "framework/simulation/checkpoint_output.hpp"

namespace tenon {

void CheckpointOutput::start(Simulation& simulation, bool restarted) {
  // What an earlier run wrote after this state belongs to a history that is given up here.
  if (restarted)
    simulation.comm().vote_on_root([&] { CheckpointFiles::remove_later_than(options_.folder, simulation.steps()); });
  clock_ = IntervalClock(options_.every, simulation.start_time());
  clock_.reset(simulation.time(), simulation.steps());
  if (simulation.done()) write(simulation, options_.folder + "/final.h5");
}

void CheckpointOutput::after_step(Simulation& simulation, bool last) {
  const bool due = clock_.due(simulation.time(), simulation.steps());
  if (due || simulation.stopped()) {
    write(simulation, CheckpointFiles::name(options_.folder, simulation.steps()));
    simulation.comm().vote_on_root([&] { CheckpointFiles::prune(options_.folder); });
  }
  if (last && !simulation.stopped()) write(simulation, options_.folder + "/final.h5");
}

void CheckpointOutput::write(Simulation& simulation, const std::string& path) {
  const ScopedTimer timer(simulation.timers().phase("output: checkpoints"));
  CheckpointWriter file(simulation.comm(), path);
  simulation.save(file);
  file.finish();
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Forces between components that take their steps together.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "framework/simulation/component.hpp"

namespace tenon {

/// Something between components, such as contact. Its parties share one clock: each begins its step (velocities by the
/// forces of its own), the interaction acts, each ends it. Everything is collective unless it says local.
class Interaction {
 public:
  explicit Interaction(std::string name) : name_(std::move(name)) {}
  virtual ~Interaction() = default;
  Interaction(const Interaction&) = delete;
  Interaction& operator=(const Interaction&) = delete;

  const std::string& name() const { return name_; }
  /// Local. Those that step together; never empty, and never in two interactions.
  virtual const std::vector<Component*>& parties() const = 0;

  /// After the parties are initialized (or loaded), before the first step.
  virtual void initialize() = 0;
  /// Before the parties begin a step of length dt from `time`.
  virtual void prepare(double time, double dt) = 0;
  /// Between the halves of that step.
  virtual void act(double time, double dt) = 0;

  /// Local. Rows of its own account: what parties give it is supplied, what it keeps or takes is stored.
  virtual void energies(std::vector<EnergyTerm>& terms) = 0;
  /// Local. Columns of history.csv: this rank's share of each, summed exactly.
  virtual std::vector<std::pair<std::string, ExactSum>> amounts() { return {}; }
  virtual std::vector<HistoryValue> history_values() { return {}; }
  /// Local.
  virtual std::vector<SkipCount> skips() const { return {}; }
  /// Local; the same on every rank.
  virtual std::vector<std::string> warnings() const { return {}; }
  /// Lines of its report for the end of the log.
  virtual std::vector<std::string> report() { return {}; }

  virtual void save(CheckpointWriter& file) = 0;
  virtual void load(const CheckpointReader& file) = 0;
  virtual std::int64_t memory() const = 0;

  /// Local. Adds its phases to the table of the run.
  void use_timers(PhaseTimers& timers) { timers_ = &timers; }

 protected:
  PhaseTimer& phase(std::string_view phase) { return timers_->phase(name_ + ": " + std::string(phase)); }

 private:
  std::string name_;
  PhaseTimers own_timers_;
  PhaseTimers* timers_ = &own_timers_;
};

}  // namespace tenon

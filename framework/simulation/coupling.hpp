// SPDX-License-Identifier: BSD-3-Clause
// One field that goes from one component to another, and when.
#pragma once

#include <string>
#include <vector>

#include "framework/simulation/component.hpp"

namespace tenon {

/// When a coupling runs. slower_step: once per step of the slower of the two components (before it advances if it is
/// the target, after it has advanced if it is the source). source_step: after every step of the source.
enum class CouplingSchedule { slower_step, source_step };

/// A directed exchange. What it does with the field is the business of the class that implements it.
class Coupling {
 public:
  Coupling(std::string name, Component& source, Component& target, CouplingSchedule schedule)
      : name_(std::move(name)), source_(source), target_(target), schedule_(schedule) {}
  virtual ~Coupling() = default;
  Coupling(const Coupling&) = delete;
  Coupling& operator=(const Coupling&) = delete;

  const std::string& name() const { return name_; }
  Component& source() const { return source_; }
  Component& target() const { return target_; }
  CouplingSchedule schedule() const { return schedule_; }

  /// Collective. Prepares the exchange, once, after the components are initialized.
  virtual void initialize() = 0;
  /// Collective. Moves the present values of the source to the target.
  virtual void run() = 0;  // timed by `timer()`
  /// True if the first values must reach the target before the first step (point values do; totals have none yet).
  virtual bool runs_at_start() const = 0;

  /// Collective. Called before each step of the target, after what runs then: the target is about to advance to `time`
  /// (s), and may be given what it is to see at the end of that step.
  virtual void prepare(double) {}

  /// Lines of its report for the log, and amounts for history.csv: column name and this rank's share (summed exactly).
  virtual std::vector<std::string> report() = 0;
  virtual std::vector<std::pair<std::string, ExactSum>> amounts() { return {}; }

  /// Fields that frames show on the target's mesh, what is asked for only: where values come from, and how far.
  virtual std::vector<ExportPort> shown_on_target() { return {}; }

  virtual void save(CheckpointWriter& file) = 0;
  virtual void load(const CheckpointReader& file) = 0;
  virtual std::int64_t memory() const = 0;
  std::int64_t runs() const { return timer_->calls; }
  void use_timer(PhaseTimer& timer) { timer_ = &timer; }

 protected:
  PhaseTimer& timer() { return *timer_; }

 private:
  std::string name_;
  Component& source_;
  Component& target_;
  CouplingSchedule schedule_;
  PhaseTimer own_timer_;
  PhaseTimer* timer_ = &own_timer_;
};

}  // namespace tenon

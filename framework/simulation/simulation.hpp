// SPDX-License-Identifier: BSD-3-Clause
// Components with clocks of their own, the couplings between them, and the step that moves them all.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "framework/simulation/coupling.hpp"
#include "framework/simulation/energy_ledger.hpp"
#include "framework/simulation/interaction.hpp"
#include "framework/simulation/stop_request.hpp"

namespace tenon {

class Simulation;

/// Something that looks on: output, log, checkpoint. Collective.
class Observer {
 public:
  virtual ~Observer() = default;
  /// Before the first step of a run, fresh or restarted.
  virtual void start(Simulation& simulation, bool restarted) = 0;
  /// After a step; `last` when no further step follows.
  virtual void after_step(Simulation& simulation, bool last) = 0;
  /// After a step failed on all ranks together: keep what can be kept. Must not throw.
  virtual void after_failure(Simulation&) {}
};

/// A coupled run. The component with the smallest time step leads; the others follow when their own step is due, so
/// that each advances with a step of its own:
///   lead      couplings prepare the leader's step; it advances
///   couple    couplings that run at every step of the leader
///   follow    each component that is due: couplings towards it, which prepare its step; its step; couplings from it
///   observe   output, log and checkpoint that are due
/// Components that interact (contact) lead, or follow, together and have one step, the least of theirs.
/// No component ever advances by more than its limit, and all of them stand at the end time when the run is over.
class Simulation {
 public:
  Simulation(const Communicator& comm, Log& log, double start_time, double end_time);

  /// Before `initialize`. References stay valid.
  Component& add(std::unique_ptr<Component> component);
  Coupling& add(std::unique_ptr<Coupling> coupling);
  Interaction& add(std::unique_ptr<Interaction> interaction);
  Observer& add(std::unique_ptr<Observer> observer);

  /// Collective. Prepares everything; `checkpoint` continues an earlier run. Throws Error(usage) if the smallest step
  /// would take more than the greatest number of steps to the end.
  void initialize(const CheckpointReader* checkpoint = nullptr);
  /// Local. A run that would need more steps than this is refused by `initialize`, and ends when it has taken so many.
  void limit_steps(std::int64_t maximum) { maximum_steps_ = maximum; }
  /// Collective. Lets the observers begin; `run` does it if it was not done. The first moment at which anything is
  /// written.
  void start();
  /// Collective. One step of the leader. Must not be called when done().
  void step();
  /// Collective. Steps until done or until a stop is requested. If a step throws, observers keep what they can first.
  void run();

  /// At the end time, or a component has nothing more to do.
  bool done() const;
  /// "done", "stopped on request", and what the components say.
  std::string ending() const;
  /// Asked after every step, collectively; must outlive the run.
  void watch(StopRequest& stop) { stop_ = &stop; }
  /// True once a stop was requested: no step follows.
  bool stopped() const { return stopped_; }

  double time() const { return time_; }
  double start_time() const { return start_time_; }
  double end_time() const { return end_time_; }
  double dt() const { return dt_; }
  std::int64_t steps() const { return steps_; }
  Component& leader() const { return *leader_; }

  const Communicator& comm() const { return comm_; }
  Log& log() { return log_; }
  PhaseTimers& timers() { return timers_; }
  EnergyLedger& ledger() { return *ledger_; }
  const std::vector<std::unique_ptr<Component>>& components() const { return components_; }
  const std::vector<std::unique_ptr<Coupling>>& couplings() const { return couplings_; }
  const std::vector<std::unique_ptr<Interaction>>& interactions() const { return interactions_; }
  Component* find(std::string_view name) const;

  /// Collective. Writes the whole state.
  void save(CheckpointWriter& file);

 private:
  Interaction* interaction_of(const Component& component) const;
  const std::vector<Component*>& together(const Component& component) const;
  bool speaks(const Component& component) const;
  double step_of(Component& component) const;
  void advance(Component& component, double time, double dt);
  void choose_leader();
  double leader_step();
  void follow();
  bool due(Component& follower);
  void prepare_couplings(const Component* target, double time);
  void run_couplings(const Component* source, const Component* target, CouplingSchedule schedule);
  void load(const CheckpointReader& file);
  void refuse_too_many_steps();

  Communicator comm_;
  Log& log_;
  double start_time_, end_time_, time_, dt_ = 0;
  std::int64_t steps_ = 0, maximum_steps_ = std::numeric_limits<std::int64_t>::max();
  bool stopped_ = false, restarted_ = false, started_ = false;
  StopRequest* stop_ = nullptr;
  PhaseTimers timers_;
  std::vector<std::unique_ptr<Component>> components_;
  std::vector<std::unique_ptr<Coupling>> couplings_;
  std::vector<std::unique_ptr<Interaction>> interactions_;
  std::vector<std::vector<Component*>> together_;  // of each component: those that step when it does
  std::vector<std::unique_ptr<Observer>> observers_;
  std::unique_ptr<EnergyLedger> ledger_;
  Component* leader_ = nullptr;
};

}  // namespace tenon

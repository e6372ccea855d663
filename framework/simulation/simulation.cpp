// SPDX-License-Identifier: BSD-3-Clause
#include "framework/simulation/simulation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <limits>

namespace tenon {

namespace {

std::uint64_t mixed(std::uint64_t x) {  // the finaliser of splitmix64
  x ^= x >> 30, x *= 0xbf58476d1ce4e5b9u;
  x ^= x >> 27, x *= 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

// Collective. A sum over nodes and elements, so it does not depend on the ranks; it tells meshes of equal size apart.
std::int64_t fingerprint(const Mesh& mesh) {
  std::uint64_t sum = 0;
  for (const LocalIndex n : mesh.owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    std::uint64_t h = mixed(static_cast<std::uint64_t>(mesh.node_ids[i]) + 1);
    for (const double x : mesh.coordinates[i]) h = mixed(h ^ std::bit_cast<std::uint64_t>(x));
    sum += h;
  }
  for (const ElementBlock& block : mesh.blocks)
    for (LocalIndex e = 0; e < block.size(); ++e) {
      if (block.owners[static_cast<std::size_t>(e)] != mesh.comm.rank()) continue;
      std::uint64_t h = mixed(static_cast<std::uint64_t>(block.ids[static_cast<std::size_t>(e)]) + 0x9e3779b97f4a7c15u);
      for (const LocalIndex n : block.nodes(e))
        h = mixed(h ^ static_cast<std::uint64_t>(mesh.node_ids[static_cast<std::size_t>(n)]));
      sum += h;
    }
  return mesh.comm.sum(static_cast<std::int64_t>(sum));
}

// Collective. Throws Error(file) if the checkpoint is of another component or mesh.
void check_fit(const CheckpointReader& file, const Component& component) {
  const auto refuse = [&](const char* what) {
    throw Error(ExitCode::file,
                fmt::format("the checkpoint does not fit the scene: component '{}' {}; restart with the scene "
                            "that wrote it, or start without --restart",
                            component.name(), what));
  };
  if (!file.has(component.name() + ".type")) refuse("is not in it");
  if (file.text(component.name() + ".type") != component.type()) refuse("is of another type there");
  if (file.integer(component.name() + ".mesh") != fingerprint(component.mesh())) refuse("has another mesh there");
}

}  // namespace

Simulation::Simulation(const Communicator& comm, Log& log, double start_time, double end_time)
    : comm_(comm), log_(log), start_time_(start_time), end_time_(end_time), time_(start_time) {}

Component& Simulation::add(std::unique_ptr<Component> component) {
  component->use_timers(timers_);
  return *components_.emplace_back(std::move(component));
}

Coupling& Simulation::add(std::unique_ptr<Coupling> coupling) {
  return *couplings_.emplace_back(std::move(coupling));
}

Interaction& Simulation::add(std::unique_ptr<Interaction> interaction) {
  interaction->use_timers(timers_);
  return *interactions_.emplace_back(std::move(interaction));
}

Observer& Simulation::add(std::unique_ptr<Observer> observer) {
  return *observers_.emplace_back(std::move(observer));
}

Component* Simulation::find(std::string_view name) const {
  const auto found =
      std::find_if(components_.begin(), components_.end(), [&](const auto& c) { return c->name() == name; });
  return found == components_.end() ? nullptr : found->get();
}

void Simulation::initialize(const CheckpointReader* checkpoint) {
  std::vector<Component*> all;
  for (const auto& component : components_) all.push_back(component.get());
  std::vector<Interaction*> between;
  for (const auto& interaction : interactions_) between.push_back(interaction.get());
  together_.clear();
  for (Component* component : all) {
    const Interaction* interaction = interaction_of(*component);
    together_.push_back(interaction ? interaction->parties() : std::vector<Component*>{component});
  }
  ledger_ = std::make_unique<EnergyLedger>(comm_, all, between);
  {
    const ScopedTimer timer(timers_.phase("set-up"));
    for (const auto& component : components_) component->set_clock(start_time_);
    if (checkpoint) load(*checkpoint);
    for (const auto& component : components_) component->initialize();
    for (const auto& interaction : interactions_) interaction->initialize();
    for (const auto& coupling : couplings_) {
      coupling->use_timer(timers_.phase("transfer: " + coupling->name()));
      coupling->initialize();
    }
    if (!checkpoint) {
      ledger_->start();
      for (const auto& coupling : couplings_)
        if (coupling->runs_at_start()) coupling->run();
    }
  }
  restarted_ = checkpoint != nullptr;
  refuse_too_many_steps();
}

void Simulation::start() {
  started_ = true;
  for (const auto& observer : observers_) observer->start(*this, restarted_);
}

void Simulation::refuse_too_many_steps() {
  if (done()) return;
  double smallest = std::numeric_limits<double>::infinity();
  for (const auto& component : components_) smallest = std::min(smallest, component->time_step());
  const double needed = (end_time_ - time_) / smallest;
  if (needed <= static_cast<double>(maximum_steps_ - steps_)) return;
  throw Error(
      ExitCode::usage,
      fmt::format(
          "the run from {:.6g} s to {:.6g} s would take about {:.3g} steps of {:.3g} s, more than maximum_steps "
          "({}): check the units of end_time, or raise maximum_steps",
          time_, end_time_, needed, smallest, maximum_steps_));
}

void Simulation::run() {
  if (!started_) start();
  try {
    while (!done() && !stopped_) step();
  } catch (const Error&) {
    for (const auto& observer : observers_) observer->after_failure(*this);
    throw;
  }
}

bool Simulation::done() const {
  if (end_time_ - time_ <= 1e-12 * (end_time_ - start_time_)) return true;
  return std::any_of(components_.begin(), components_.end(), [](const auto& c) { return c->finished(); });
}

std::string Simulation::ending() const {
  std::string text = stopped_ ? "stopped on request" : "done";
  for (const auto& component : components_)
    if (const std::string what = component->ending(); !what.empty()) text += "; " + component->name() + ": " + what;
  return text;
}

void Simulation::step() {
  if (steps_ >= maximum_steps_)
    throw Error(
        ExitCode::unstable,
        fmt::format("{} steps were taken up to {:.6g} s and the end is at {:.6g} s: the time step has shrunk; look "
                    "at the limiting element in the log, or raise maximum_steps",
                    steps_, time_, end_time_));
  choose_leader();
  dt_ = leader_step();
  const std::vector<Component*>& leaders = together(*leader_);
  for (Component* component : leaders) prepare_couplings(component, time_ + dt_);
  advance(*leader_, time_, dt_);
  time_ = leader_->time();
  ++steps_;
  for (Component* component : leaders) run_couplings(component, nullptr, CouplingSchedule::source_step);
  // Those that step together are each other's equals: what goes between them goes when all have advanced.
  for (Component* source : leaders)
    for (Component* target : leaders) run_couplings(source, target, CouplingSchedule::slower_step);
  follow();
  const bool asked = stop_ && stop_->asked(comm_, steps_);
  stopped_ = asked && !done();
  for (const auto& observer : observers_) observer->after_step(*this, done() || stopped_);
}

Interaction* Simulation::interaction_of(const Component& component) const {
  for (const auto& interaction : interactions_)
    if (std::ranges::find(interaction->parties(), &component) != interaction->parties().end()) return interaction.get();
  return nullptr;
}

const std::vector<Component*>& Simulation::together(const Component& component) const {
  std::size_t i = 0;
  while (components_[i].get() != &component) ++i;
  return together_[i];
}

/// Of components that step together the first one speaks for all.
bool Simulation::speaks(const Component& component) const {
  const Interaction* interaction = interaction_of(component);
  return !interaction || interaction->parties().front() == &component;
}

double Simulation::step_of(Component& component) const {
  const Interaction* interaction = interaction_of(component);
  if (!interaction) return component.time_step();
  double least = std::numeric_limits<double>::infinity();
  for (Component* party : interaction->parties()) least = std::min(least, party->time_step());
  return least;
}

void Simulation::advance(Component& component, double time, double dt) {
  Interaction* interaction = interaction_of(component);
  if (!interaction) {
    component.advance(dt);
    return;
  }
  interaction->prepare(time, dt);
  for (Component* party : interaction->parties()) party->begin_step(dt);
  interaction->act(time, dt);
  for (Component* party : interaction->parties()) party->end_step(dt);
}

// The leader changes only when all clocks agree: a component that lags must not be asked to lead.
void Simulation::choose_leader() {
  const bool level =
      std::all_of(components_.begin(), components_.end(), [&](const auto& c) { return c->time() == time_; });
  if (leader_ && (!level || components_.size() == 1)) return;
  double smallest = std::numeric_limits<double>::infinity();
  leader_ = components_.front().get();
  for (const auto& component : components_) {
    if (!speaks(*component)) continue;
    const double dt = step_of(*component);
    if (dt < smallest) {
      smallest = dt;
      leader_ = component.get();
    }
  }
}

double Simulation::leader_step() {
  double dt = step_of(*leader_);
  for (const auto& component : components_)
    if (component.get() != leader_ && speaks(*component))
      dt = std::min(dt, step_of(*component) - (time_ - component->time()));
  const double left = end_time_ - time_;
  // A sliver of a step at the very end would only add round-off.
  return dt >= left * (1 - 1e-9) ? left : dt;
}

bool Simulation::due(Component& follower) {
  const double lag = time_ - follower.time();
  if (!(lag > 0)) return false;
  return done() || lag + dt_ > step_of(follower) * (1 - 1e-12) || follower.ends_step(time_);
}

void Simulation::follow() {
  const std::vector<Component*>& leaders = together(*leader_);
  for (const auto& component : components_) {
    if (component.get() == leader_ || !speaks(*component) || !due(*component)) continue;
    const std::vector<Component*>& followers = together(*component);
    for (Component* follower : followers) {
      for (Component* leader : leaders) run_couplings(leader, follower, CouplingSchedule::slower_step);
      for (const auto& other : components_)
        if (std::ranges::find(leaders, other.get()) == leaders.end() && other.get() != follower)
          run_couplings(other.get(), follower, CouplingSchedule::slower_step);
      prepare_couplings(follower, time_);
    }
    advance(*component, component->time(), time_ - component->time());
    for (Component* follower : followers) {
      follower->set_clock(time_);  // the same bits as the leader's, whatever t + (T - t) rounds to
      run_couplings(follower, nullptr, CouplingSchedule::source_step);
      for (Component* leader : leaders) run_couplings(follower, leader, CouplingSchedule::slower_step);
    }
    for (Component* source : followers)
      for (Component* target : followers) run_couplings(source, target, CouplingSchedule::slower_step);
  }
}

void Simulation::prepare_couplings(const Component* target, double time) {
  for (const auto& coupling : couplings_)
    if (&coupling->target() == target) coupling->prepare(time);
}

void Simulation::run_couplings(const Component* source, const Component* target, CouplingSchedule schedule) {
  for (const auto& coupling : couplings_) {
    if (&coupling->source() != source || coupling->schedule() != schedule) continue;
    if (target && &coupling->target() != target) continue;
    coupling->run();
  }
}

void Simulation::save(CheckpointWriter& file) {
  file.scalar("time", time_);
  file.scalar("dt", dt_);
  file.integer("step", steps_);
  file.text("leader", leader_ ? leader_->name() : "");
  ledger_->save(file);
  for (const auto& component : components_) {
    file.scalar(component->name() + ".time", component->time());
    file.text(component->name() + ".type", std::string(component->type()));
    file.integer(component->name() + ".mesh", fingerprint(component->mesh()));
    component->save(file);
  }
  for (const auto& interaction : interactions_) interaction->save(file);
  for (const auto& coupling : couplings_) coupling->save(file);
}

void Simulation::load(const CheckpointReader& file) {
  for (const auto& component : components_) check_fit(file, *component);
  time_ = file.scalar("time");
  if (time_ > end_time_)
    throw Error(ExitCode::usage,
                fmt::format("the checkpoint is of {:.6g} s, after end_time ({:.6g} s): give a later end_time, "
                            "or start without --restart",
                            time_, end_time_));
  dt_ = file.scalar("dt");
  steps_ = file.integer("step");
  leader_ = find(file.text("leader"));
  ledger_->load(file);
  for (const auto& component : components_) {
    component->set_clock(file.scalar(component->name() + ".time"));
    component->load(file);
  }
  for (const auto& interaction : interactions_) interaction->load(file);
  for (const auto& coupling : couplings_) coupling->load(file);
}

}  // namespace tenon

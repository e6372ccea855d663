// SPDX-License-Identifier: BSD-3-Clause
// What a physics component is to the rest: a mesh, a clock, fields that it gives and takes, energies, a state to save.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framework/base/log.hpp"
#include "framework/base/timers.hpp"
#include "framework/fields/field.hpp"
#include "framework/io/checkpoint.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon {

class ContactParty;

/// A field that a component shows or gives away: fills an array of all local items (owned and ghost; elements of all
/// blocks one after the other) x components. Reading a `total` that accumulates takes it: the next read starts from
/// zero.
struct ExportPort {
  FieldDescription field;
  std::function<void(std::span<double>)> read;
};

/// A field that a component accepts, for all local items. A `total` is added to what is waiting; others replace.
struct ImportPort {
  FieldDescription field;
  std::function<void(std::span<const double>)> write;
  /// Why it must be filled after every step of its source, and what else would do; empty: it need not be.
  std::string at_source_steps = "";
};

/// One row of the energy ledger, J. Stored rows plus the initial total equal the supplied rows to round-off; memo rows
/// are shown but not added ("of which").
struct EnergyTerm {
  enum class Role { stored, supplied, memo };
  std::string row;  ///< "kinetic_energy", "internal_energy", "hourglass_energy", "viscosity_energy", "wall_energy", ...
  Role role = Role::stored;
  ExactSum local;  ///< this rank's share; owned items only
};

/// What limits the time step, for the log and `plan`.
struct StepLimiter {
  double dt = 0;       ///< s
  std::string reason;  ///< "element 12 of block bar at (x, y, z)", "time_step.fixed"
};

/// An extremum or point value for history.csv.
struct HistoryValue {
  std::string column;
  enum class Reduce { max, min, sum } reduce = Reduce::max;
  double local = 0;
};

/// What the scene does not need and this component therefore leaves out; counted for the last table.
struct SkipCount {
  std::string what;
  std::int64_t times = 0;
};

/// A physics component. Everything is collective over the component's communicator unless it says local. A component
/// never knows another one: it only reads and writes its own fields.
class Component {
 public:
  explicit Component(std::string name) : name_(std::move(name)) {}
  virtual ~Component() = default;
  Component(const Component&) = delete;
  Component& operator=(const Component&) = delete;

  const std::string& name() const { return name_; }
  virtual std::string_view type() const = 0;
  virtual const Mesh& mesh() const = 0;
  double time() const { return time_; }
  /// Local. Sets the clock: by the simulation at the start of a run and on restart only.
  void set_clock(double time) { time_ = time; }

  /// Prepares the state at the start time, or after `load`. Called once, before the first step.
  virtual void initialize() = 0;
  /// The greatest step that the component may take now, s; the same on every rank. Infinity if it has no limit.
  virtual double time_step() = 0;
  virtual StepLimiter limiter() = 0;
  /// Whether the step is to end at `now`, though time_step() allows more: for components that choose their step from
  /// what comes from outside. Asked of those that lag behind; `advance` to `now` follows a yes.
  virtual bool ends_step(double) { return false; }
  /// Local. True once nothing more will happen: the run ends early. The same on every rank.
  virtual bool finished() const { return false; }
  /// Local. What a user should know about how the run ended, if anything; the same on every rank.
  virtual std::string ending() const { return ""; }
  /// Advances by dt <= time_step() to time() + dt. Throws Error(unstable) or Error(geometry) on all ranks together.
  virtual void advance(double dt) = 0;

  /// The two halves of `advance`, for components that interact with others in between: velocities by the component's
  /// own forces, then places by the velocities, and forces there.
  virtual void begin_step(double) {}
  virtual void end_step(double dt) { advance(dt); }
  /// Collective. What contact sees of it; null if it cannot touch anything.
  virtual ContactParty* contact_party() { return nullptr; }

  /// Local. Every field that can be shown or given away, and every one that is accepted.
  virtual std::vector<ExportPort> exports() = 0;
  virtual std::vector<ImportPort> imports() = 0;
  /// Local. Present (deformed) coordinates of all local nodes, m.
  virtual std::span<const Vec3> current_coordinates() const = 0;

  /// Local. Appends this rank's share of every row.
  virtual void energies(std::vector<EnergyTerm>& terms) = 0;
  /// Local.
  virtual std::vector<HistoryValue> history_values() { return {}; }
  virtual std::vector<SkipCount> skips() const { return {}; }
  /// Local. What a user should know before the first step; the same on every rank.
  virtual std::vector<std::string> warnings() const { return {}; }

  /// State beyond what `initialize` makes from the scene; names are prefixed by the component.
  virtual void save(CheckpointWriter& file) = 0;
  virtual void load(const CheckpointReader& file) = 0;

  /// Local. Adds this component's phases to the table of the run.
  void use_timers(PhaseTimers& timers) { timers_ = &timers; }

  /// Local. Element-steps (or node-steps) done, for rates; bytes held in state arrays.
  virtual std::int64_t work_done() const = 0;
  virtual std::int64_t memory() const = 0;

 protected:
  PhaseTimer& phase(std::string_view phase) { return timers_->phase(name_ + ": " + std::string(phase)); }
  void set_time(double t) { time_ = t; }

 private:
  std::string name_;
  double time_ = 0;
  PhaseTimers own_timers_;
  PhaseTimers* timers_ = &own_timers_;
};

}  // namespace tenon

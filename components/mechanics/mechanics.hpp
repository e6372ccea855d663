// SPDX-License-Identifier: BSD-3-Clause
// Explicit finite elements: a deformable body, by central differences in time.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "components/mechanics/assembled_step.hpp"
#include "components/mechanics/contact_side.hpp"
#include "components/mechanics/element_groups.hpp"
#include "components/mechanics/kinetic_relaxation.hpp"
#include "components/mechanics/loads.hpp"
#include "components/mechanics/mass_scaling.hpp"
#include "components/mechanics/mechanics_options.hpp"
#include "components/mechanics/nodal_conditions.hpp"
#include "components/mechanics/nodal_state.hpp"
#include "components/mechanics/rigid_bodies.hpp"
#include "components/mechanics/subcycling.hpp"
#include "components/mechanics/ties.hpp"
#include "framework/simulation/component.hpp"
#include "framework/simulation/debris.hpp"

namespace tenon {

/// Velocities live half a step behind positions: v(n+1/2) = v(n-1/2) - dt f(n)/m, x(n+1) = x(n) + dt v(n+1/2), with the
/// first kick over dt/2. Stresses and forces always belong to the present positions. Elements that touch a node of this
/// rank are computed here, ghosts too, in ascending global order, so that one exchange of velocities per step is all
/// communication, and forces are the same bits on any number of ranks.
///
/// With subcycling (Subcycling), what is called a step below is one of the shortest; the simulation sees one of the
/// longest, which has 2^n of them.
///
/// Energies: the work at each kick, dt f . (v- + v+)/2, is exactly the change of kinetic energy (of the half-step
/// velocities). Internal energy is the work of all element forces less what hourglass control and viscosity took.
class Mechanics final : public Component, public DebrisSource {
 public:
  /// Collective. Throws Error(usage) where options and mesh do not fit.
  Mechanics(std::string name, std::shared_ptr<const Mesh> mesh, MechanicsOptions options);

  std::string_view type() const override { return "explicit_mechanics"; }
  const Mesh& mesh() const override { return *mesh_; }

  void initialize() override;
  double time_step() override { return stable_step_; }
  bool finished() const override { return relaxation_ && relaxation_->converged(); }
  std::string ending() const override { return relaxation_ ? relaxation_->report() : ""; }
  StepLimiter limiter() override;
  void advance(double dt) override;
  void begin_step(double dt) override;
  void end_step(double dt) override;
  /// Made by the first call. Throws Error(usage) with subcycling.
  ContactParty* contact_party() override;

  std::vector<ExportPort> exports() override;
  std::vector<ImportPort> imports() override;
  std::span<const Vec3> current_coordinates() const override { return nodes_.position(); }

  void give_up(const std::string& block) override;
  bool has_debris(const std::string& block) const override;
  std::vector<Debris> take_debris(const std::string& block) override;

  void energies(std::vector<EnergyTerm>& terms) override;
  std::vector<HistoryValue> history_values() override;
  std::vector<SkipCount> skips() const override;

  void save(CheckpointWriter& file) override;
  void load(const CheckpointReader& file) override;

  std::int64_t work_done() const override { return work_done_; }
  std::int64_t memory() const override;

  /// What a user should know but need not change; for the log.
  std::vector<std::string> warnings() const override { return warnings_; }
  /// Nodal masses, kg; complete on owned nodes.
  std::span<const double> nodal_mass() const { return nodes_.mass; }
  /// Internal forces at the present positions (resisting), N; complete on owned nodes. With subcycling impulses
  /// instead.
  std::span<const ForceRow> internal_force() const { return nodes_.force; }
  const RigidBodies& rigid_bodies() const { return *rigid_; }
  /// Null unless the options ask for it.
  const KineticRelaxation* relaxation() const { return relaxation_.get(); }
  /// Null unless the options ask for it, and before `initialize`.
  const Subcycling* subcycling() const { return subcycling_.get(); }

 private:
  // Set-up.
  void make_groups();
  void sum_masses();
  void set_temperatures();
  void set_loads();
  void set_constraints();
  void refuse_misfits() const;
  void follow_limit();
  void set_velocities();
  void set_spins();
  // Phases of a step.
  void take_step(int step, double now, double dt);
  void stop_if_bad();
  void blend_forces(double dt);
  void kick(int step, double now, double dt);
  void finish_kick(double now, double dt);
  void finish_step(double dt);
  void take_short_steps(double dt);
  double kick_length(double dt) const { return 0.5 * (previous_dt_ + dt); }
  std::int64_t local_deaths() const;
  void follow_deaths();
  void sum_removed();
  bool any_gone() const;
  void drop_gone_masses();
  void invert_masses();
  void save_departed(CheckpointWriter& file) const;
  void load_departed(const CheckpointReader& file);
  std::size_t giving_block(const std::string& block) const;
  void set_rigid_rates();
  void set_bound_rates();
  void refresh_ghosts();
  void drift(int step, double dt);
  void forget_steps();
  void compute_forces(int step, double dt);
  void advance_groups(int level, double dt);
  void choose_step();
  double short_step(double limit) const;
  void warn_of_instability();
  void search_step();
  bool search_is_due() const;
  void exchange_nodal_values(ElementGroup& group);
  // Subcycling.
  void choose_levels();
  bool levels_are_due() const;
  void split(const ElementLevels& levels);
  std::vector<int> busy_nodes() const;
  std::vector<std::int32_t> stiff_nodes() const;
  void save_levels(CheckpointWriter& file);
  void load_levels(const CheckpointReader& file);
  ElementGroup* any_group(std::size_t block) const;
  void report_levels();
  int short_steps() const { return subcycling_ ? subcycling_->steps() : 1; }
  // Messages.
  [[noreturn]] void fail(double code);
  std::string describe(const ElementGroup& group, LocalIndex element) const;
  static GlobalId global_id(const ElementGroup& group, LocalIndex element) {
    return group.elements().ids[static_cast<std::size_t>(element)];
  }
  // Fields.
  template <typename Value>
  ExportPort element_port(std::string field, int components, std::string unit, Value value);
  void take_temperature(std::span<const double> values);
  void give_heat(std::span<double> values);
  void add_contact_ports(std::vector<ExportPort>& ports);
  static double heat(const ElementGroup& group, LocalIndex element);

  std::shared_ptr<const Mesh> mesh_;
  MechanicsOptions options_;
  NodalConditions conditions_;
  NodalState nodes_;
  ElementGroups groups_;
  std::deque<ElementBlock> parts_;                      // elements of one block and level, where blocks are split
  std::vector<ForceRow> former_force_, former_moment_;  // by the levels before; only until the next kick
  ElementLevels levels_;                                // as they are split
  std::unique_ptr<Subcycling> subcycling_;              // if asked for
  std::unique_ptr<Loads> loads_;
  std::unique_ptr<KineticRelaxation> relaxation_;  // if asked for
  std::unique_ptr<RigidBodies> rigid_;
  std::unique_ptr<Ties> ties_;
  AddedMass added_mass_;
  std::unique_ptr<LooseNodes> loose_;     // where elements can die
  std::array<double, 4> removed_{};       // of all ranks: mass, kg, and momentum, kg m/s
  std::unique_ptr<ContactSide> contact_;  // if asked for
  std::int64_t deaths_ = 0;               // of elements of this rank, as of the last step
  std::int64_t death_events_ = 0;         // steps in which elements have died on any rank
  /// Of each block: what has become particles. Elements as in its group.
  struct GivenUp {
    bool any = false;            // what fails is given up
    std::int64_t followed = 0;   // events
    std::vector<char> departed;  // 1: mass, momentum and energy have left
    std::vector<double> energy;  // that energy, J
  };
  std::vector<GivenUp> given_up_;

  double previous_dt_ = 0;  // of the last half step
  double stable_step_ = 0;  // what time_step() says
  double estimate_ = 0;     // of the elements, without scale; of a short step
  double shortest_ = 0;     // least of what the elements allow, whatever their level
  double limit_ = 0;        // of the mesh, without scale; the estimate of the elements where that is not followed
  double last_good_ = 0;    // the limit before, for messages
  double first_estimate_ = 0;
  std::unique_ptr<AssembledStep> assembled_;  // none where the elements alone decide
  double verified_step_ = 0;                  // of the mesh when it was last searched, s
  std::int64_t searched_at_ = 0, search_interval_ = 0;
  GroupStep local_least_{};  // of this rank
  double local_shortest_ = 0;
  double leveled_shortest_ = 0;  // when the levels were chosen
  std::int64_t leveled_at_ = 0;
  std::size_t local_least_group_ = 0;
  int passes_ = 1;  // of the group with the most
  bool started_ = false;
  bool loaded_ = false;
  bool warned_ = false;  // of an unstable step
  std::int64_t work_done_ = 0, work_spared_ = 0, steps_ = 0;
  std::vector<std::int64_t> owned_elements_;  // by level
  std::vector<std::string> warnings_;

  struct Phases {
    PhaseTimer *forces, *update, *halo, *reduce;
  } phases_{};
};

}  // namespace tenon

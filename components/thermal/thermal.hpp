// SPDX-License-Identifier: BSD-3-Clause
// Heat conduction in solids: rho c dT/dt = div(k grad T) + q, explicit or implicit, on a body that may move.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "components/thermal/conduction_matrix.hpp"
#include "components/thermal/conjugate_gradient.hpp"
#include "components/thermal/contact_conductance.hpp"
#include "components/thermal/heat_content.hpp"
#include "components/thermal/surface.hpp"
#include "components/thermal/thermal_options.hpp"
#include "framework/simulation/component.hpp"

namespace tenon {

/// Linear finite elements with lumped capacity [HUG87]. Capacity belongs to the reference configuration (mass is kept),
/// conduction and surfaces to the current one. One step of the theta method (0 explicit, 1/2 Crank-Nicolson, 1 backward
/// Euler) solves for the increment d of temperature
///   (C + theta dt (K + H)) d = dt (loads at the weighted time + H (ambient - T) - K T) + heat received,
/// so that nothing is lost to the size of T itself. The state is the rise above the initial temperature. TR-BDF2, the
/// steady state, and everything whose coefficients depend on the temperature go by stages (thermal_stage.cpp).
class Thermal : public Component {
 public:
  /// Throws Error(usage) if options and mesh do not fit.
  Thermal(std::string name, std::shared_ptr<const Mesh> mesh, ThermalOptions options);

  std::string_view type() const override { return "heat_conduction"; }
  const Mesh& mesh() const override { return *mesh_; }
  void initialize() override;
  double time_step() override;
  StepLimiter limiter() override;
  bool ends_step(double now) override;
  void advance(double dt) override;
  std::vector<ExportPort> exports() override;
  std::vector<ImportPort> imports() override;
  std::span<const Vec3> current_coordinates() const override { return coordinates_; }
  void energies(std::vector<EnergyTerm>& terms) override;
  std::vector<HistoryValue> history_values() override;
  std::vector<SkipCount> skips() const override;
  void save(CheckpointWriter& file) override;
  void load(const CheckpointReader& file) override;
  std::int64_t work_done() const override { return element_steps_; }
  std::int64_t memory() const override;

  /// Present temperature of all local nodes, K.
  std::span<const double> temperature() const {
    return std::span(temperature_).first(static_cast<std::size_t>(mesh_->nodes()));
  }
  /// Collective. Heat that passes now from the first to the second surface of a contact (in the order of the options,
  /// which have it), W.
  double contact_power(std::size_t contact) const { return contact_->power(contact, temperature_); }
  /// Greatest explicit step at the present geometry, s: 2 / bound of the greatest eigenvalue. Explicit stepper only.
  double stable_limit();
  /// Of the last implicit step.
  const thermal::SolveReport& last_solve() const { return last_solve_; }
  bool uses_multigrid() const { return multigrid_chosen_; }
  std::int64_t solver_iterations() const { return solver_iterations_; }
  /// Newton's iterations (each with one linear solve) since the start, and TR-BDF2 steps that were taken and repeated.
  std::int64_t newton_iterations() const { return newton_iterations_; }
  std::int64_t steps_taken() const { return steps_taken_; }
  std::int64_t steps_repeated() const { return steps_repeated_; }

 private:
  /// Where supplied energy comes from; each is booked node by node, so that no sum depends on the ranks.
  enum Supply { transferred, flux, convection, source, prescribed, radiation, steady, supplies };
  struct FluxLoad {
    thermal::Surface surface;
    TimeFunction flux;
  };
  struct ConvectionLoad {
    thermal::Surface surface;
    double coefficient;
    TimeFunction ambient;
  };
  struct RadiationLoad {
    thermal::Surface surface;
    double emissivity;
    TimeFunction ambient;
  };
  struct SourceLoad {
    std::vector<LocalIndex> rows;
    std::vector<double> volumes;  // m^3, reference
    TimeFunction power;
  };
  struct Held {
    LocalIndex row;
    std::size_t function;
  };
  bool is_explicit() const { return options_.stepper == ThermalStepper::explicit_euler; }
  bool chooses_step() const { return options_.stepper == ThermalStepper::tr_bdf2 && !options_.fixed_step; }
  bool is_steady() const { return options_.stepper == ThermalStepper::steady; }
  /// Coefficients depend on the temperature.
  bool is_nonlinear() const { return warm_conductivity_ || !content_.is_linear() || !options_.radiation.empty(); }
  bool goes_by_stages() const { return is_nonlinear() || is_steady() || options_.stepper == ThermalStepper::tr_bdf2; }
  double theta() const;

  // Set-up.
  void find_blocks();
  void make_capacity();
  thermal::HeatContent make_content(const std::vector<std::map<LocalIndex, double>>& masses) const;
  void make_loads();
  void make_held();
  void set_initial_temperatures();
  void set_initial(const InitialTemperature& initial);
  void prepare_solution();
  void check_fixed_step();
  void check_stepper() const;

  // Geometry.
  void refresh_geometry();
  void assemble();
  thermal::ConductionMatrix::BadElement assemble_matrix();
  void add_film_links(const ConvectionLoad& load);
  void find_stiffest();
  void find_contacts();
  void weigh_contacts(double at);
  void follow_contacts(double at);
  void book_contacts(double weight, std::vector<double>& heat) const;
  void throw_if_inverted(const thermal::ConductionMatrix::BadElement& bad) const;
  std::string describe(LocalIndex block, LocalIndex element) const;

  // The step.
  void advance_at_once(double dt);
  void gather_loads(double dt);
  void add_conduction(double dt);
  void hold_prescribed(double end);
  void solve_explicit();
  void solve_implicit(double dt);
  thermal::SolveReport solve_linear(const thermal::HeatSystem& system, std::span<const double> b, double tolerance);
  thermal::Multigrid& multigrid_for(const thermal::HeatSystem& system);
  void book_reactions(double dt);
  double balance_shift() const;
  void apply_increment();
  void show_temperatures();
  void throw_if_not_finite() const;

  // Steps by stages.
  void advance_by_stages(double dt);
  void theta_step(double dt);
  bool tr_bdf2_stages(double start, double dt);
  bool tr_bdf2_step(double start, double dt);
  double error_of_step(double dt);
  void choose_step(double dt, double error, bool taken);
  void first_step();
  double capacity_of_change(std::size_t k, double heat) const;
  double withheld_change(double now);
  void tr_bdf2_steps(double dt);
  void steady_step(double dt);
  /// Calls use(kind, row, W) for every load at a time and the present temperature.
  template <typename Use>
  void each_load(double time, const Use& use) const;
  double absolute_ambient(const RadiationLoad& load, double time) const;
  void evaluate(double time);
  void book(double weight, double time);
  double node_energy(std::size_t k) const;
  void hold(double time);
  bool solve_stage(double factor, double time);
  double stage_residual(double factor);
  void stage_matrix(double factor);
  bool newton_converged(double size, double first) const;
  void apply_newton();
  void begin_stages();
  void end_stages();
  [[noreturn]] void refuse_newton(double time) const;

  // Ports and state.
  void read_heat_flux(std::span<double> out) const;
  void receive_heat(std::span<const double> values);
  void receive_displacement(std::span<const double> values);
  void receive_pressure(std::span<const double> values);
  std::vector<std::pair<std::string, std::vector<double>*>> owned_state();

  std::shared_ptr<const Mesh> mesh_;
  ThermalOptions options_;
  std::vector<std::size_t> block_options_;  // of each mesh block, in options_.blocks
  thermal::ConductionMatrix matrix_;
  thermal::ConjugateGradient solver_;
  std::vector<FluxLoad> flux_loads_;
  std::vector<ConvectionLoad> convection_loads_;
  std::vector<RadiationLoad> radiation_loads_;
  std::vector<SourceLoad> source_loads_;
  thermal::HeatContent content_;
  std::vector<Held> held_;
  std::unique_ptr<thermal::ContactConductance> contact_;  // nullptr without

  // Of all local nodes.
  std::vector<Vec3> coordinates_;     // current, m
  std::vector<double> displacement_;  // 3 per node, m
  // ... and those that contact brings in from other ranks: the width of the matrix.
  std::vector<double> temperature_;  // K
  std::vector<double> increment_;    // of the last step, K
  std::vector<double> pressure_;     // of contact, Pa; kept only if a conductance depends on it

  // Of the owned nodes.
  std::vector<double> initial_, rise_;  // K; temperature = initial + rise
  std::vector<double> capacity_;        // J/K
  std::vector<double> volume_;          // m^3, reference
  std::vector<double> film_;            // rows of H: coefficient times area, W/K
  std::vector<double> waiting_heat_;    // received, not yet in the temperature, J
  std::vector<double> right_side_;      // energy that the step brings each node before implicit terms, J
  std::vector<double> residual_;        // J
  std::vector<double> diagonal_, inverse_diagonal_;
  std::vector<double> passed_,
      pending_passed_;  // from first to second surfaces of contacts, of the taken and this step, J
  std::array<std::vector<double>, supplies> supplied_;  // J since the start; empty unless booked
  std::array<bool, supplies> booked_{};                 // supplies that the scene has

  // Of the owned nodes, for steps by stages only.
  std::vector<double> rate_;                   // heat that flows to each node, reactions apart, W
  std::vector<double> first_rate_, mid_rate_;  // of TR-BDF2's first two stages, W
  std::vector<double> target_;                 // energy that a stage aims at, its own rate apart, J
  std::vector<double> start_rise_, start_energy_;
  std::vector<double> given_;                          // energy that the step gives each node, reactions apart, J
  std::vector<double> received_;                       // waiting heat that is fed in over the present step, W
  std::array<std::vector<double>, supplies> pending_;  // to be booked if the step is taken, J

  std::unique_ptr<thermal::Multigrid> multigrid_;
  bool multigrid_chosen_ = false;   // the diagonal was not enough
  bool multigrid_stale_ = true;     // the matrix has changed since it was built
  bool loaded_stale_ = true;        // ... when the checkpoint was written
  double multigrid_factor_ = 0;     // that it was built for
  bool warm_conductivity_ = false;  // some conductivity depends on the temperature
  double next_step_ = 0;            // that TR-BDF2 would take, s; 0: not chosen yet
  bool hastened_ = false;           // what came from outside ends the present step

  double last_dt_ = 0;
  double stiffest_ = 0;       // greatest eigenvalue bound over all ranks, 1/s
  double free_capacity_ = 0;  // of all nodes that are not held, J/K
  bool loaded_ = false;       // the state came from a checkpoint
  bool pressed_ = false;      // somebody says what the pressure of contact is
  bool displaced_ = false;    // a displacement was received since the last assembly
  bool moved_here_ = false;   // ... and it differs on this rank
  bool assembled_ = false;    // since the last step
  std::int64_t element_steps_ = 0, owned_elements_ = 0, skipped_assemblies_ = 0;
  std::int64_t solver_iterations_ = 0, newton_iterations_ = 0, steps_taken_ = 0, steps_repeated_ = 0;
  thermal::SolveReport last_solve_;
  PhaseTimer *assemble_time_ = nullptr, *load_time_ = nullptr, *solve_time_ = nullptr, *update_time_ = nullptr;
};

}  // namespace tenon

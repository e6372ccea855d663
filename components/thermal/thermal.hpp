// SPDX-License-Identifier: BSD-3-Clause
// Heat conduction in solids: rho c dT/dt = div(k grad T) + q, explicit or implicit, on a body that may move.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "components/thermal/conduction_matrix.hpp"
#include "components/thermal/conjugate_gradient.hpp"
#include "components/thermal/surface.hpp"
#include "components/thermal/thermal_options.hpp"
#include "framework/simulation/component.hpp"

namespace tenon {

/// Linear finite elements with lumped capacity [HUG87]. Capacity belongs to the reference configuration (mass is kept),
/// conduction and surfaces to the current one. One step of the theta method (0 explicit, 1/2 Crank-Nicolson, 1 backward
/// Euler) solves for the increment d of temperature
///   (C + theta dt (K + H)) d = dt (loads at the weighted time + H (ambient - T) - K T) + heat received,
/// so that nothing is lost to the size of T itself. The state is the rise above the initial temperature.
class Thermal : public Component {
 public:
  /// Throws Error(usage) if options and mesh do not fit.
  Thermal(std::string name, std::shared_ptr<const Mesh> mesh, ThermalOptions options);

  std::string_view type() const override { return "heat_conduction"; }
  const Mesh& mesh() const override { return *mesh_; }
  void initialize() override;
  double time_step() override;
  StepLimiter limiter() override;
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
  std::span<const double> temperature() const { return temperature_; }
  /// Greatest explicit step at the present geometry, s: 2 / bound of the greatest eigenvalue. Explicit stepper only.
  double stable_limit();
  /// Of the last implicit step.
  const thermal::SolveReport& last_solve() const { return last_solve_; }
  std::int64_t solver_iterations() const { return solver_iterations_; }

 private:
  /// Where supplied energy comes from; each is booked node by node, so that no sum depends on the ranks.
  enum Supply { transferred, flux, convection, source, prescribed, supplies };
  struct FluxLoad {
    thermal::Surface surface;
    TimeFunction flux;
  };
  struct ConvectionLoad {
    thermal::Surface surface;
    double coefficient;
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
  /// A function of time as the theta method weighs it over the step.
  struct StepTime {
    double start, end, theta;
    double operator()(const TimeFunction& f) const {
      if (theta == 0) return f(start);
      return theta == 1 ? f(end) : (1 - theta) * f(start) + theta * f(end);
    }
  };

  bool is_explicit() const { return options_.stepper == ThermalStepper::explicit_euler; }
  double theta() const;

  // Set-up.
  void find_blocks();
  void make_capacity();
  void make_loads();
  void make_held();
  void set_initial_temperatures();
  void set_initial(const InitialTemperature& initial);
  void prepare_solution();
  void check_fixed_step();

  // Geometry.
  void refresh_geometry();
  void assemble();
  void add_film_links(const ConvectionLoad& load);
  void throw_if_inverted(const thermal::ConductionMatrix::BadElement& bad) const;
  std::string describe(LocalIndex block, LocalIndex element) const;

  // The step.
  void gather_loads(const StepTime& when, double dt);
  void add_load(Supply kind, LocalIndex row, double energy);
  void add_volume_sources(const StepTime& when, double dt);
  void add_convection(const StepTime& when, double dt);
  void add_conduction(double dt);
  void hold_prescribed(double end);
  void solve_explicit();
  void solve_implicit(double dt);
  void book_reactions(double dt);
  double balance_shift() const;
  void apply_increment();
  void show_temperatures();
  void throw_if_not_finite() const;

  // Ports and state.
  void read_heat_flux(std::span<double> out) const;
  void receive_heat(std::span<const double> values);
  void receive_displacement(std::span<const double> values);
  std::vector<std::pair<std::string, std::vector<double>*>> owned_state();

  std::shared_ptr<const Mesh> mesh_;
  ThermalOptions options_;
  std::vector<std::size_t> block_options_;  // of each mesh block, in options_.blocks
  thermal::ConductionMatrix matrix_;
  thermal::ConjugateGradient solver_;
  std::vector<FluxLoad> flux_loads_;
  std::vector<ConvectionLoad> convection_loads_;
  std::vector<SourceLoad> source_loads_;
  std::vector<Held> held_;

  // Of all local nodes.
  std::vector<Vec3> coordinates_;     // current, m
  std::vector<double> displacement_;  // 3 per node, m
  std::vector<double> temperature_;   // K
  std::vector<double> increment_;     // of the last step, K

  // Of the owned nodes.
  std::vector<double> initial_, rise_;  // K; temperature = initial + rise
  std::vector<double> capacity_;        // J/K
  std::vector<double> volume_;          // m^3, reference
  std::vector<double> film_;            // rows of H: coefficient times area, W/K
  std::vector<double> waiting_heat_;    // received, not yet in the temperature, J
  std::vector<double> right_side_;      // energy that the step brings each node before implicit terms, J
  std::vector<double> residual_;        // J
  std::vector<double> diagonal_, inverse_diagonal_;
  std::array<std::vector<double>, supplies> supplied_;  // J since the start; empty unless booked
  std::array<bool, supplies> booked_{};                 // supplies that the scene has

  double last_dt_ = 0;
  double stiffest_ = 0;       // greatest eigenvalue bound over all ranks, 1/s
  double free_capacity_ = 0;  // of all nodes that are not held, J/K
  bool loaded_ = false;       // the state came from a checkpoint
  bool displaced_ = false;    // a displacement was received since the last assembly
  bool moved_here_ = false;   // ... and it differs on this rank
  bool assembled_ = false;    // since the last step
  std::int64_t element_steps_ = 0, owned_elements_ = 0, skipped_assemblies_ = 0;
  std::int64_t solver_iterations_ = 0;
  thermal::SolveReport last_solve_;
  PhaseTimer *assemble_time_ = nullptr, *load_time_ = nullptr, *solve_time_ = nullptr, *update_time_ = nullptr;
};

}  // namespace tenon

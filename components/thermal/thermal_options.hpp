// SPDX-License-Identifier: BSD-3-Clause
// Everything that a heat conduction component is told.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/thermal/conductivity.hpp"
#include "components/thermal/heat_content.hpp"
#include "framework/base/time_function.hpp"
#include "framework/base/types.hpp"

namespace tenon {

enum class ThermalStepper { explicit_euler, backward_euler, crank_nicolson, tr_bdf2, steady };
enum class ThermalPreconditioner { automatic, jacobi, multigrid };

/// Material of one block.
struct ThermalBlock {
  std::string block;
  double density = 0;                     ///< kg/m^3, reference configuration
  double specific_heat = 0;               ///< J/(kg K)
  double conductivity = 0;                ///< W/(m K)
  double reference_temperature = 293.15;  ///< K; start temperature where no other is given

  // What takes the place of the two numbers, or adds to them; the steppers that are implicit only.
  std::optional<TemperatureTable> conductivity_over_temperature = {}, specific_heat_over_temperature = {};
  std::optional<std::array<Vec3, 3>> conductivity_tensor = {};  ///< W/(m K); also explicit
  double latent_heat = 0, solidus = 0, liquidus = 0;            ///< J/kg, K, K; no change of phase without latent heat
};

/// T = value + gradient . x at the nodes of a block, of a node set, or everywhere. Later entries win.
struct InitialTemperature {
  std::string block, node_set;  ///< at most one; neither means everywhere
  double value = 0;             ///< K
  Vec3 gradient{};              ///< K/m
};

/// Holds from the start time on. The reaction is booked as supplied energy. Later entries win at shared nodes.
struct PrescribedTemperature {
  std::string node_set;
  TimeFunction temperature;  ///< K
};

/// Into the body, per current area.
struct SurfaceFlux {
  std::string side_set;
  TimeFunction flux;  ///< W/m^2
};

/// coefficient (ambient - T) into the body, per current area.
struct Convection {
  std::string side_set;
  double coefficient = 0;  ///< W/(m^2 K)
  TimeFunction ambient;    ///< K
};

/// emissivity sigma (ambient^4 - T^4) into the body, absolute temperatures, per current area. Implicit steppers only.
struct Radiation {
  std::string side_set;
  double emissivity = 0;
  TimeFunction ambient;  ///< K
};

/// Heat passes between two surfaces that need not match: q = (h + k / max(gap, least gap)) (T_first - T_second), the
/// first term where they touch, the second where they are no farther apart than `greatest_gap`.
struct ThermalContact {
  std::string first, second;                             ///< side sets
  TimeFunction conductance = TimeFunction::constant(0);  ///< h, W/(m^2 K); at `reference_pressure` if that is given
  std::optional<double> reference_pressure = {};         ///< Pa; h grows as (p / this)^exponent
  double exponent = 0.95;
  std::optional<TimeFunction> over_pressure = {};  ///< h over p (Pa), in place of the three above
  double gap_conductivity = 0;                     ///< k, W/(m K)
  double least_gap = 0, greatest_gap = 0;          ///< m
  std::optional<double> touching_gap = {};         ///< m; without it a tenth of the size of a side
};

/// How the TR-BDF2 stepper chooses its step.
struct StepControl {
  double tolerance = 0.1;              ///< K, error of a step anywhere
  std::optional<double> initial = {};  ///< s, first step tried
  std::optional<double> maximum = {};  ///< s
};

/// Per reference volume, so that deformation neither makes nor destroys heat.
struct HeatSource {
  std::string block;
  TimeFunction power;  ///< W/m^3
};

struct ThermalOptions {
  std::vector<ThermalBlock> blocks;  ///< one for each block of the mesh, in any order
  ThermalStepper stepper = ThermalStepper::explicit_euler;
  std::optional<double> fixed_step;  ///< s; needed by backward Euler and Crank-Nicolson
  double step_scale = 0.9;           ///< of the stable limit; explicit only
  double tolerance = 1e-12;          ///< of the linear solver, relative to the right-hand side
  int max_iterations = 2000;
  double nonlinear_tolerance = 1e-8;  ///< of Newton's iterations, relative to the first residual of a stage
  ThermalPreconditioner preconditioner = ThermalPreconditioner::automatic;
  StepControl control;

  std::vector<InitialTemperature> initial;
  std::vector<PrescribedTemperature> prescribed;
  std::vector<SurfaceFlux> fluxes;
  std::vector<Convection> convection;
  std::vector<Radiation> radiation;
  std::vector<HeatSource> sources;
  std::vector<ThermalContact> contacts;

  /// For programs and manufactured solutions; a scene cannot give them. Positions are of the reference configuration
  /// (m).
  std::function<double(const Vec3&)> initial_function;         ///< K; wins over `initial`
  std::function<double(const Vec3&, double)> source_function;  ///< W/m^3 at a place and time
};

}  // namespace tenon

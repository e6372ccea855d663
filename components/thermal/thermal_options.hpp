// SPDX-License-Identifier: BSD-3-Clause
// Everything that a heat conduction component is told.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/time_function.hpp"
#include "framework/base/types.hpp"

namespace tenon {

enum class ThermalStepper { explicit_euler, backward_euler, crank_nicolson };

/// Material of one block.
struct ThermalBlock {
  std::string block;
  double density = 0;                     ///< kg/m^3, reference configuration
  double specific_heat = 0;               ///< J/(kg K)
  double conductivity = 0;                ///< W/(m K)
  double reference_temperature = 293.15;  ///< K; start temperature where no other is given
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

/// Per reference volume, so that deformation neither makes nor destroys heat.
struct HeatSource {
  std::string block;
  TimeFunction power;  ///< W/m^3
};

struct ThermalOptions {
  std::vector<ThermalBlock> blocks;  ///< one for each block of the mesh, in any order
  ThermalStepper stepper = ThermalStepper::explicit_euler;
  std::optional<double> fixed_step;  ///< s; needed by the implicit steppers
  double step_scale = 0.9;           ///< of the stable limit; explicit only
  double tolerance = 1e-12;          ///< of the linear solver, relative to the right-hand side
  int max_iterations = 2000;

  std::vector<InitialTemperature> initial;
  std::vector<PrescribedTemperature> prescribed;
  std::vector<SurfaceFlux> fluxes;
  std::vector<Convection> convection;
  std::vector<HeatSource> sources;

  /// For programs and manufactured solutions; a scene cannot give them. Positions are of the reference configuration
  /// (m).
  std::function<double(const Vec3&)> initial_function;         ///< K; wins over `initial`
  std::function<double(const Vec3&, double)> source_function;  ///< W/m^3 at a place and time
};

}  // namespace tenon

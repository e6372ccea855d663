// SPDX-License-Identifier: BSD-3-Clause
// Everything that a user may say about particles.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "components/materials/material.hpp"
#include "components/sph/particle_decomposition.hpp"
#include "components/sph/particle_domain.hpp"
#include "framework/base/space_time_function.hpp"
#include "framework/base/time_function.hpp"
#include "framework/base/types.hpp"

namespace tenon {

enum class SphKernelKind { wendland_c2, wendland_c4, cubic_spline, quintic_spline };

enum class SphFormulation {
  fluid,            ///< weakly compressible: pressure from density alone
  gas,              ///< compressible, with an energy equation: gases, shocks in anything with an equation of state
  solid,            ///< strength, on the present neighbours (updated Lagrangian, corrected gradients)
  total_lagrangian  ///< strength, on the neighbours of the start
};

/// Particles of a moving wall that have passed a plane are free, and belong to another body from then on.
struct SphInflow {
  Vec3 point{}, normal{1, 0, 0};  ///< of the plane: m, and where they go (of any length)
  std::size_t into = 0;           ///< index of the body
};

/// Particles of one block of the mesh.
struct SphBody {
  std::string name;
  MaterialDescription material;
  bool wall = false;                                     ///< does not feel forces: stands still, or moves as told
  std::array<TimeFunction, 3> velocity;                  ///< of a wall, m/s
  std::optional<SphInflow> inflow;                       ///< of a wall that brings particles in
  bool waits = false;                                    ///< not there until an element becomes it (DebrisTarget)
  std::array<SpaceTimeFunction, 3> initial_velocity;     ///< m/s, of the places at the start
  std::optional<SpaceTimeFunction> initial_pressure;     ///< Pa; the density follows from it, of gases the energy
  std::optional<SpaceTimeFunction> initial_density;      ///< kg/m^3; else that of the material
  std::optional<SpaceTimeFunction> initial_energy;       ///< J/kg, of gases
  std::optional<SpaceTimeFunction> initial_temperature;  ///< K
  std::optional<TimeFunction> held_temperature;          ///< K, whatever heat flows
  std::string bond;  ///< of total Lagrangian bodies: those with the same name here hold together, as at a clamp
};

/// Artificial viscosity [Mon92]: alpha and beta with the signal speed, switched off where nothing is compressed.
struct ArtificialViscosity {
  enum class Switch { none, balsara, cullen_dehnen } limiter = Switch::none;
  std::optional<double> alpha, beta;  ///< else what suits the formulation
};

/// Of solids: less than in gases, as stress keeps them together as well.
inline constexpr double solid_alpha = 0.1, solid_beta = 0.5;

struct FluidOptions {
  /// Artificial: by alpha, for stability alone; the others take the viscosity of the material, and resist all shear
  /// [MFZ97] or approach alone, which keeps angular momentum [Mon05].
  enum class Viscosity { artificial, morris, monaghan } viscosity = Viscosity::artificial;
  double density_diffusion = 0.1;     ///< delta of delta-SPH [MC09]; 0: none
  bool hydrostatic_diffusion = true;  ///< what gravity makes of density does not diffuse [FDVR19]
  /// Particles are carried from where they crowd: by a share of their speed, not at free surfaces [LXSR12]; or by a
  /// background pressure, in flows without free surfaces [AHA13].
  enum class Shifting { none, shifting, transport_velocity } shifting = Shifting::none;
  double shifting_strength = 1;    ///< over what is usual
  double background_pressure = 0;  ///< Pa: added to every pressure; for flows without free surfaces
  bool slip = true;                ///< walls let fluid pass along them
};

struct GasOptions {
  /// Summation: of masses around, exact where there is matter on all sides. Continuity: by the divergence of the
  /// velocity, for condensed matter with free surfaces.
  enum class Density { summation, continuity } density = Density::summation;
  double greatest_smoothing = 4;  ///< over the greatest smoothing length of the start: where following rho ends
};

struct SolidOptions {
  double hourglass = 10;         ///< of total Lagrangian bodies [Gan15]: resistance to modes without strain, 0: none
  double contact_stiffness = 1;  ///< of total Lagrangian bodies, of their own stiffness: what keeps them apart
  double artificial_stress = 0;  ///< of updated Lagrangian bodies [Mon00]: share of a tension that pairs do not feel
};

struct SphTimeStep {
  double cfl = 0.25;              ///< of smoothing length over signal speed
  std::optional<double> fixed;    ///< s
  std::optional<double> maximum;  ///< s
};

struct SphOptions {
  int dimension = 3;  ///< 2: z is left alone, and masses are per metre; 1: x only
  SphFormulation formulation = SphFormulation::fluid;
  SphKernelKind kernel = SphKernelKind::wendland_c2;
  double smoothing = 1.3;               ///< smoothing length over the spacing of particles
  bool variable_smoothing = false;      ///< h follows the density: h = smoothing (m/rho)^(1/d)
  std::vector<SphBody> bodies;          ///< every block of the mesh, in its order
  std::array<TimeFunction, 3> gravity;  ///< m/s^2
  ParticleDomain domain;
  ArtificialViscosity artificial_viscosity;
  double artificial_conduction = 0;  ///< alpha_u of gases [Pri08]: heat across jumps of energy, 0 none, 1 full
  FluidOptions fluid;
  GasOptions gas;
  SolidOptions solid;
  bool heat_conduction = false;  ///< between particles whose materials have thermal properties
  SphTimeStep time_step;
  double skin = 0.1;  ///< of the support: how far lists reach beyond it
  bool always_search = false;
  bool always_rebalance = false;                ///< for tests
  std::optional<std::int64_t> most_neighbours;  ///< DecompositionOptions; else most_neighbours_of()

  /// For programs; a scene cannot give it: shifts each particle at the start (m), by its place.
  std::function<Vec3(const Vec3&)> displaced;
  /// Likewise: velocity at the start (m/s), added to that of the body.
  std::function<Vec3(const Vec3&)> initial_velocity_function;
};

}  // namespace tenon

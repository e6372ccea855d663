// SPDX-License-Identifier: BSD-3-Clause
// Sums over the pairs of a weakly compressible fluid.
#pragma once

#include <vector>

#include "components/sph/pair_hits.hpp"
#include "components/sph/particle_data.hpp"
#include "components/sph/sph_options.hpp"
#include "framework/search/neighbour_lists.hpp"

namespace tenon {

/// One cache line of what a pair has to know of its other particle.
struct FluidRecord {
  double velocity[3];  ///< v(n), m/s
  double density;      ///< kg/m^3
  double pressure;     ///< Pa
  double volume;       ///< m/rho, m^3
  double viscosity;    ///< factor of the viscous force, Pa s
  double kind;         ///< number of the body; of walls -1 - number

  static constexpr std::size_t size = 8;
};

/// What the pairs of one body have in common.
struct FluidBody {
  double diffusion = 0;  ///< 2 delta c, m/s
  Vec3 hydrostatic{};    ///< gradient of density that gravity makes, kg/m^4
  bool wall = false;
  double sound = 0, density = 0;  ///< of the material at rest, m/s and kg/m^3
};

/// Columns and laws of one pass over all pairs:
///   drho_i/dt = sum_j V_j F (rho_i v_ij . x_ij + 2 delta c h (rho_i - rho_j - hydrostatic . x_ij))
///   rho_i a_i = - sum_j V_j F (p_i + p_j) x_ij + sum_j V_j F mu_ij (v_ij . x_ij) x_ij / r^2     or  2 mu_ij v_ij
/// with grad W = F x_ij, and mu_ij the harmonic mean.
struct FluidPass {
  const ParticleData& particles;
  const NeighbourLists& lists;
  const Column& places;  ///< records of x, y, z, h
  const Column& states;  ///< FluidRecords
  const Column* slip;    ///< of walls that hold on to the fluid: velocity that viscosity feels, and a zero
  std::span<const FluidBody> bodies;
  bool morris = false;  ///< viscous force along the velocity, not along the distance
  bool plain = false;   ///< one body without walls, one smoothing length, no shifting
  Column &density_rate, &pressure_acceleration, &viscous_acceleration, &acceleration;
  Column* crowding;  ///< gradient of the concentration, 1/m, and divergence of the places, 1; or null
  PairHits& hits;
};

void sum_fluid_pairs(const SphOptions& options, const FluidPass& pass);

}  // namespace tenon

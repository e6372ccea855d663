// SPDX-License-Identifier: BSD-3-Clause
// What walls of dummy particles take over from the fluid in front of them.
#pragma once

#include <span>

#include "components/sph/pair_hits.hpp"
#include "components/sph/particle_data.hpp"
#include "components/sph/sph_options.hpp"
#include "framework/search/neighbour_lists.hpp"

namespace tenon {

/// [AHA12]: the pressure of a wall particle is that of the fluid, extrapolated along gravity and the acceleration of
/// the wall, and, where fluid holds on to the wall, viscosity feels the velocity of the fluid mirrored about its own.
struct WallPass {
  const ParticleData& particles;
  const NeighbourLists& lists;
  const Column& places;
  Column& states;              ///< FluidRecords: pressures and viscosities of owned walls are written
  Column* slip;                ///< null: fluid slips along walls
  std::span<const Vec3> pull;  ///< of each body: gravity less its own acceleration, m/s^2
  double least_pressure;       ///< Pa: walls do not suck
  PairHits& hits;
};

void extrapolate_to_walls(const SphOptions& options, const WallPass& pass);

}  // namespace tenon

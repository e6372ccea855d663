// SPDX-License-Identifier: BSD-3-Clause
// Noh's implosion in a half line, a quarter or an octant.
#pragma once

#include "shock_case.hpp"

namespace tenon::testing {

/// `particles` per unit length of gas that rushes to the origin at 1 m/s, with mirrors across it.
inline SphScene noh(int particles, int dimension) {
  SphScene scene = gas_scene(dimension);
  const double spacing = 1.0 / particles;
  const Vec3 corner{1, dimension > 1 ? 1.0 : 0, dimension > 2 ? 1.0 : 0};
  scene.mesh = particle_bodies({{"gas", box_of_particles({0, 0, 0}, corner, spacing, dimension)}});
  SphBody gas = body_of("gas", ideal_gas(1, 5.0 / 3));
  gas.initial_pressure = SpaceTimeFunction::constant(1e-6);
  scene.options.bodies = {gas};
  scene.options.artificial_conduction = 0, scene.options.smoothing = 1.2;
  for (std::size_t c = 0; c < static_cast<std::size_t>(dimension); ++c) scene.options.domain.axes[c].low = 0;
  scene.options.initial_velocity_function = [](const Vec3& x) { return (-1 / norm(x)) * x; };
  scene.end = 0.6;
  return scene;
}

}  // namespace tenon::testing

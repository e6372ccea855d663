// SPDX-License-Identifier: BSD-3-Clause
// Water in a tank.
#pragma once

#include "fluid_case.hpp"

namespace tenon::testing {

inline constexpr double gravity = 9.81, density = 1000;

/// Water at rest at the lower left corner of a tank, under gravity.
inline SphScene water(const Vec3& size, const Vec3& space, double spacing, double alpha) {
  SphScene scene;
  const double sound = 10 * std::sqrt(2 * gravity * size[1]);
  const auto across = static_cast<int>(std::lround(size[0] / spacing));
  scene.mesh = particle_bodies(
      {{"water", flat_box({0, 0, 0}, {size[0], size[1], 0}, across)}, {"tank", tank({0, 0, 0}, space, spacing)}});
  SphBody fluid = body_of("water", liquid(density, sound)), wall = body_of("tank", liquid(density, sound));
  fluid.initial_pressure = of_place([=](const Vec3& x) { return density * gravity * (size[1] - x[1]); });
  wall.wall = true;
  scene.options.dimension = 2;
  scene.options.bodies = {fluid, wall};
  scene.options.fluid.slip = false;
  scene.options.artificial_viscosity.alpha = alpha;
  scene.options.gravity[1] = TimeFunction::constant(-gravity);
  scene.end = 10;
  return scene;
}

}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Water of particles in a plane, one metre thick, with bodies of elements that are as thick.
#pragma once

#include <optional>

#include "fluid_case.hpp"
#include "sph_contact_case.hpp"

namespace tenon::testing {

inline constexpr double earth = 9.81, of_water = 1000;  // m/s^2, kg/m^3

struct WaterShape {
  Vec3 low{}, high{};                                 ///< m, of the water at rest
  std::optional<Box> hole = {};                       ///< where there is none
  std::optional<Vec3> room_low = {}, room_high = {};  ///< of the tank; none: there is none
  double spacing = 0, sound = 0;
};

/// Water at rest under gravity, in a tank of dummy particles.
inline ParticlesOnMesh with_water(const WaterShape& shape) {
  ParticlesOnMesh s;
  const Vec3 size = shape.high - shape.low;
  const double half = 0.5 * shape.spacing;
  MeshData water = flat_box({shape.low[0], shape.low[1], 0}, {shape.high[0], shape.high[1], 0},
                            static_cast<int>(std::lround(size[0] / shape.spacing)));
  if (shape.hole)
    water = part_of(water, [&](const Vec3& x) {
      return x[0] < shape.hole->low[0] - 0.1 * half || x[0] > shape.hole->high[0] + 0.1 * half ||
             x[1] < shape.hole->low[1] - 0.1 * half || x[1] > shape.hole->high[1] + 0.1 * half;
    });
  std::vector<std::pair<std::string, MeshData>> bodies{{"water", std::move(water)}};
  s.sph.bodies = {body_of("water", liquid(of_water, shape.sound))};
  const double top = shape.high[1];
  s.sph.bodies[0].initial_pressure = of_place([top](const Vec3& x) { return of_water * earth * (top - x[1]); });
  if (shape.room_low) {
    bodies.emplace_back("tank", tank(*shape.room_low, *shape.room_high, shape.spacing));
    s.sph.bodies.push_back(body_of("tank", liquid(of_water, shape.sound)));
    s.sph.bodies[1].wall = true;
  }
  s.particles = particle_bodies(std::move(bodies));
  s.sph.dimension = 2;
  s.sph.gravity[1] = TimeFunction::constant(-earth);
  return s;
}

/// Elements between two corners in the plane, one metre thick.
inline MeshData thick_brick(const Vec3& low, const Vec3& high, int along_x, int along_y) {
  return brick({low[0], low[1], -0.5}, {high[0], high[1], 0.5}, {along_x, along_y, 1});
}

}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Just below the stable step an element rings for ever; just above it explodes.
#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

/// Lets a body breathe at `share` of the element estimate. True if it stays within bounds.
bool stable(const BoxShape& box, const MaterialDescription& material, const BulkViscosity& viscosity, double share,
            double size) {
  MechanicsOptions options;
  options.viscosity = viscosity;
  options.time_step.scale = share;
  options.hourglass.coefficient = 0.02;
  // Small enough to stay linear until it explodes.
  options.initial_velocity_function = [&](const Vec3& x) { return (1e-6 / size) * x; };
  const auto m = body(shared_mesh(on_root(box)), material, options);
  m->initialize();
  const double start = energy_rows(*m)["kinetic_energy"];
  try {
    for (int s = 0; s < 3000; ++s) m->advance(m->time_step());
  } catch (const Error&) {
    return false;
  }
  return energy_rows(*m)["kinetic_energy"] < 100 * start;
}

TEST(StableStep, SharpForABreathingCube) {
  BoxShape cube;
  cube.low = {-0.5, -0.5, -0.5}, cube.high = {0.5, 0.5, 0.5};
  for (const double nu : {0.0, 0.3, 0.49}) {
    const MaterialDescription material = elastic_material(210e9, nu, 7850);
    EXPECT_TRUE(stable(cube, material, {0, 0}, 0.99, 1)) << nu;
    EXPECT_FALSE(stable(cube, material, {0, 0}, 1.02, 1)) << nu;
    // The linear viscosity damps, and the shorter step that it asks for is sharp as well.
    EXPECT_TRUE(stable(cube, material, {0.06, 0}, 0.99, 1)) << nu;
    EXPECT_FALSE(stable(cube, material, {0.06, 0}, 1.02, 1)) << nu;
  }
}

TEST(StableStep, HoldsForSlenderAndDistortedElements) {
  for (const double aspect : {1e-3, 0.1, 10.0, 1e3}) {
    BoxShape box;
    box.high = {1, 1, aspect};
    box.elements = {2, 2, 2};
    box.distortion = 0.3;
    EXPECT_TRUE(stable(box, steel(), {0.06, 1.5}, 0.99, 1)) << aspect;
  }
}

}  // namespace
}  // namespace tenon::testing

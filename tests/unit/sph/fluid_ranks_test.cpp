// SPDX-License-Identifier: BSD-3-Clause
// Everything that a fluid may be given at once - walls that move and hold on, shifting, viscosity, two sizes of
// particles - has the same bits on any number of ranks.
#include <gtest/gtest.h>

#include "sph_case.hpp"

namespace tenon::testing {
namespace {

SphScene sloshing() {
  SphScene scene;
  scene.mesh = particle_bodies({{"water", flat_box({0, 0, 0}, {0.5, 0.4, 0}, 10)},
                                {"fine water", flat_box({0.5, 0, 0}, {0.8, 0.4, 0}, 9)},
                                {"floor", flat_box({-0.2, -0.2, 0}, {1.2, 0, 0}, 28)},
                                {"paddle", flat_box({-0.2, 0, 0}, {0, 0.8, 0}, 4)}});
  const MaterialDescription material = liquid(1000, 30);
  for (const char* const name : {"water", "fine water", "floor", "paddle"})
    scene.options.bodies.push_back(body_of(name, material));
  for (SphBody& body : scene.options.bodies) body.material.viscosity = 1;
  scene.options.bodies[2].wall = scene.options.bodies[3].wall = true;
  scene.options.bodies[3].velocity[0] = TimeFunction::sine(0.5, 0.1, 0, 0);
  scene.options.dimension = 2;
  scene.options.gravity[1] = TimeFunction::constant(-9.81);
  scene.options.fluid.slip = false;
  scene.options.fluid.viscosity = FluidOptions::Viscosity::monaghan;
  scene.options.fluid.shifting = FluidOptions::Shifting::shifting;
  return scene;
}

std::vector<std::vector<double>> end_of(const Communicator& comm, bool always_search) {
  SphScene scene = sloshing();
  scene.options.always_search = always_search;
  SphRun run(scene, comm);
  run.steps(120);
  return {run.gathered("position"),
          run.gathered("velocity"),
          run.gathered("pressure"),
          {run.row("internal_energy"), run.row("viscosity_energy"), run.row("boundary_work"), run.ledger_error()}};
}

TEST(FluidRanks, SameBits) {
  const std::vector<std::vector<double>> all = end_of(communicator(), false);
  EXPECT_LE(all.back().back(), 1e-11);
  EXPECT_NE(all.back()[2], 0);
  if (communicator().rank() != 0) return;
  EXPECT_EQ(all, end_of(Communicator::self(), false));
}

TEST(FluidRanks, SameBitsHoweverOftenItSearches) {
  EXPECT_EQ(end_of(communicator(), false), end_of(communicator(), true));
}

}  // namespace
}  // namespace tenon::testing

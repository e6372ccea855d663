// SPDX-License-Identifier: BSD-3-Clause
// The same bits on any number of ranks, with lists made anew in every step, and through a restart.
#include <gtest/gtest.h>

#include <filesystem>

#include "sph_case.hpp"

namespace tenon::testing {
namespace {

/// A vortex in a periodic square, which mixes all parts.
SphScene vortex(int across) {
  SphScene scene;
  scene.mesh = particle_bodies({{"fluid", flat_box({0, 0, 0}, {1, 1, 0}, across)}});
  SphBody body = body_of("fluid", liquid(1, 10));
  scene.options.dimension = 2;
  scene.options.bodies = {body};
  for (std::size_t c = 0; c < 2; ++c) {
    scene.options.domain.axes[c].periodic = true;
    scene.options.domain.axes[c].low = 0, scene.options.domain.axes[c].high = 1;
  }
  scene.options.initial_velocity_function = [](const Vec3& x) {
    constexpr double k = 6.283185307179586;
    return Vec3{-std::cos(k * x[0]) * std::sin(k * x[1]), std::sin(k * x[0]) * std::cos(k * x[1]), 0};
  };
  scene.options.displaced = [](const Vec3& x) {
    return Vec3{0.004 * std::sin(20 * x[1]), 0.004 * std::sin(17 * x[0]), 0};
  };
  return scene;
}

std::vector<std::vector<double>> end_of(const SphScene& scene, const Communicator& comm, int steps) {
  SphRun run(scene, comm);
  run.steps(steps);
  return {run.gathered("position"),
          run.gathered("velocity"),
          run.gathered("density"),
          {run.row("internal_energy"), run.row("viscosity_energy"), run.row("kinetic_energy")}};
}

TEST(SphRanks, SameBits) {
  const SphScene scene = vortex(24);
  const std::vector<std::vector<double>> all = end_of(scene, communicator(), 150);
  if (communicator().rank() != 0) return;
  const std::vector<std::vector<double>> alone = end_of(scene, Communicator::self(), 150);
  EXPECT_EQ(all, alone);
}

TEST(SphRanks, SameBitsHoweverOftenItSearches) {
  SphScene scene = vortex(20);
  const std::vector<std::vector<double>> with_skips = end_of(scene, communicator(), 60);
  scene.options.always_search = true;
  EXPECT_EQ(with_skips, end_of(scene, communicator(), 60));
}

TEST(SphRanks, SameBitsThroughARestart) {
  const SphScene scene = vortex(20);
  const std::string file = "sph-restart-" + std::to_string(communicator().size()) + ".h5";
  SphRun through(scene);
  through.steps(37);
  {
    CheckpointWriter writer(communicator(), file);
    through.simulation().save(writer);
    writer.finish();
  }
  through.steps(40);
  SphRun again(scene, communicator(), file);
  again.steps(40);
  for (const char* const column : {"position", "velocity", "density"})
    EXPECT_EQ(through.gathered(column), again.gathered(column)) << column;
  EXPECT_EQ(through.row("internal_energy"), again.row("internal_energy"));
}

TEST(SphConservation, MomentumAndEnergy) {
  SphScene scene = vortex(20);
  scene.options.domain = {};
  SphRun run(scene);
  const Vec3 linear = run.momentum(), angular = run.angular_momentum();
  run.steps(200);
  const double size = run.size_of_momentum();
  EXPECT_GT(size, 0);
  EXPECT_LE(norm(run.momentum() - linear), 1e-12 * size);
  EXPECT_LE(norm(run.angular_momentum() - angular), 1e-12 * size);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// A moving wall brings particles into a channel: mass flows in at the rate that is told, on any number of ranks.
#include <gtest/gtest.h>

#include <filesystem>

#include "framework/mesh/particle_bodies.hpp"
#include "sph_case.hpp"

namespace tenon::testing {
namespace {

constexpr double spacing = 0.05, speed = 1, height = 0.5, reservoir = 1;

/// A reservoir left of x = 0 that moves to the right; free stream without walls, mirrored below and above.
SphScene channel() {
  ParticleFill fill;
  fill.spacing = spacing, fill.dimension = 2;
  SphScene scene;
  scene.mesh = join_particles({{"stream", fill_box({0, 0, 0}, {0.5, height, 0}, fill)},
                               {"source", fill_box({-reservoir, 0, 0}, {0, height, 0}, fill)}});
  SphBody stream = body_of("stream", liquid(1000, 20)), source = body_of("source", liquid(1000, 20));
  stream.initial_velocity[0] = SpaceTimeFunction::constant(speed);
  source.wall = true;
  source.velocity[0] = TimeFunction::constant(speed);
  source.inflow.emplace();
  scene.options.dimension = 2;
  scene.options.bodies = {stream, source};
  scene.options.domain.axes[1].low = 0, scene.options.domain.axes[1].high = height;
  return scene;
}

double free_mass(const SphRun& run) {
  return run.sum([](const ParticleData& p, std::size_t i) { return p.body[i] == 0 ? p.mass[i] : 0.0; });
}

TEST(Inflow, MassComesInAtTheRateThatIsTold) {
  SphRun run(channel());
  const double before = free_mass(run);
  run.run(0.6);
  const double columns = std::floor(speed * run.time() / spacing + 0.5);  // a column counts when its middle has passed
  const double expected = before + columns * spacing * height * 1000;
  std::printf("inflow: %.4f kg/m after %.3f s, expected %.4f, ledger %.1e\n", free_mass(run), run.time(), expected,
              run.ledger_error());
  EXPECT_NEAR(free_mass(run), expected, 1e-9 * expected);
  EXPECT_NEAR(run.row("inflow_energy"), 0.5 * (expected - before) * speed * speed, 1e-9 * expected);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

TEST(Inflow, SameBitsOnAnyRanksAndThroughARestart) {
  const auto state = [](SphRun& run) {
    return std::vector<std::vector<double>>{run.gathered("position"), run.gathered("velocity"),
                                            run.gathered("density")};
  };
  const std::string file = "sph-inflow-" + std::to_string(communicator().size()) + ".h5";
  SphRun run(channel());
  run.steps(60);
  {
    CheckpointWriter writer(communicator(), file);
    run.simulation().save(writer);
    writer.finish();
  }
  run.steps(60);
  SphRun again(channel(), communicator(), file);
  again.steps(60);
  EXPECT_EQ(state(run), state(again));
  EXPECT_EQ(free_mass(run), free_mass(again));
  const std::vector<std::vector<double>> all = state(run);
  if (communicator().rank() != 0) return;
  SphRun alone(channel(), Communicator::self());
  alone.steps(120);
  EXPECT_EQ(all, state(alone));
}

}  // namespace
}  // namespace tenon::testing

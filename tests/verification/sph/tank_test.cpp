// SPDX-License-Identifier: BSD-3-Clause
// Water in a tank, at rest and let go; and a drop of a single particle.
#include "tank_case.hpp"

namespace tenon::testing {
namespace {

TEST(Hydrostatics, PressureAndForceOnTheBottom) {
  expect_rest(end_of_rest({0.05, 0.5, 1, 2}));
}

TEST(DamBreak, FrontAndEnergy) {
  expect_the_dam_to_break(0.05);
}

/// Nobody is there whose motion would mend its density. Its pressure fades; the ledger does not notice.
TEST(LoneParticle, ComesToRestDensity) {
  for (const int dimension : {2, 3}) {
    SphScene scene;
    ParticleBox box;
    box.high = {0.1, 0.1, dimension == 3 ? 0.1 : 0}, box.dimension = dimension;
    scene.mesh = particle_bodies({{"drop", generate(box)}});
    SphBody drop = body_of("drop", liquid(1000, 50));
    drop.initial_pressure = of_place([](const Vec3&) { return -3e5; });
    scene.options.dimension = dimension;
    scene.options.bodies = {drop};
    scene.options.gravity[1] = TimeFunction::constant(-gravity);
    scene.end = 1;
    SphRun run(scene);
    const auto pressure = [&] {
      const Column& p = *run.particles().find("pressure");
      return run.sum([&](const ParticleData&, std::size_t i) { return p[i]; });
    };
    EXPECT_NEAR(pressure(), -3e5, 1);
    run.steps(100);
    EXPECT_NEAR(pressure(), 0, 1);
    EXPECT_LE(run.ledger_error(), 1e-11);
  }
}

/// Share of its excess of density that each particle loses in a ten thousandth of the time that sound takes for h: by
/// motion less than a millionth. The last one is alone.
std::vector<double> excess_lost(int dimension, double smoothing) {
  constexpr int across = 6;
  constexpr double sound = 50, share = 1e-4;
  SphScene scene;
  ParticleBox box, drop;
  box.dimension = drop.dimension = dimension;
  for (std::size_t c = 0; c < static_cast<std::size_t>(dimension); ++c)
    box.particles[c] = across, box.high[c] = 1, drop.low[c] = 3, drop.high[c] = 3 + 1.0 / across;
  scene.mesh = particle_bodies({{"body", generate(box)}, {"drop", generate(drop)}});
  SphBody body = body_of("body", liquid(1000, sound));
  body.initial_pressure = of_place([](const Vec3&) { return 2500; });
  scene.options.bodies = {body, body};
  scene.options.bodies.back().name = "drop";
  scene.options.dimension = dimension;
  scene.options.smoothing = smoothing;
  scene.options.time_step.fixed = share * smoothing / across / sound;
  SphRun run(scene);
  run.step();
  std::vector<double> lost = run.gathered("density");
  for (double& value : lost) value = 1001 - value;
  return lost;
}

/// Corners of bodies have the least neighbours of all that are not alone, the fewer the wider the kernel.
TEST(LoneParticle, NoCornerIsOne) {
  for (int dimension = 1; dimension <= 3; ++dimension)
    for (const double smoothing : {1.0, 1.3, 2.0}) {
      const std::vector<double> lost = excess_lost(dimension, smoothing);
      if (lost.empty()) continue;
      for (std::size_t i = 0; i + 1 < lost.size(); ++i)
        EXPECT_LE(std::abs(lost[i]), 1e-6) << dimension << "-D, h = " << smoothing << ", particle " << i;
      EXPECT_GE(lost.back(), 0.4e-4) << dimension << "-D, h = " << smoothing;
      EXPECT_LE(lost.back(), 1e-4) << dimension << "-D, h = " << smoothing;
    }
}

}  // namespace
}  // namespace tenon::testing

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

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Gases and shocks at and beyond what anyone wants of them: they stay stable, or stop with a clear word.
#include <gtest/gtest.h>

#include <limits>

#include "framework/base/error.hpp"
#include "shock_case.hpp"

namespace tenon::testing {
namespace {

/// Finite places and speeds, books closed, momentum kept.
void expect_sound(SphRun& run, const Vec3& momentum) {
  const double far = run.sum([](const ParticleData& p, std::size_t i) {
    return std::isfinite(norm(p.position.vec(i)) + norm(p.velocity.vec(i)) + p.density[i]) && p.length[i] > 0 ? 0 : 1;
  });
  EXPECT_EQ(far, 0);
  EXPECT_LE(run.ledger_error(), 1e-10);
  EXPECT_LE(norm(run.momentum() - momentum), 1e-12 * run.size_of_momentum() + 1e-300);
}

SphScene square(int across, double speed = 0) {
  SphScene scene = gas_scene(2);
  scene.mesh = particle_bodies({{"gas", box_of_particles({0, 0, 0}, {1, 1, 0}, 1.0 / across, 2)}});
  SphBody gas = body_of("gas", ideal_gas(1, 1.4));
  gas.initial_pressure = SpaceTimeFunction::constant(1);
  gas.initial_velocity[0] = SpaceTimeFunction::constant(speed);
  scene.options.bodies = {gas};
  scene.end = 1e9;
  return scene;
}

/// Until it is forty times as wide: smoothing lengths stop growing, and so do lists and memory.
TEST(Extremes, AGasExpandsIntoTheVoid) {
  SphRun run(square(16));
  const Vec3 momentum = run.momentum();
  run.steps(5);
  const std::int64_t memory = run.body().memory();
  run.steps(600);
  expect_sound(run, momentum);
  const double width =
      2 * communicator().max(run.body().particles().owned() == 0 ? 0.0
                                                                 : std::abs(run.body().particles().position[0] - 0.5));
  EXPECT_GT(width, 5);
  EXPECT_LE(run.body().memory(), 20 * memory + 1000000);
}

TEST(Extremes, OneParticle) {
  SphScene scene = gas_scene(3);
  scene.mesh = particle_bodies({{"gas", box_of_particles({0, 0, 0}, {1, 1, 1}, 1, 3)}});
  SphBody gas = body_of("gas", ideal_gas(1, 1.4));
  gas.initial_pressure = SpaceTimeFunction::constant(1);
  gas.initial_velocity[0] = SpaceTimeFunction::constant(3);
  scene.options.bodies = {gas};
  scene.end = 10;
  SphRun run(scene);
  run.run(10);
  EXPECT_LE(run.ledger_error(), 1e-11);
  const std::vector<double> x = run.gathered("position");
  if (communicator().rank() != 0) return;
  EXPECT_NEAR(x[0], 0.5 + 30, 1e-9);
}

/// Every second particle stands where its neighbour is, or a hair beside it.
TEST(Extremes, ParticlesOnTopOfEachOther) {
  for (const double beside : {0.0, 1e-9}) {
    SphScene scene = square(16);
    scene.options.displaced = [=](const Vec3& x) {
      const int column = static_cast<int>(x[0] * 16);
      return column % 2 == 1 ? Vec3{-1.0 / 16 + beside, 0, 0} : Vec3{};
    };
    SphRun run(scene);
    const Vec3 momentum = run.momentum();
    run.steps(300);
    expect_sound(run, momentum);
  }
}

/// All in one place: no direction to push to, so nothing moves.
TEST(Extremes, AllInOnePlace) {
  SphScene scene = square(12);
  scene.options.displaced = [](const Vec3& x) { return Vec3{0.5, 0.5, 0} - x; };
  SphRun run(scene);
  const Vec3 momentum = run.momentum();
  run.steps(50);
  expect_sound(run, momentum);
}

std::string last_words(const SphScene& scene) {
  try {
    SphRun(scene).steps(3);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::unstable);
    return error.what();
  }
  return "";
}

/// So many in one place that lists would grow with their square.
TEST(Extremes, TooManyInOnePlaceStopTheRun) {
  SphScene scene = square(64);
  scene.options.displaced = [](const Vec3& x) { return Vec3{0.5, 0.5, 0} - x; };
  scene.options.most_neighbours = 14;
  const std::string words = last_words(scene);
  EXPECT_NE(words.find("particle 1 near (0.5, 0.5, 0) has at least"), std::string::npos) << words;
}

/// One support that covers everything makes each cell as large: few pairs, but all are tested.
TEST(Extremes, ASupportOverEverythingStopsTheRun) {
  SphScene scene = square(64);
  scene.options.most_neighbours = 14;
  scene.options.skin = 1e-3;  // of the greatest support, so that lists do not grow with it
  scene.end = 1e-3;
  EXPECT_EQ(last_words(scene), "") << "while all are alike";
  scene.mesh.volumes[77] = 4;
  const std::string words = last_words(scene);
  EXPECT_NE(words.find("the smoothing length of particle 78 near"), std::string::npos) << words;
  scene.mesh.volumes[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(last_words(scene), words) << "what is not a number is longer than nothing";
}

/// Eight times those of an even lattice within the support, and 400 at least.
TEST(Extremes, NeighboursThatAListMayHold) {
  EXPECT_NEAR(static_cast<double>(most_neighbours_of(2, 1.3, 0.1, 3)), 8 * 4.18879 * 2.86 * 2.86 * 2.86, 1);
  EXPECT_EQ(most_neighbours_of(2, 1.3, 0.1, 2), 400);
  EXPECT_EQ(most_neighbours_of(3, 1.2, 0.1, 1), 400);
  EXPECT_GT(most_neighbours_of(3, 2, 0.1, 3), 9000);
}

/// Water at 5 km/s on water at rest, shocks by the Hugoniot.
TEST(Extremes, AJetAtFiveKilometresPerSecond) {
  SphScene scene = gas_scene(2);
  const double spacing = 1e-3;
  scene.mesh = particle_bodies({{"jet", box_of_particles({-0.02, -0.004, 0}, {0, 0.004, 0}, spacing, 2)},
                                {"pool", box_of_particles({0, -0.02, 0}, {0.02, 0.02, 0}, spacing, 2)}});
  MaterialDescription water;
  water.name = "water", water.density = 1000;
  EquationOfState state;
  state.law = Gruneisen{1000, 1480, 1.92, 0, 0, 0.1, 0, 0};
  state.least_pressure = 0;
  water.equation_of_state = state;
  SphBody jet = body_of("jet", water), pool = body_of("pool", water);
  jet.initial_velocity[0] = SpaceTimeFunction::constant(5000);
  scene.options.bodies = {jet, pool};
  scene.options.gas.density = GasOptions::Density::continuity;
  scene.end = 1e-5;
  SphRun run(scene);
  const Vec3 momentum = run.momentum();
  double greatest = 0;
  run.run(scene.end, [&] {
    const ParticleData& p = run.body().particles();
    for (std::size_t i = 0; i < p.owned(); ++i) greatest = std::max(greatest, (*p.find("pressure"))[i]);
  });
  expect_sound(run, momentum);
  greatest = communicator().max(greatest);
  const double half = 2500, hugoniot = 1000 * (1480 + 1.92 * half) * half;
  EXPECT_GT(greatest, 0.8 * hugoniot);
  EXPECT_LT(greatest, 5 * hugoniot) << "where the first particles meet there is more, for a moment";
}

/// Heavy and light gas with one pressure, side by side; the light one is stirred.
TEST(Extremes, ADensityRatioOfAThousand) {
  SphScene scene = gas_scene(2);
  scene.mesh = particle_bodies({{"heavy", box_of_particles({0, 0, 0}, {0.5, 1, 0}, 1.0 / 20, 2)},
                                {"light", box_of_particles({0.5, 0, 0}, {1, 1, 0}, 1.0 / 20, 2)}});
  SphBody heavy = body_of("heavy", ideal_gas(1000, 1.4)), light = body_of("light", ideal_gas(1, 1.4));
  heavy.initial_pressure = light.initial_pressure = SpaceTimeFunction::constant(1);
  light.initial_velocity[1] = of_place([](const Vec3& x) { return 0.3 * std::sin(6 * x[0]); });
  scene.options.bodies = {heavy, light};
  for (std::size_t c = 0; c < 2; ++c) scene.options.domain.axes[c].low = 0, scene.options.domain.axes[c].high = 1;
  scene.end = 0.5;
  SphRun run(scene);
  run.run(scene.end);
  EXPECT_LE(run.ledger_error(), 1e-10);
  double greatest = 0;
  const ParticleData& p = run.body().particles();
  for (std::size_t i = 0; i < p.owned(); ++i) greatest = std::max(greatest, norm(p.velocity.vec(i)));
  greatest = communicator().max(greatest);
  if (communicator().rank() == 0) std::printf("density ratio 1000: greatest speed %.3g\n", greatest);
  EXPECT_LE(greatest, 10 * std::sqrt(1.4)) << "of some speeds of sound of the light gas";
}

/// One particle leaves at a thousand times the speed of sound.
TEST(Extremes, AParticleIsThrownToInfinity) {
  SphScene scene = square(16);
  scene.options.initial_velocity_function = [](const Vec3& x) {
    return x[0] > 0.96 && x[1] > 0.96 ? Vec3{1e3, 1e3, 0} : Vec3{};
  };
  SphRun run(scene);
  const Vec3 momentum = run.momentum();
  run.steps(50);
  const std::int64_t memory = run.body().memory();
  run.steps(1000);
  expect_sound(run, momentum);
  EXPECT_LE(run.body().memory(), 4 * memory + 1000000);
}

TEST(Extremes, WhatIsNotANumberStopsTheRunOnAllRanks) {
  SphScene scene = square(10);
  SphRun run(scene);
  run.steps(3);
  // Nobody but a test reaches into the particles of a run.
  Column& v = const_cast<ParticleData&>(run.body().particles()).velocity;
  if (communicator().rank() == 0 && run.body().particles().owned() > 0) v[0] = std::numeric_limits<double>::quiet_NaN();
  try {
    run.steps(10);
    FAIL() << "went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::unstable);
    EXPECT_NE(std::string(error.what()).find("not a number"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tenon::testing

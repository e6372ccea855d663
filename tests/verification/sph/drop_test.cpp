// SPDX-License-Identifier: BSD-3-Clause
// A drop that is pulled into an ellipse [Mon94], against the exact solution.
#include <gtest/gtest.h>

#include "fluid_case.hpp"

namespace tenon::testing {
namespace {

constexpr double spacing_of_the_test = DROP_SPACING;  // m, by the build: small in the tests of every change
constexpr double sound = 1400, density = 1000, end = 0.0076;

SphScene drop(double spacing) {
  SphScene scene;
  const int across = 2 * static_cast<int>(std::lround(1 / spacing));
  scene.mesh = particle_bodies({{"drop", part_of(flat_box({-1, -1, 0}, {1, 1, 0}, across),
                                                 [](const Vec3& x) { return x[0] * x[0] + x[1] * x[1] < 1; })}});
  SphBody body = body_of("drop", liquid(density, sound));
  body.initial_pressure = of_place([](const Vec3& x) { return 0.5 * density * 1e4 * (1 - x[0] * x[0] - x[1] * x[1]); });
  scene.options.dimension = 2;
  scene.options.bodies = {body};
  scene.options.smoothing = 1.8;
  scene.options.artificial_viscosity.alpha = 0.01;
  // A lattice would be drawn out to strips.
  scene.options.displaced = [spacing](const Vec3& x) { return 0.2 * spacing * Vec3{noise(x, 1), noise(x, 2), 0}; };
  scene.options.initial_velocity_function = [](const Vec3& x) { return Vec3{-100 * x[0], 100 * x[1], 0}; };
  scene.end = end;
  return scene;
}

/// Half axes of the ellipse with the second moments of the particles.
std::array<double, 2> axes(const SphRun& run) {
  const double mass = run.sum([](const ParticleData& p, std::size_t i) { return p.mass[i]; });
  std::array<double, 2> axis{};
  for (std::size_t c = 0; c < 2; ++c)
    axis[c] = 2 * std::sqrt(run.sum([c](const ParticleData& p, std::size_t i) {
                return p.mass[i] * p.position[3 * i + c] * p.position[3 * i + c];
              }) / mass);
  return axis;
}

void expect_the_exact_solution(double spacing) {
  SphRun run(drop(spacing));
  const double kinetic = run.row("kinetic_energy");
  const auto at_start = axes(run);
  run.run(end);
  const auto [a, b] = axes(run);
  const double kept = run.row("kinetic_energy") / kinetic;
  if (communicator().rank() == 0)
    std::printf("start %.4f %.4f: a %.4f (0.5143) b %.4f (1.9445) a b %.4f, kinetic energy kept %.4f, %lld steps\n",
                at_start[0], at_start[1], a, b, a * b, kept, static_cast<long long>(run.simulation().steps()));
  EXPECT_NEAR(b, 1.944517, 0.015 * 1.944517);
  EXPECT_NEAR(a * b, 1, 0.01);
  EXPECT_GE(kept, 0.97);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

TEST(EllipticalDrop, HalfAxesAndEnergy) {
  expect_the_exact_solution(spacing_of_the_test);
}

}  // namespace
}  // namespace tenon::testing

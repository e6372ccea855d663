// SPDX-License-Identifier: BSD-3-Clause
// What a free cloud of disturbed, turning gas keeps: momenta, energy, mass; and the order of the time integration.
#include <gtest/gtest.h>

#include "shock_case.hpp"

namespace tenon::testing {
namespace {

/// A number in -1/2..1/2 that depends on the place alone.
double scatter(const Vec3& x, int salt) {
  const double s = std::sin(12.9898 * x[0] + 78.233 * x[1] + 37.719 * x[2] + 11.3 * salt) * 43758.5453;
  return s - std::floor(s) - 0.5;
}

SphScene cloud(int across) {
  SphScene scene = gas_scene(3);
  const double spacing = 1.0 / across;
  scene.mesh = particle_bodies({{"gas", box_of_particles({0, 0, 0}, {1, 1, 1}, spacing, 3)}});
  SphBody gas = body_of("gas", ideal_gas(1, 1.4));
  gas.initial_energy = SpaceTimeFunction::constant(2.5);
  scene.options.bodies = {gas};
  scene.options.displaced = [=](const Vec3& x) {
    return 0.4 * spacing * Vec3{scatter(x, 1), scatter(x, 2), scatter(x, 3)};
  };
  scene.options.initial_velocity_function = [](const Vec3& x) { return Vec3{0.5 - x[1], x[0] - 0.5, 0.1}; };
  scene.end = 1e9;
  return scene;
}

void expect_kept(SphScene scene, int steps) {
  SphRun run(scene);
  const Vec3 linear = run.momentum(), angular = run.angular_momentum();
  const auto mass = [](const ParticleData& p, std::size_t i) { return p.mass[i]; };
  const double total = run.sum(mass);
  run.steps(steps);
  const double size = run.size_of_momentum(), ledger = run.ledger_error(), drift = norm(run.momentum() - linear) / size,
               turn = norm(run.angular_momentum() - angular) / size;
  EXPECT_EQ(run.sum(mass), total);
  EXPECT_LE(drift, 1e-12);
  EXPECT_LE(turn, 1e-10);
  EXPECT_LE(ledger, 1e-11);
  if (communicator().rank() == 0)
    std::printf("%d steps to t = %.3f: momentum %.1e, angular %.1e of %.3g; energy %.1e\n", steps, run.time(), drift,
                turn, size, ledger);
}

TEST(GasConservation, OverAThousandSteps) {
  SphScene scene = cloud(10);
  scene.options.time_step.maximum = 0.01;
  expect_kept(scene, 1000);
}

TEST(GasConservation, WithEverySwitch) {
  for (const auto limiter : {ArtificialViscosity::Switch::balsara, ArtificialViscosity::Switch::cullen_dehnen})
    for (const auto density : {GasOptions::Density::summation, GasOptions::Density::continuity})
      for (const auto kernel :
           {SphKernelKind::cubic_spline, SphKernelKind::quintic_spline, SphKernelKind::wendland_c4}) {
        SphScene scene = cloud(6);
        scene.options.artificial_viscosity.limiter = limiter;
        scene.options.gas.density = density;
        scene.options.kernel = kernel;
        expect_kept(scene, 40);
      }
}

/// Smooth flow without viscosity: halving the step divides the error by four.
TEST(GasConservation, StepsAreOfSecondOrder) {
  const auto places = [](int steps) {
    SphScene scene = cloud(6);
    scene.options.artificial_viscosity.alpha = 0.5, scene.options.artificial_viscosity.beta = 0;
    scene.options.artificial_conduction = 0;
    scene.options.time_step.fixed = 0.16 / steps;
    SphRun run(scene);
    run.steps(steps);
    return run.gathered("position");
  };
  const std::vector<double> exact = places(256);
  const auto error = [&](int steps) {
    const std::vector<double> x = places(steps);
    double sum = 0;
    for (std::size_t k = 0; k < x.size(); ++k) sum += (x[k] - exact[k]) * (x[k] - exact[k]);
    return std::sqrt(sum);
  };
  const double coarse = error(16), fine = error(32);
  if (communicator().rank() != 0) return;
  std::printf("order in time %.3f\n", std::log2(coarse / fine));
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.25);
}

TEST(GasRanks, SameBitsOnAnyRanksAndThroughARestart) {
  for (const auto density : {GasOptions::Density::summation, GasOptions::Density::continuity}) {
    SphScene scene = cloud(6);
    scene.options.gas.density = density;
    scene.options.artificial_viscosity.limiter = ArtificialViscosity::Switch::cullen_dehnen;
    SphRun run(scene);
    run.steps(50);
    const std::string file = "sph-gas-restart-" + std::to_string(communicator().size()) + ".h5";
    {
      CheckpointWriter writer(communicator(), file);
      run.simulation().save(writer);
      writer.finish();
    }
    run.steps(60);
    SphRun again(scene, communicator(), file);
    again.steps(60);
    SphRun alone(scene, Communicator::self());
    alone.steps(110);
    for (const char* const column : {"position", "velocity", "energy_half", "density", "smoothing_length"}) {
      const std::vector<double> through = run.gathered(column);
      EXPECT_EQ(through, again.gathered(column)) << column;
      const std::vector<double> one = alone.gathered(column);
      EXPECT_TRUE(communicator().rank() != 0 || through == one) << column;
    }
  }
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Taylor-Green vortices in the periodic unit square, speed 1, Reynolds number 100.
#pragma once

#include <numbers>

#include "fluid_case.hpp"

namespace tenon::testing {

struct TaylorGreen {
  static constexpr double viscosity = 0.01, sound = 10, wave = 2 * std::numbers::pi;
  static constexpr double rate = 2 * wave * wave * viscosity;  ///< at which speeds decay, 1/s

  static Vec3 velocity(const Vec3& x, double t) {
    const double u = std::exp(-rate * t);
    return {-u * std::cos(wave * x[0]) * std::sin(wave * x[1]), u * std::sin(wave * x[0]) * std::cos(wave * x[1]), 0};
  }

  static SphScene scene(int across, FluidOptions::Shifting shifting) {
    SphScene scene;
    scene.mesh = particle_bodies({{"fluid", flat_box({0, 0, 0}, {1, 1, 0}, across)}});
    SphBody body = body_of("fluid", liquid(1, sound));
    body.material.viscosity = viscosity;
    body.initial_pressure =
        of_place([](const Vec3& x) { return -0.25 * (std::cos(2 * wave * x[0]) + std::cos(2 * wave * x[1])); });
    scene.options.dimension = 2;
    // Without shifting the noise of the places is the greatest error, and a wider kernel hears less of it.
    scene.options.smoothing = shifting == FluidOptions::Shifting::none ? 2.4 : 2;
    // The coefficients of [LXSR12], h^2/2 a step, and of [AHA13] at a background pressure of 3 rho c^2/2.
    scene.options.fluid.shifting_strength = shifting == FluidOptions::Shifting::shifting ? 10 : 3;
    scene.options.bodies = {body};
    scene.options.fluid.viscosity = FluidOptions::Viscosity::morris;
    scene.options.fluid.shifting = shifting;
    for (std::size_t c = 0; c < 2; ++c) scene.options.domain.axes[c] = {true, 0, 1};
    scene.options.initial_velocity_function = [](const Vec3& x) { return velocity(x, 0); };
    const double jitter = 0.2 / across;  // a lattice would be drawn out at the stagnation points and never mix
    scene.options.displaced = [jitter](const Vec3& x) { return jitter * Vec3{noise(x, 1), noise(x, 2), 0}; };
    scene.end = 2;
    return scene;
  }

  /// Collective. Mean of |v - exact| over the mean of |exact| where particles are. Velocities are half a step behind.
  static double error(SphRun& run) {
    const double half = 0.5 * run.body().time_step(), t = run.time() - half;
    const double wrong = run.sum([&](const ParticleData& p, std::size_t i) {
      return norm(p.velocity.vec(i) - velocity(p.position.vec(i) - half * p.velocity.vec(i), t));
    });
    const double size =
        run.sum([&](const ParticleData& p, std::size_t i) { return norm(velocity(p.position.vec(i), t)); });
    return wrong / size;
  }
  /// Collective.
  static double greatest_speed(const SphRun& run) {
    double greatest = 0;
    const ParticleData& p = run.particles();
    for (std::size_t i = 0; i < p.owned(); ++i) greatest = std::max(greatest, norm(p.velocity.vec(i)));
    return run.comm().max(greatest);
  }
};

}  // namespace tenon::testing

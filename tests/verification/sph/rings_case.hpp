// SPDX-License-Identifier: BSD-3-Clause
// Two rubber rings that meet head-on (case B04, after [GMS01]).
#pragma once

#include <limits>

#include "solid_case.hpp"

namespace tenon::testing {

inline constexpr double ring_sound = 4032.39, ring_speed = 0.059 * ring_sound;  // m/s

inline SphScene rings(SphFormulation formulation, int rows) {
  SphScene scene;
  scene.mesh = particle_bodies({{"left", body_of_points(ring({-0.041, 0, 0}, 0.03, 0.04, rows))},
                                {"right", body_of_points(ring({0.041, 0, 0}, 0.03, 0.04, rows))}});
  const MaterialDescription rubber = elastic_solid(1, 1e7, 0.3975);
  scene.options.bodies = {body_of("left", rubber), body_of("right", rubber)};
  scene.options.dimension = 2;
  scene.options.formulation = formulation;
  scene.options.time_step.cfl = 0.5;
  scene.options.artificial_viscosity.alpha = scene.options.artificial_viscosity.beta = 0;
  scene.options.initial_velocity_function = [](const Vec3& x) {
    return Vec3{x[0] < 0 ? ring_speed : -ring_speed, 0, 0};
  };
  scene.end = 1;
  return scene;
}

/// What is compared with the finite-element run of the same case.
struct RingsResult {
  double restitution = 0, first_contact = 0, last_contact = 0, least_width = 0, time_of_least_width = 0;  // m, s
  double momentum = 0, energy_loss = 0, ledger_error = 0;
  int clusters = 0;
  std::int64_t steps = 0;
};

inline RingsResult collide(const SphScene& scene, int rows, double end) {
  SphRun run(scene);
  const double spacing = 0.01 / rows;
  RingsResult result;
  result.least_width = std::numeric_limits<double>::infinity();
  const double size = run.size_of_momentum(),
               half_mass = 0.5 * run.sum([](const ParticleData&p, std::size_t i) { return p.mass[i]; });
  const auto right_momentum = [&] {
    return run.sum(
        [](const ParticleData& p, std::size_t i) { return p.body[i] == 1 ? p.mass[i] * p.velocity[3 * i] : 0.0; });
  };
  double before = right_momentum();
  result.first_contact = -1;
  run.run(end, [&] {
    const double now = right_momentum();
    if (std::abs(now - before) > 1e-9 * half_mass * ring_speed) {
      if (result.first_contact < 0) result.first_contact = run.time();
      result.last_contact = run.time();
    }
    before = now;
    if (run.simulation().steps() % 5 != 0) return;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const ParticleData& p = run.body().particles();
    for (std::size_t i = 0; i < p.owned(); ++i)
      if (p.body[i] == 1) low = std::min(low, p.position[3 * i]), high = std::max(high, p.position[3 * i]);
    const double width = communicator().max(high) - communicator().min(low) + spacing;
    if (width < result.least_width) result.least_width = width, result.time_of_least_width = run.time();
  });
  result.restitution = right_momentum() / (half_mass * ring_speed);
  result.momentum = norm(run.momentum()) / size;
  result.ledger_error = run.ledger_error();
  result.energy_loss =
      (run.row("viscosity_energy") + run.row("hourglass_energy")) / (half_mass * ring_speed * ring_speed);
  result.steps = run.simulation().steps();
  const std::vector<double> x = run.gathered("position");
  result.clusters = communicator().rank() == 0 ? clusters(x, 1.5 * spacing) : 2;
  if (communicator().rank() == 0)
    std::printf(
        "rings %d rows: restitution %.4f, contact %.1f to %.1f us, least width %.2f mm at %.1f us, lost %.2f %%, "
        "momentum %.1e, ledger %.1e, %d clusters, %lld steps\n",
        rows, result.restitution, 1e6 * result.first_contact, 1e6 * result.last_contact, 1e3 * result.least_width,
        1e6 * result.time_of_least_width, 100 * result.energy_loss, result.momentum, result.ledger_error,
        result.clusters, static_cast<long long>(result.steps));
  return result;
}

}  // namespace tenon::testing

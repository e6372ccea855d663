// SPDX-License-Identifier: BSD-3-Clause
// Copper cylinder at 227 m/s on a wall without friction that holds it (cases A07 and F13), a quarter of it.
#pragma once

#include "solid_case.hpp"

namespace tenon::testing {

struct TaylorBar {
  double length = 0, radius = 0, eqps = 0, ledger_error = 0;  // m
  double hourglass = 0, viscosity = 0;                        // of the energy of impact
};

/// Symmetry planes at x = 0 and y = 0 are what they say; that at z = 0 is the wall, with a bar beyond it that meets
/// this one.
inline TaylorBar taylor_bar(SphFormulation formulation, int across,
                            const std::function<void(SphOptions&)>& change = {}) {
  constexpr double radius = 3.2e-3, length = 32.4e-3, speed = 227;
  SphScene scene;
  scene.mesh = particle_bodies({{"bar", body_of_points(quarter_cylinder(radius, length, across))}});
  MaterialDescription copper = elastic_solid(8930, 117e9, 0.35);
  copper.plasticity = LinearHardeningParameters{400e6, 100e6, {}};
  scene.options.bodies = {body_of("bar", copper)};
  scene.options.formulation = formulation;
  scene.options.time_step.cfl = 0.5;
  for (ParticleDomain::Axis& axis : scene.options.domain.axes) axis.low = 0;
  scene.options.initial_velocity_function = [](const Vec3&) { return Vec3{0, 0, -speed}; };
  scene.end = 80e-6;
  if (change) change(scene.options);
  SphRun run(scene);
  run.run(scene.end);
  TaylorBar bar;
  const ParticleData& p = run.body().particles();
  const double spacing = radius / across;
  const Column& eqps = *p.find("eqps");
  for (std::size_t i = 0; i < p.owned(); ++i) {
    bar.length = std::max(bar.length, p.position[3 * i + 2]);
    bar.radius = std::max(bar.radius, std::hypot(p.position[3 * i], p.position[3 * i + 1]));
    bar.eqps = std::max(bar.eqps, eqps[i]);
  }
  bar.length = communicator().max(bar.length) + 0.5 * spacing;
  bar.radius = communicator().max(bar.radius) + 0.5 * spacing;
  bar.eqps = communicator().max(bar.eqps);
  bar.ledger_error = run.ledger_error();
  const double impact = 0.5 * speed * speed * run.sum([](const ParticleData& q, std::size_t i) { return q.mass[i]; });
  bar.hourglass = run.row("hourglass_energy") / impact, bar.viscosity = run.row("viscosity_energy") / impact;
  if (communicator().rank() == 0)
    std::printf(
        "R/%d: L %.3f mm, R %.3f mm, eqps %.3f, hourglass %.2f %%, viscosity %.2f %%, ledger %.1e, %lld steps\n",
        across, 1e3 * bar.length, 1e3 * bar.radius, bar.eqps, 100 * bar.hourglass, 100 * bar.viscosity,
        bar.ledger_error, static_cast<long long>(run.simulation().steps()));
  return bar;
}

}  // namespace tenon::testing

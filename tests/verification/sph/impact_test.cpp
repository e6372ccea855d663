// SPDX-License-Identifier: BSD-3-Clause
// Two plates of copper meet head-on: the shocks and what is behind them, against the Hugoniot U = c + S1 u.
#include <gtest/gtest.h>

#include "shock_case.hpp"

namespace tenon::testing {
namespace {

constexpr double rho = 8930, c = 3940, S1 = 1.489, u = 500, thickness = 0.01;

/// Plates of `particles` each, mirror-symmetric about x = 0, with free surfaces behind.
SphScene plates(int particles) {
  SphScene scene = gas_scene(1);
  const double spacing = thickness / particles;
  scene.mesh = particle_bodies({{"left", box_of_particles({-thickness, 0, 0}, {0, 0, 0}, spacing, 1)},
                                {"right", box_of_particles({0, 0, 0}, {thickness, 0, 0}, spacing, 1)}});
  MaterialDescription copper;
  copper.name = "copper", copper.density = rho;
  EquationOfState state;
  state.law = Gruneisen{rho, c, S1, 0, 0, 2.02, 0.47, 0};
  copper.equation_of_state = state;
  SphBody left = body_of("left", copper), right = body_of("right", copper);
  left.initial_velocity[0] = SpaceTimeFunction::constant(u),
  right.initial_velocity[0] = SpaceTimeFunction::constant(-u);
  scene.options.bodies = {left, right};
  scene.options.gas.density = GasOptions::Density::continuity;
  scene.end = 1.2e-6;
  return scene;
}

struct ImpactEnd {
  double pressure = 0, density = 0, energy = 0, shock = 0, quiet = 0;
};

ImpactEnd run_plates(int particles) {
  const SphScene scene = plates(particles);
  SphRun run(scene);
  const Vec3 momentum = run.momentum();
  run.run(scene.end);
  EXPECT_LE(run.ledger_error(), 1e-11);
  EXPECT_LE(norm(run.momentum() - momentum), 1e-12 * run.size_of_momentum());
  const std::vector<double> x = run.gathered("position"), density = run.gathered("density"),
                            p = run.gathered("pressure"), e = run.gathered("specific_energy");
  ImpactEnd end;
  const double U = c + S1 * u, front = (U - u) * scene.end, exact = rho * U * u;
  double inside = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double at = std::abs(x[3 * i]);
    if (p[i] > 0.5 * exact) end.shock = std::max(end.shock, at);
    if (at > 1.5 * front) end.quiet = std::max(end.quiet, std::abs(p[i]));
    if (at > 0.8 * front || at < 0.2 * front) continue;
    end.pressure += p[i], end.density += density[i], end.energy += e[i], ++inside;
  }
  end.pressure /= inside, end.density /= inside, end.energy /= inside;
  return end;
}

TEST(Impact, IsOnTheHugoniot) {
  const ImpactEnd end = run_plates(200);
  if (communicator().rank() != 0) return;
  const double U = c + S1 * u, p = rho * U * u;
  std::printf("impact: p %.4g (exact %.4g) rho %.1f (%.1f) e %.5g (%.5g) shock %.5g (%.5g), ahead %.3g Pa\n",
              end.pressure, p, end.density, rho * U / (U - u), end.energy, 0.5 * u * u, end.shock, (U - u) * 1.2e-6,
              end.quiet);
  EXPECT_NEAR(end.pressure, p, 0.01 * p);
  EXPECT_NEAR(end.density, rho * U / (U - u), 0.005 * rho);
  EXPECT_NEAR(end.energy, 0.5 * u * u, 0.02 * 0.5 * u * u);
  EXPECT_NEAR(end.shock, (U - u) * 1.2e-6, 2 * 1.3 * thickness / 200);
  EXPECT_LE(end.quiet, 1e-6 * p) << "the free surface is quiet until a wave reaches it";
}

}  // namespace
}  // namespace tenon::testing

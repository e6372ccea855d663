// SPDX-License-Identifier: BSD-3-Clause
// Sod's shock tube [Sod78] in one dimension, against the exact solution of the Riemann problem.
#include <gtest/gtest.h>

#include "sph_case.hpp"

namespace tenon::testing {
namespace {

constexpr double gas_gamma = 1.4;

MaterialDescription ideal_gas(double density) {
  MaterialDescription material;
  material.name = "gas", material.density = density;
  PolynomialState state;
  state.C[4] = state.C[5] = gas_gamma - 1;
  EquationOfState equation;
  equation.law = state;
  material.equation_of_state = equation;
  return material;
}

/// Equal masses: `dense` particles a unit length at density 1, an eighth of that at 1/8. Mirrors at both ends.
SphScene tube(int dense) {
  SphScene scene;
  const auto line = [](double low, double high, int count) {
    ParticleBox box;
    box.low = {low, 0, 0}, box.high = {high, 0, 0}, box.particles = {count, 1, 1}, box.dimension = 1;
    return generate(box);
  };
  scene.mesh = particle_bodies({{"left", line(-0.5, 0, dense / 2)}, {"right", line(0, 0.5, dense / 16)}});
  SphBody left = body_of("left", ideal_gas(1)), right = body_of("right", ideal_gas(0.125));
  left.initial_energy = SpaceTimeFunction::constant(1 / (gas_gamma - 1));
  right.initial_energy = SpaceTimeFunction::constant(0.1 / 0.125 / (gas_gamma - 1));
  scene.options.bodies = {left, right};
  scene.options.dimension = 1;
  scene.options.formulation = SphFormulation::gas;
  scene.options.variable_smoothing = true;
  scene.options.artificial_conduction = 1;
  scene.options.domain.axes[0].low = -0.5, scene.options.domain.axes[0].high = 0.5;
  scene.end = 0.2;
  return scene;
}

TEST(Sod, Plateaus) {
  SphRun run(tube(640));
  run.run(0.2);
  const std::vector<double> x = run.gathered("position"), rho = run.gathered("density"), p = run.gathered("pressure"),
                            v = run.gathered("velocity");
  double sum = 0, at_star = 0, left = 0, right = 0, speed = 0, lefts = 0, rights = 0;
  for (std::size_t i = 0; i < rho.size(); ++i) {
    const double at = x[3 * i];
    if (at > 0.0 && at < 0.16) left += rho[i], ++lefts;
    if (at > 0.21 && at < 0.33) right += rho[i], ++rights;
    if ((at > 0.0 && at < 0.16) || (at > 0.21 && at < 0.33)) at_star += p[i], speed += v[3 * i], ++sum;
  }
  std::printf("p* %.5f u* %.5f rho left %.5f right %.5f; steps %lld energy %.2e\n", at_star / sum, speed / sum,
              left / lefts, right / rights, static_cast<long long>(run.simulation().steps()), run.ledger_error());
  EXPECT_NEAR(at_star / sum, 0.3031301780, 0.01 * 0.303);
  EXPECT_NEAR(speed / sum, 0.9274526200, 0.01 * 0.927);
  EXPECT_NEAR(left / lefts, 0.4263194, 0.01 * 0.426);
  EXPECT_NEAR(right / rights, 0.2655737, 0.01 * 0.266);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

}  // namespace
}  // namespace tenon::testing

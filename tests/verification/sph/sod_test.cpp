// SPDX-License-Identifier: BSD-3-Clause
// Sod's shock tube [Sod78] against the exact solution of the Riemann problem.
#include <gtest/gtest.h>

#include "shock_case.hpp"

namespace tenon::testing {
namespace {

TubeEnd run_tube(const SphScene& scene, const char* name) {
  SphRun run(scene);
  run.run(scene.end);
  TubeEnd end;
  const double ledger = run.ledger_error();
  end = end_of_tube(run);
  EXPECT_LE(ledger, 1e-11);
  if (communicator().rank() == 0)
    std::printf("%s: p* %.5f u* %.5f rho %.5f %.5f shock %.5f h %.4f L1 %.3e blip %.3f; %lld steps, energy %.1e\n",
                name, end.pressure, end.velocity, end.left, end.right, end.shock, end.spacing_behind, end.density_error,
                end.blip, static_cast<long long>(run.simulation().steps()), ledger);
  return end;
}

void expect_sod(const TubeEnd& end, double blip) {
  if (communicator().rank() != 0) return;
  EXPECT_NEAR(end.pressure, SodSolution::p_star, 0.01 * SodSolution::p_star);
  EXPECT_NEAR(end.velocity, SodSolution::u_star, 0.01 * SodSolution::u_star);
  EXPECT_NEAR(end.left, SodSolution::left_star, 0.01 * SodSolution::left_star);
  EXPECT_NEAR(end.right, SodSolution::right_star, 0.01 * SodSolution::right_star);
  EXPECT_NEAR(end.shock, 0.2 * SodSolution::shock_speed, 2 * end.spacing_behind);
  EXPECT_LE(end.density_error, 0.01);
  EXPECT_LE(end.blip, blip);
}

TEST(Sod, WithConduction) {
  expect_sod(run_tube(sod_tube(640, 1), "conduction"), 0.03);
}

TEST(Sod, WithoutConduction) {
  SphScene scene = sod_tube(640, 1);
  scene.options.artificial_conduction = 0;
  expect_sod(run_tube(scene, "none"), 0.1);
}

TEST(Sod, SwitchSharpensIt) {
  SphScene scene = sod_tube(640, 1);
  const TubeEnd plain = run_tube(scene, "plain");
  scene.options.artificial_viscosity.limiter = ArtificialViscosity::Switch::cullen_dehnen;
  const TubeEnd switched = run_tube(scene, "Cullen-Dehnen");
  expect_sod(switched, 0.03);
  if (communicator().rank() != 0) return;
  EXPECT_LT(switched.density_error, plain.density_error);
}

TEST(Sod, Order) {
  double before = 0;
  for (const int dense : {160, 320, 640}) {
    const TubeEnd end = run_tube(sod_tube(dense, 1), "order");
    if (before > 0 && communicator().rank() == 0) {
      const double order = std::log2(before / end.density_error);
      EXPECT_GT(order, 0.8) << dense;
      EXPECT_LT(order, 1.3) << dense;
    }
    before = end.density_error;
  }
}

}  // namespace
}  // namespace tenon::testing

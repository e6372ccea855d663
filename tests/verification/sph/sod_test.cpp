// SPDX-License-Identifier: BSD-3-Clause
// Sod's shock tube [Sod78] against the exact solution of the Riemann problem.
#include "sod_case.hpp"

namespace tenon::testing {
namespace {

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

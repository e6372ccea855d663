// SPDX-License-Identifier: BSD-3-Clause
// Shocks in three dimensions: Sod's tube, Noh's implosion to a point, Sedov's blast at 50^3.
#include <gtest/gtest.h>

#include "noh_case.hpp"
#include "sedov_case.hpp"

namespace tenon::testing {
namespace {

TEST(SodInThreeDimensions, Plateaus) {
  SphRun run(sod_tube(640 / 4, 3));
  run.run(0.2);
  EXPECT_LE(run.ledger_error(), 1e-11);
  const TubeEnd end = end_of_tube(run);
  if (communicator().rank() != 0) return;
  std::printf("Sod, 3-D: p* %.5f u* %.5f rho %.5f %.5f shock %.5f h %.4f L1 %.3e blip %.3f; %lld steps\n", end.pressure,
              end.velocity, end.left, end.right, end.shock, end.spacing_behind, end.density_error, end.blip,
              static_cast<long long>(run.simulation().steps()));
  EXPECT_NEAR(end.pressure, SodSolution::p_star, 0.01 * SodSolution::p_star);
  EXPECT_NEAR(end.velocity, SodSolution::u_star, 0.01 * SodSolution::u_star);
  EXPECT_NEAR(end.left, SodSolution::left_star, 0.01 * SodSolution::left_star);
  EXPECT_NEAR(end.right, SodSolution::right_star, 0.015 * SodSolution::right_star);
  EXPECT_NEAR(end.shock, 0.2 * SodSolution::shock_speed, 2 * end.spacing_behind);
}

TEST(NohInThreeDimensions, Plateau) {
  const SphScene scene = noh(40, 3);
  SphRun run(scene);
  run.run(scene.end);
  EXPECT_LE(run.ledger_error(), 1e-11);
  const std::vector<double> x = run.gathered("position"), rho = run.gathered("density");
  if (communicator().rank() != 0) return;
  double plateau = 0, inside = 0, shock = 0;
  for (std::size_t i = 0; i < rho.size(); ++i) {
    const double r = std::hypot(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    if (r > 0.08 && r < 0.15) plateau += rho[i], ++inside;
    if (rho[i] > 0.5 * (64 + 16)) shock = std::max(shock, r);
  }
  std::printf("Noh, point: plateau %.2f shock %.4f; %lld steps\n", plateau / inside, shock,
              static_cast<long long>(run.simulation().steps()));
  EXPECT_GT(plateau / inside, 50);
  EXPECT_LT(plateau / inside, 66);
  EXPECT_NEAR(shock, 0.2, 0.05 * 0.2);
}

TEST(Sedov, Fifty) {
  const SedovEnd end = run_sedov(sedov(50, true));
  if (communicator().rank() != 0) return;
  EXPECT_NEAR(end.radius, SedovSolution::radius, 0.015 * SedovSolution::radius);
  EXPECT_GE(end.peak, 3.3);
  EXPECT_NEAR(end.kinetic, SedovSolution::kinetic, 0.03 * SedovSolution::kinetic);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Shocks in three dimensions: Sedov's blast [Sed59] and Noh's implosion [Noh87], an octant of each, and Sod's tube
// [Sod78].
#include "noh_case.hpp"
#include "sedov_case.hpp"
#include "sod_case.hpp"

namespace tenon::testing {
namespace {

/// The radius is where the pressure is half way up. The density will not do: the shell of dense gas, which ends 5 % of
/// the radius behind the front, is thinner than a smoothing length, so its peak is a blur whose edge lies outside.
TEST(Sedov, Fifty) {
  const SedovEnd end = run_sedov(sedov(50, true));
  if (communicator().rank() != 0) return;
  EXPECT_NEAR(end.radius, SedovSolution::radius, 0.015 * SedovSolution::radius);
  EXPECT_GE(end.peak, 3.3);
  EXPECT_NEAR(end.kinetic, SedovSolution::kinetic, 0.03 * SedovSolution::kinetic);
}

/// Six by six particles across.
TEST(Sod, ThreeDimensions) {
  expect_sod(run_tube(sod_tube(640, 3), "three dimensions"), 0.03);
}

/// A coarse one: 64 behind the shock takes 10^6 particles to come near; what must hold is where the shock is.
TEST(Noh, Point) {
  constexpr double shell = 0.01, shock = 0.2;
  SphRun run(noh(25, 3));
  run.run(0.6);
  EXPECT_LE(run.ledger_error(), 1e-11);
  const std::vector<double> x = run.gathered("position"), rho = run.gathered("density");
  if (communicator().rank() != 0) return;
  std::array<double, 40> mean{}, count{};
  for (std::size_t i = 0; i < rho.size(); ++i) {
    const auto s = static_cast<std::size_t>(std::hypot(x[3 * i], x[3 * i + 1], x[3 * i + 2]) / shell);
    if (s < mean.size()) mean[s] += rho[i], ++count[s];
  }
  for (std::size_t s = 0; s < mean.size(); ++s) mean[s] /= std::max(count[s], 1.0);
  const double top = *std::max_element(mean.begin(), mean.end());
  double front = 0;
  for (std::size_t s = 1; s < mean.size(); ++s) {
    const double half = 0.5 * (top + 16);
    if (mean[s - 1] > half && mean[s] <= half)
      front = shell * (s - 0.5 + (mean[s - 1] - half) / (mean[s - 1] - mean[s]));
  }
  std::printf("Noh, point: rho %.2f shock %.4f\n", top, front);
  EXPECT_GE(top, 40);
  EXPECT_NEAR(front, shock, 0.1 * shock);
}

}  // namespace
}  // namespace tenon::testing

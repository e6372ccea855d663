// SPDX-License-Identifier: BSD-3-Clause
// Sedov's blast [Sed59], small: energy, symmetry, the fraction of kinetic energy.
#include <gtest/gtest.h>

#include "sedov_case.hpp"

namespace tenon::testing {
namespace {

TEST(Sedov, Octant) {
  const SedovEnd end = run_sedov(sedov(24, true));
  if (communicator().rank() != 0) return;
  EXPECT_NEAR(end.radius, SedovSolution::radius, 0.04 * SedovSolution::radius);
  EXPECT_GE(end.peak, 1.9);
  EXPECT_NEAR(end.kinetic, SedovSolution::kinetic, 0.03 * SedovSolution::kinetic);
}

/// A cube of particles stays a cube: mirror images stay mirror images, but for the order of sums.
TEST(Sedov, KeepsTheSymmetryOfALattice) {
  constexpr int across = 10;
  SphRun run(sedov(across, false));
  run.steps(60);
  const std::vector<double> x = run.gathered("position");
  if (communicator().rank() != 0) return;
  double worst = 0, way = 0;
  const auto place = [](int i, int j, int k) { return static_cast<std::size_t>((k * across + j) * across + i); };
  for (int k = 0; k < across; ++k)
    for (int j = 0; j < across; ++j)
      for (int i = 0; i < across; ++i) {
        const std::size_t a = place(i, j, k), b = place(across - 1 - i, j, k), c = place(j, i, k);
        worst = std::max({worst, std::abs(x[3 * a] + x[3 * b]), std::abs(x[3 * a] - x[3 * c + 1])});
        way = std::max(way, std::abs(x[3 * a] - ((i + 0.5) / across - 0.5)));
      }
  EXPECT_GT(way, 0.01);
  EXPECT_LE(worst, 1e-6);
}

}  // namespace
}  // namespace tenon::testing

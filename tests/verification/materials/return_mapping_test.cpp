// SPDX-License-Identifier: BSD-3-Clause
// Cases A08 (return mapping) and F01 (adiabatic plastic heating) at a material point.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "material_point.hpp"

namespace tenon::testing {
namespace {

using Point = MaterialPoint<J2LinearHardening>;
constexpr double sigma_y = 400e6;

Point virgin(double hardening) {
  return {{steel, sigma_y, hardening}};
}

TEST(ReturnMapping, UniaxialStressMatchesTheTableAtAnyStep) {  // A08 (a)
  const double table[][3] = {{0.001, 200e6, 0}, {0.002, 400e6, 0}, {0.005, 402985074.6, 0.002985074627}};
  for (const auto& [strain, stress, eqps] : table)
    for (const int steps : {1, 3, 50}) {
      Point p = virgin(1e9);
      for (int i = 0; i < steps; ++i) p.pull(strain / steps);
      EXPECT_NEAR(p[0], stress, 1e-9 * stress) << strain << " in " << steps;
      EXPECT_NEAR(p.eqps(), eqps, 1e-12);
    }
}

/// Path of A08 (b) in n steps per segment.
Point non_proportional(double H, int n) {
  Point p = virgin(H);
  for (int segment = 0; segment < 2; ++segment)
    for (int i = 0; i < n; ++i) {
      const double d = 0.004 / n;
      p.strain(segment == 0 ? Tensor{d, -d / 2, -d / 2, 0, 0, 0} : Tensor{0, 0, 0, d, 0, 0});
    }
  return p;
}

TEST(ReturnMapping, NonProportionalPathConvergesToKriegAndKrieg) {
  const Point p = non_proportional(0, 4096);
  EXPECT_NEAR(p[0], 36.95192482e6, 7e-5 * sigma_y);
  EXPECT_NEAR(p[1], -18.47596241e6, 7e-5 * sigma_y);
  EXPECT_NEAR(p[3], 228.7121548e6, 7e-5 * sigma_y);
  EXPECT_NEAR(p.eqps(), 5.692394947e-3, 1e-6);
}

TEST(ReturnMapping, NonProportionalPathWithHardening) {
  const Point p = non_proportional(2e9, 4096);
  EXPECT_NEAR(p[0], 39.80398252e6, 7e-5 * sigma_y);
  EXPECT_NEAR(p[3], 234.9239342e6, 7e-5 * sigma_y);
  EXPECT_NEAR(p.eqps(), 5.628650619e-3, 1e-6);
}

TEST(ReturnMapping, NonProportionalErrorIsThatOfRadialReturnAndOfFirstOrder) {
  const std::vector<double> expected{14.2, 8.8, 5.1, 2.8, 1.45, 0.74, 0.37};  // % of sigma_y at n = 1 ... 64
  double previous = 0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const double error = std::abs(non_proportional(0, 1 << k)[0] - 36.95192482e6) / sigma_y * 100;
    EXPECT_NEAR(error, expected[k], 0.05) << "n = " << (1 << k);
    if (k + 1 == expected.size()) {
      EXPECT_NEAR(std::log2(previous / error), 1, 0.05);
    }
    previous = error;
  }
}

TEST(PlasticHeat, AdiabaticHeatingMatchesTheTable) {  // F01, at any step
  const std::vector<std::array<double, 3>> table{
      {0.05, 1e9, 5.045843006}, {0.1, 1e9, 10.9065028}, {0.2, 1e9, 24.47855705}, {0.5, 1e9, 80.0006}, {0.5, 0, 49.648}};
  for (const auto& [strain, H, rise] : table)
    for (const int steps : {1, 25}) {
      Point p = virgin(H);
      for (int i = 0; i < steps; ++i) p.pull(strain / steps);
      EXPECT_NEAR(0.9 * p.plastic_work / (7850 * 460), rise, 1e-5 * rise) << strain << " " << H << " " << steps;
    }
}

}  // namespace
}  // namespace tenon::testing

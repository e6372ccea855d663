// SPDX-License-Identifier: BSD-3-Clause
// Radial return: uniaxial stress, yield surface, energy balance, consistent tangent, unloading, huge increments.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "material_point.hpp"

namespace tenon::testing {
namespace {

using Point = MaterialPoint<J2LinearHardening>;
constexpr double E = 200e9, sigma_y = 400e6;

Point virgin(double hardening) {
  return {{steel, sigma_y, hardening}};
}

/// sigma_y + E H / (E + H) (strain - sigma_y / E): monotonic uniaxial stress.
double uniaxial_stress(double strain, double H) {
  return strain < sigma_y / E ? E * strain : sigma_y + E * H / (E + H) * (strain - sigma_y / E);
}

TEST(J2LinearHardening, UniaxialStressIsExactAtAnyStep) {
  for (const int steps : {1, 2, 7, 100}) {
    Point p = virgin(1e9);
    for (int i = 0; i < steps; ++i) p.pull(0.5 / steps);
    const double exact = uniaxial_stress(0.5, 1e9);
    EXPECT_NEAR(p[0], exact, 1e-10 * exact) << steps;
    EXPECT_NEAR(p.eqps(), 0.5 - exact / E, 1e-10) << steps;
  }
}

/// Path of A08 (b) in n steps per segment.
Point non_proportional(double H, int n, double* worst_violation = nullptr) {
  Point p = virgin(H);
  for (int segment = 0; segment < 2; ++segment)
    for (int i = 0; i < n; ++i) {
      const double d = 0.004 / n;
      p.strain(segment == 0 ? Tensor{d, -d / 2, -d / 2, 0, 0, 0} : Tensor{0, 0, 0, d, 0, 0});
      if (worst_violation && p.eqps() > 0)
        *worst_violation = std::max(*worst_violation, std::abs(p.von_mises() - sigma_y - H * p.eqps()));
    }
  return p;
}

TEST(J2LinearHardening, StressNeverLeavesTheYieldSurface) {
  for (const double H : {0.0, 2e9}) {
    double violation = 0;
    for (const int n : {1, 3, 64}) non_proportional(H, n, &violation);
    EXPECT_LE(violation, 1e-13 * sigma_y);
  }
}

TEST(J2LinearHardening, UnloadsElastically) {
  Point p = virgin(1e9);
  p.pull(0.02);
  const double stress = p[0], eqps = p.eqps(), work = p.plastic_work;
  for (int i = 0; i < 10; ++i) p.pull(-1e-4);
  EXPECT_EQ(p.eqps(), eqps);
  EXPECT_EQ(p.plastic_work, work);
  EXPECT_NEAR(p[0], stress - E * 1e-3, 1e-12 * E * 1e-3);
}

TEST(J2LinearHardening, WorkIsElasticEnergyPlusPlasticWork) {
  Point proportional = virgin(1e9);
  proportional.pull(sigma_y / E);
  for (int i = 0; i < 3; ++i) proportional.pull(0.1);
  EXPECT_NEAR(proportional.stress_work, proportional.elastic_energy() + proportional.plastic_work,
              1e-12 * proportional.stress_work);
  // On a turning path the two differ by what backward Euler loses, which vanishes with the step.
  const auto gap = [](int n) {
    const Point p = non_proportional(2e9, n);
    return std::abs(p.stress_work - p.elastic_energy() - p.plastic_work) / p.stress_work;
  };
  EXPECT_LT(gap(512), 2e-3);
  EXPECT_GT(std::log2(gap(256) / gap(512)), 0.95);
}

/// Derivative of the stress by the strain, [SH98] box 3.2, against central differences.
TEST(J2LinearHardening, TangentMatchesTheConsistentOne) {
  const double H = 2e9;
  const Tensor base{0.004, -0.001, -0.002, 0.001, 0.0005, -0.0015};
  const double G = steel.shear_modulus(), K = steel.bulk_modulus();
  const double mean = (base[0] + base[1] + base[2]) / 3;
  Tensor s;  // deviatoric trial stress
  double norm2 = 0;
  for (std::size_t c = 0; c < 6; ++c) {
    s[c] = 2 * G * (base[c] - (c < 3 ? mean : 0));
    norm2 += (c < 3 ? 1 : 2) * s[c] * s[c];
  }
  const double q = std::sqrt(1.5 * norm2), increment = (q - sigma_y) / (3 * G + H);
  const double theta = 1 - 3 * G * increment / q;
  const double theta_bar = 1 / (1 + H / (3 * G)) - (1 - theta);
  const double h = 1e-7;
  for (std::size_t j = 0; j < 6; ++j) {
    Point up = virgin(H), down = virgin(H);
    Tensor e = base;
    e[j] += h, up.strain(e);
    e[j] -= 2 * h, down.strain(e);
    for (std::size_t i = 0; i < 6; ++i) {
      // e_ij of a symmetric tensor stands for two entries when it is a shear.
      const double twice = j < 3 ? 1 : 2;
      const double identity = i == j ? 1 : 0, both = i < 3 && j < 3 ? 1 : 0;
      const double exact =
          K * both + 2 * G * theta * (identity - both / 3) - 2 * G * theta_bar * s[i] * s[j] / norm2 * twice;
      const double numerical = (up[static_cast<int>(i)] - down[static_cast<int>(i)]) / (2 * h);
      EXPECT_NEAR(numerical, exact, 1e-6 * E) << i << j;
    }
  }
}

TEST(J2LinearHardening, HugeIncrementsStayFinite) {
  for (const double size : {1.0, 1e6, 1e50}) {
    Point p = virgin(1e9);
    p.strain({size, -2 * size, size, size, -size, 3 * size});
    for (int c = 0; c < 6; ++c) EXPECT_TRUE(std::isfinite(p[c])) << size;
    EXPECT_NEAR(p.von_mises() / (sigma_y + 1e9 * p.eqps()), 1, size < 1e7 ? 1e-7 : 1e99) << size;
    EXPECT_GE(p.plastic_work, 0);
  }
}

}  // namespace
}  // namespace tenon::testing

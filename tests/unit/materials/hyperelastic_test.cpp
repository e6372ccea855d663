// SPDX-License-Identifier: BSD-3-Clause
// Rubber: closed forms, energy over closed paths, objectivity, and the bound of the wave speeds.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "components/materials/hyperelastic.hpp"
#include "deforming_point.hpp"

namespace tenon::testing {
namespace {

const MooneyRivlinParameters soft{0.4e6, 0.1e6, 50e6}, neo{0.5e6, 0, 20e6};

MooneyRivlin rubber(const MooneyRivlinParameters& p, double expansion = 0) {
  return {MooneyRivlin::small_strain(p, expansion), p};
}
Matrix cauchy(const MooneyRivlin& m, const Matrix& F) {
  DeformingPoint<MooneyRivlin> p(m);
  p.deform(F);
  return p.tensor();
}
double energy(const MooneyRivlin& m, const Matrix& F) {
  double f[9];
  for (std::size_t i = 0; i < 9; ++i) f[i] = F[i / 3][i % 3];
  return m.energy(f);
}

TEST(MooneyRivlin, SmallStrainsFollowHooke) {
  const MooneyRivlin m = rubber(soft);
  EXPECT_NEAR(m.elasticity.shear_modulus(), 1e6, 1e-6);
  EXPECT_NEAR(m.elasticity.bulk_modulus(), 50e6, 1e-6);
  const double e = 1e-6;
  const Matrix s = cauchy(m, stretch(1 + e, 1, 1));
  EXPECT_NEAR(s[0][0], m.elasticity.p_wave_modulus() * e, 1e-5 * m.elasticity.p_wave_modulus() * e);
  EXPECT_NEAR(s[1][1], m.elasticity.lame_lambda() * e, 1e-5 * m.elasticity.p_wave_modulus() * e);
}

/// Without change of volume: s1 - s2 = 2 (C10 + C01 / l^2) ... of the principal stretches ([Hol00] eq. 6.128).
TEST(MooneyRivlin, UniaxialAndBiaxialDifferencesAreThoseOfTheClosedForm) {
  for (const auto& p : {soft, neo})
    for (const double l : {0.3, 0.8, 1.5, 4.0}) {
      const double l2 = l * l;
      const Matrix uniaxial = cauchy(rubber(p), stretch(l, 1 / std::sqrt(l), 1 / std::sqrt(l)));
      const double exact = 2 * (l2 - 1 / l) * (p.C10 + p.C01 / l);
      EXPECT_NEAR(uniaxial[0][0] - uniaxial[1][1], exact, 1e-12 * std::abs(exact) + 1e-6);
      const Matrix biaxial = cauchy(rubber(p), stretch(l, l, 1 / l2));
      const double equal = 2 * (l2 - 1 / (l2 * l2)) * (p.C10 + p.C01 * l2);
      EXPECT_NEAR(biaxial[0][0] - biaxial[2][2], equal, 1e-11 * std::abs(equal) + 1e-6);
    }
}

TEST(MooneyRivlin, SimpleShearHasThePoyntingEffect) {
  for (const double k : {0.01, 1.0, 5.0}) {
    const Matrix s = cauchy(rubber(soft), {{{1, k, 0}, {0, 1, 0}, {0, 0, 1}}});
    EXPECT_NEAR(s[0][1], 2 * (soft.C10 + soft.C01) * k, 1e-9 * 1e6);
    EXPECT_NEAR(s[0][0] - s[2][2], 2 * soft.C10 * k * k, 1e-8 * 1e6);
    EXPECT_NEAR(s[1][1] - s[2][2], -2 * soft.C01 * k * k, 1e-8 * 1e6);
  }
}

TEST(MooneyRivlin, VolumeAloneGivesPressureAlone) {
  for (const double J : {0.5, 1.0, 1.7}) {
    const double l = std::cbrt(J);
    const Matrix s = cauchy(rubber(soft), stretch(l, l, l));
    EXPECT_NEAR(s[0][0], 25e6 * (J - 1 / J), 1e-6);
    EXPECT_NEAR(s[0][1], 0, 1e-9);
  }
}

/// Stress power over a smooth closed path: the trapezium is exact there to round-off. P : dF/dt, P = J s F^-T.
TEST(MooneyRivlin, ClosedPathsReturnAllWork) {
  const MooneyRivlin m = rubber(soft);
  constexpr int points = 256;
  double sum = 0, size = 0;
  for (int i = 0; i < points; ++i) {
    const double t = 2 * std::numbers::pi * i / points, c = std::cos(t), s = std::sin(t);
    const Matrix F{{{1.2 + 0.3 * c, 0.2 * s, 0.1}, {0.15 * c, 1 - 0.2 * s, 0.1 * s}, {0, 0.2 * c * s, 0.9 + 0.1 * s}}};
    const Matrix rate{{{-0.3 * s, 0.2 * c, 0}, {-0.15 * s, -0.2 * c, 0.1 * c}, {0, 0.2 * (c * c - s * s), 0.1 * c}}};
    const Matrix P = cauchy(m, F) * transposed(inverse(F));
    double power = 0;
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) power += determinant(F) * P[a][b] * rate[a][b];
    sum += power / points, size += std::abs(power) / points;
  }
  EXPECT_LT(std::abs(sum), 1e-12 * size);
}

TEST(MooneyRivlin, StressIsTheSlopeOfTheEnergy) {
  const MooneyRivlin m = rubber(soft);
  const Matrix F{{{1.3, 0.2, -0.1}, {0.4, 0.8, 0.1}, {0, -0.3, 1.1}}};
  const Matrix P = cauchy(m, F) * transposed(inverse(F));
  const double h = 1e-6;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      Matrix up = F, down = F;
      up[i][j] += h, down[i][j] -= h;
      EXPECT_NEAR(determinant(F) * P[i][j], (energy(m, up) - energy(m, down)) / (2 * h), 0.1) << i << j;
    }
}

TEST(MooneyRivlin, TurnsWithTheBody) {
  const MooneyRivlin m = rubber(soft);
  const Matrix F{{{1.3, 0.2, -0.1}, {0.4, 0.8, 0.1}, {0, -0.3, 1.1}}}, R = turn(1.234);
  const Matrix turned = cauchy(m, R * F), expected = R * cauchy(m, F) * transposed(R), spun = cauchy(m, R);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(turned[i][j], expected[i][j], 1e-6);
      EXPECT_NEAR(spun[i][j], 0, 1e-7);  // round-off of K = 50 MPa
    }
}

TEST(MooneyRivlin, FreeHeatingLeavesNoStress) {
  DeformingPoint<MooneyRivlin> p(rubber(soft, 2e-4));
  const double l = std::exp(2e-4 * 100);
  p.deform(stretch(l, l, l), 1, 0, 100);
  for (int c = 0; c < 6; ++c) EXPECT_NEAR(p[c], 0, 1e-6);
}

/// rho c^2 of random waves by second differences of the energy: never above the bound, which is exact without strain.
TEST(MooneyRivlin, StiffnessBoundsEveryWave) {
  std::mt19937 generator(9);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto direction = [&] {
    std::array<double, 3> n{uniform(generator), uniform(generator), uniform(generator)};
    const double size = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (double& x : n) x /= size;
    return n;
  };
  for (const auto& parameters : {soft, neo})
    for (int trial = 0; trial < 60; ++trial) {
      Matrix F = identity();
      for (auto& row : F)
        for (double& x : row) x += trial == 0 ? 0 : 0.5 * uniform(generator);
      if (determinant(F) < 0.2) continue;
      DeformingPoint<MooneyRivlin> p(rubber(parameters));
      p.deform(F);
      const double bound = p.moduli[0][0] + 2 * p.moduli[1][0];
      if (trial == 0) {
        EXPECT_NEAR(bound, p.material.elasticity.p_wave_modulus(), 1e-6 * bound);
      }
      double worst = 0;
      for (int wave = 0; wave < 200; ++wave) {
        const auto n = direction(), m = wave % 2 ? n : direction();
        const double h = 1e-4;
        const auto at = [&](double x) {
          Matrix moved = identity();
          for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) moved[i][j] += x * m[i] * n[j];
          return energy(p.material, moved * F);
        };
        worst = std::max(worst, (at(h) - 2 * at(0) + at(-h)) / (h * h) / determinant(F));
      }
      EXPECT_LE(worst, bound * (1 + 1e-5)) << trial;
      EXPECT_GT(worst, 0.2 * bound) << trial;  // and is not idle
    }
}

}  // namespace
}  // namespace tenon::testing

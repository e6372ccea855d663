// SPDX-License-Identifier: BSD-3-Clause
// Crushable foam (A12 at a point) and the principal values that it needs.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "components/materials/crushable_foam.hpp"
#include "components/materials/lane_principal.hpp"
#include "deforming_point.hpp"

namespace tenon::testing {
namespace {

constexpr double E = 100e6, plateau = 2e6, lock = 50 * E;

CrushableFoam foam(double cutoff = plateau) {
  const PiecewiseLinear strength({{0, plateau}, {0.7, plateau}, {0.71, plateau + 0.01 * lock}},
                                 PiecewiseLinear::End::continue_slope);
  return {Elasticity{E, 0, 0}, strength, cutoff};
}
double strength_at(double crush) {
  return crush < 0.7 ? plateau : plateau + lock * (crush - 0.7);
}

TEST(CrushableFoam, CrushFollowsThePlateauAndThenLocks) {
  DeformingPoint<CrushableFoam> p(foam());
  double work_to_half = 0;
  for (int i = 1; i <= 740; ++i) {
    const double crush = 1e-3 * i;
    p.deform(stretch(1 - crush, 1, 1));
    if (crush > 0.025) {
      ASSERT_NEAR(p[0], -strength_at(crush), 1e-6 * strength_at(crush)) << crush;
    }
    ASSERT_EQ(p[1], 0);  // nothing pushes sideways
    ASSERT_EQ(p[2], 0);
    if (i == 500) work_to_half = p.work;
  }
  EXPECT_NEAR(work_to_half, 0.5 * plateau - 0.5 * plateau * plateau / E, 1e-3 * 1e6);
  EXPECT_NEAR(p.state[0][0], 0.74, 1e-12);
}

TEST(CrushableFoam, PlasticWorkAndElasticEnergyMakeUpTheWork) {
  DeformingPoint<CrushableFoam> p(foam());
  for (int i = 1; i <= 2000; ++i) p.deform(stretch(1 - 2.5e-4 * i, 1, 1));
  EXPECT_NEAR(p.plastic_work + 0.5 * 0.5 * plateau * plateau / E, p.work, 2e-2 * p.work);
  EXPECT_GT(p.plastic_work, 0.9 * p.work);
}

TEST(CrushableFoam, DirectionOfTheCrushDoesNotMatter) {
  DeformingPoint<CrushableFoam> straight(foam()), skew(foam());
  const Matrix R = turn(0.7);
  for (int i = 1; i <= 72; ++i) {
    const Matrix F = stretch(1 - 0.01 * i, 1 - 0.001 * i, 1);
    straight.deform(F), skew.deform(R * F * transposed(R));
  }
  const Matrix expected = R * straight.tensor() * transposed(R);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(skew.tensor()[i][j], expected[i][j], 1e-8 * std::abs(straight[0])) << i << j;
}

TEST(CrushableFoam, UnloadsElasticallyIntoTension) {
  DeformingPoint<CrushableFoam> p(foam(0.5e6));
  for (int i = 1; i <= 300; ++i) p.deform(stretch(1 - 1e-3 * i, 1, 1));
  const double l = 0.7, e = 0.01;
  p.deform(stretch(l * std::exp(e), 1, 1));
  EXPECT_NEAR(p[0], -plateau + E * e, 1e-4 * E * e);
  EXPECT_NEAR(p.state[0][0], 0.3, 1e-12);
  for (int i = 0; i < 50; ++i) p.deform(stretch(p.F[0][0] * 1.001, 1, 1));
  EXPECT_NEAR(p[0], 0.5e6, 1e-6 * plateau);
}

TEST(CrushableFoam, StiffensBeforeItLocks) {
  DeformingPoint<CrushableFoam> p(foam());
  p.deform(stretch(0.5, 1, 1));
  EXPECT_NEAR(p.moduli[0][0] + 2 * p.moduli[1][0], E, 1e-6 * E);
  for (double x = 0.5; x > 0.32; x -= 0.01) p.deform(stretch(x, 1, 1));
  EXPECT_GT(p.moduli[0][0] + 2 * p.moduli[1][0], lock * 0.25);
}

TEST(Principal, ReproducesAnyTensor) {
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    Batch<6> s;
    for (int l = 0; l < lanes; ++l) {
      const double scale = std::pow(10, 12 * uniform(generator));
      const double kind = uniform(generator);
      for (int c = 0; c < 6; ++c) s[c][l] = kind > 0.7 ? (c < 3 ? scale : 0) : scale * uniform(generator);
      if (kind < -0.7) s[3][l] *= 1e-14, s[4][l] = 0, s[1][l] = s[0][l];  // nearly equal values
      if (kind < -0.95)
        for (int c = 0; c < 6; ++c) s[c][l] = 0;
    }
    const PrincipalLanes p = principal(s);
    constexpr int from[6] = {0, 1, 2, 0, 1, 2}, to[6] = {0, 1, 2, 1, 2, 0};
    for (int l = 0; l < lanes; ++l) {
      double size = 0;
      for (int c = 0; c < 6; ++c) size += std::abs(s[c][l]);
      for (int c = 0; c < 6; ++c) {
        double sum = 0, unit = 0;
        for (int i = 0; i < 3; ++i) {
          sum += p.value[i][l] * p.axis[i][from[c]][l] * p.axis[i][to[c]][l];
          unit += p.axis[i][from[c]][l] * p.axis[i][to[c]][l];
        }
        ASSERT_NEAR(sum, s[c][l], 1e-14 * size) << trial;
        ASSERT_NEAR(unit, c < 3 ? 1 : 0, 1e-14);
      }
    }
  }
}

}  // namespace
}  // namespace tenon::testing

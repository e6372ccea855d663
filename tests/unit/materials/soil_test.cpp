// SPDX-License-Identifier: BSD-3-Clause
// Soil: compaction along its table, unloading, parting, and shear strength under pressure.
#include <gtest/gtest.h>

#include <cmath>

#include "components/materials/soil.hpp"
#include "deforming_point.hpp"

namespace tenon::testing {
namespace {

const Elasticity sand{100e6, 0.25, 0};  // K = 66.7 MPa, G = 40 MPa
const PiecewiseLinear curve({{0, 0}, {0.05, 0.5e6}, {0.2, 5e6}}, PiecewiseLinear::End::continue_slope);

Soil soil(double cutoff = 0, double a0 = 1e8, double a1 = 1e4, double a2 = 0.3) {
  return {sand, curve, a0, a1, a2, cutoff};
}
Matrix compacted(double compaction) {
  const double l = std::exp(-compaction / 3);
  return stretch(l, l, l);
}

TEST(Soil, FirstLoadingFollowsTheTable) {
  DeformingPoint<Soil> p(soil());
  for (int i = 1; i <= 30; ++i) {
    p.deform(compacted(0.01 * i));
    ASSERT_NEAR(p.pressure(), curve(0.01 * i), 1e-6 * 5e6);
    ASSERT_NEAR(p.von_mises(), 0, 1e-3);
  }
}

TEST(Soil, UnloadsAndReloadsWithTheBulkModulus) {
  DeformingPoint<Soil> p(soil(1e4));
  p.deform(compacted(0.1));
  const double top = curve(0.1), K = sand.bulk_modulus();
  p.deform(compacted(0.08));
  EXPECT_NEAR(p.pressure(), top - K * 0.02, 1);
  p.deform(compacted(0.0));
  EXPECT_NEAR(p.pressure(), -1e4, 1e-6);  // parted
  p.deform(compacted(0.09));
  EXPECT_NEAR(p.pressure(), top - K * 0.01, 1);
  p.deform(compacted(0.15));
  EXPECT_NEAR(p.pressure(), curve(0.15), 1);
  EXPECT_NEAR(p.state[1][0], 0.15, 1e-12);
}

/// What a cycle of compaction costs: the area under the table less what unloading gives back.
TEST(Soil, CompactionWorkIsTheAreaThatStays) {
  DeformingPoint<Soil> p(soil());
  double work = 0;
  for (int i = 1; i <= 40; ++i) {
    const double before = p.plastic_work;
    p.deform(compacted(0.005 * i));
    work += (p.plastic_work - before) / (0.5 * (std::exp(-0.005 * i) + std::exp(-0.005 * (i - 1))));
  }
  const double area = 0.5 * 0.5e6 * 0.05 + 0.5 * (0.5e6 + 5e6) * 0.15, back = 0.5 * 5e6 * 5e6 / sand.bulk_modulus();
  EXPECT_NEAR(work, area - back, 1e-9 * area);
}

TEST(Soil, StrengthDependsOnThePressureAsGiven) {
  for (const double compaction : {0.0, 0.03, 0.15}) {
    DeformingPoint<Soil> p(soil());
    const Matrix start = compacted(compaction);
    p.deform(start);
    const double pressure = curve(compaction);
    for (int i = 1; i <= 50; ++i) {
      const double s = std::exp(0.002 * i);  // isochoric
      p.deform(stretch(s, 1 / s, 1) * start);
    }
    const double strength = std::sqrt(3 * (1e8 + 1e4 * pressure + 0.3 * pressure * pressure));
    EXPECT_NEAR(p.pressure(), pressure, 1e-6 * 5e6);
    EXPECT_NEAR(p.von_mises(), strength, 1e-9 * strength);
    // Total shear 0.2/sqrt(3) of equivalent strain, less what is elastic; logarithmic strains, midpoint rule.
    EXPECT_NEAR(p.state[0][0] + strength / (3 * sand.shear_modulus()), 0.2 / std::sqrt(3.0), 1e-6);
  }
}

TEST(Soil, HasNoStrengthBeyondItsApex) {
  DeformingPoint<Soil> p(soil(1e6, 0, 1e4, 0));  // no cohesion
  p.deform(stretch(1.01, 1.005, 1));
  EXPECT_NEAR(p.von_mises(), 0, 1e-6);
  EXPECT_NEAR(p.pressure(), -sand.bulk_modulus() * std::log(1.01 * 1.005), 1e-3);
}

}  // namespace
}  // namespace tenon::testing

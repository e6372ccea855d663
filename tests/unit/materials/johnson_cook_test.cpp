// SPDX-License-Identifier: BSD-3-Clause
// Johnson-Cook against its closed form, its limits and its reduction to linear hardening.
#include <gtest/gtest.h>

#include <cmath>

#include "material_point.hpp"

namespace tenon::testing {
namespace {

using Point = MaterialPoint<JohnsonCook>;
const Elasticity copper{124e9, 0.34, 0};
const JohnsonCookParameters copper_flow{90e6, 292e6, 0.31, 0.025, 1.09, 1, 293.15, 1356};  // OFHC copper, [JC83]

double closed_form(const JohnsonCookParameters& p, double eqps, double rate, double T) {
  const double t =
      std::clamp((T - p.reference_temperature) / (p.melting_temperature - p.reference_temperature), 0., 1.);
  return (p.A + p.B * std::pow(eqps, p.n)) * (1 + p.C * std::log(std::max(1., rate / p.reference_strain_rate))) *
         (1 - std::pow(t, p.m));
}

TEST(JohnsonCook, StressIsThatOfTheClosedFormAtEveryRateAndTemperature) {
  for (const double rate : {1e-3, 1.0, 1e3, 1e6})
    for (const double T : {200.0, 293.15, 600.0, 1300.0}) {
      Point p{{copper, copper_flow}};
      p.temperature = T;
      const double d = 1e-3, dt = d / rate;
      for (int i = 0; i < 300; ++i) {
        const double before = p.eqps();
        p.strain({d, -d / 2, -d / 2, 0, 0, 0}, dt);
        const double increment = p.eqps() - before;
        if (increment == 0) continue;
        const double exact = closed_form(copper_flow, p.eqps(), increment / dt, T);
        ASSERT_NEAR(p.von_mises(), exact, 1e-11 * exact) << rate << " " << T << " step " << i;
      }
      EXPECT_NEAR(p.state[1][0], rate, 5e-3 * rate);  // all but plastic by then
    }
}

/// The solution satisfies consistency: trial - 3 G increment = flow stress.
TEST(JohnsonCook, StressStrainAndFlowAreConsistent) {
  for (const double n : {0.05, 0.168, 0.31, 1.0, 2.0})
    for (const double d : {7.3e-4, 1e-2, 1.0})
      for (const double dt : {1e-12, 1e-7, 1.0}) {
        JohnsonCookParameters flow = copper_flow;
        flow.n = n;
        Point p{{copper, flow}};
        p.strain({d, -d / 2, -d / 2, d, 0, 0}, dt);
        const double three_g = 3 * copper.shear_modulus();
        const double trial = three_g * d * std::sqrt(1 + 4.0 / 3);
        EXPECT_NEAR(p.von_mises() + three_g * p.eqps(), trial, 2e-12 * trial) << n << " " << d << " " << dt;
        EXPECT_GT(p.eqps(), 0);
      }
}

TEST(JohnsonCook, BarelyYieldingVirginMaterialIsResolved) {
  JohnsonCookParameters flow = copper_flow;
  flow.C = 0;
  for (const double n : {0.05, 0.168, 0.31})
    for (const double over : {1e-9, 1e-6, 1e-3}) {
      flow.n = n;
      Point p{{copper, flow}};
      const double gamma = flow.A * (1 + over) / (2 * copper.shear_modulus() * std::sqrt(3.0));
      p.strain({0, 0, 0, gamma, 0, 0});
      EXPECT_GE(p.eqps(), 0);
      EXPECT_NEAR(p.von_mises(), flow.A * (1 + over), 3e-4 * flow.A);
      EXPECT_GE(p.von_mises(), flow.A * (1 - 1e-12));
    }
}

TEST(JohnsonCook, ReducesToLinearHardening) {
  const JohnsonCookParameters flow{400e6, 1e9, 1, 0, 1, 1, 293.15, 1500};
  Point p{{steel, flow}};
  MaterialPoint<J2LinearHardening> j2{{steel, 400e6, 1e9}};
  for (int i = 0; i < 40; ++i) {
    const Tensor e{1e-3, -4e-4 * (i % 3), -3e-4, 1e-3 * (i % 5 - 2), 2e-4, 0};
    p.strain(e), j2.strain(e);
    for (int c = 0; c < 6; ++c) EXPECT_NEAR(p[c], j2[c], 1e-11 * 400e6) << i;
  }
  EXPECT_NEAR(p.eqps(), j2.eqps(), 1e-12);
  EXPECT_NEAR(p.plastic_work, j2.plastic_work, 1e-11 * j2.plastic_work);
}

TEST(JohnsonCook, PlasticWorkIsOfSecondOrder) {
  const auto error = [](int steps) {
    JohnsonCookParameters flow = copper_flow;
    flow.C = 0;
    Point p{{copper, flow}};
    p.pull(0.05);
    const double start = p.eqps(), work = p.plastic_work;
    for (int i = 0; i < steps; ++i) p.pull(0.4 / steps);
    const auto integral = [&](double e) { return flow.A * e + flow.B * std::pow(e, flow.n + 1) / (flow.n + 1); };
    return std::abs(p.plastic_work - work - integral(p.eqps()) + integral(start)) / p.plastic_work;
  };
  EXPECT_LT(error(16), 3e-4);
  EXPECT_NEAR(std::log2(error(16) / error(32)), 2, 0.1);
}

TEST(JohnsonCook, HasNoStrengthAboveMelting) {
  Point p{{copper, copper_flow}};
  p.temperature = 1400;
  p.strain({1e-3, 2e-3, 3e-3, 1e-3, 0, 0}, 1e-6);
  const double pressure = copper.bulk_modulus() * 6e-3;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(p[c], pressure, 1e-12 * pressure);
  EXPECT_EQ(p[3], 0);
  EXPECT_EQ(p.plastic_work, 0);
  EXPECT_GT(p.eqps(), 0);
}

TEST(JohnsonCook, UnloadsElastically) {
  Point p{{copper, copper_flow}};
  p.pull(0.02, 1e-5);
  const double stress = p[0], eqps = p.eqps();
  p.pull(-1.5e-3, 1e-5);  // far enough to fall below the flow stress without rate hardening
  EXPECT_EQ(p.eqps(), eqps);
  EXPECT_EQ(p.state[1][0], 0);
  EXPECT_NEAR(p[0], stress - 124e9 * 1.5e-3, 1e-6 * stress);
}

TEST(JohnsonCook, HugeAndTinyIncrementsStayFinite) {
  for (const double size : {1e-300, 1e-30, 1e-3, 1.0, 1e6, 1e50})
    for (const double dt : {1e-100, 1e-8, 1e30})
      for (const double T : {0.0, 293.15, 1355.999999999, 1e6}) {
        Point p{{copper, copper_flow}};
        p.temperature = T;
        for (int i = 0; i < 3; ++i) p.strain({size, -2 * size, size, size, -size, 3 * size}, dt);
        for (int c = 0; c < 6; ++c) ASSERT_TRUE(std::isfinite(p[c])) << size << " " << dt << " " << T;
        ASSERT_TRUE(std::isfinite(p.eqps()) && p.eqps() >= 0 && p.plastic_work >= 0);
      }
}

}  // namespace
}  // namespace tenon::testing

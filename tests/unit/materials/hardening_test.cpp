// SPDX-License-Identifier: BSD-3-Clause
// Voce, tabulated and rate hardening against their closed forms at any step.
#include <gtest/gtest.h>

#include <cmath>

#include "components/materials/j2_hardening.hpp"
#include "material_point.hpp"

namespace tenon::testing {
namespace {

const VoceFlow voce{300e6, 150e6, 12, 80e6};
const PiecewiseLinear table({{0, 300e6}, {0.01, 380e6}, {0.05, 420e6}, {0.2, 400e6}, {0.4, 480e6}},
                            PiecewiseLinear::End::hold);

double flow_stress(const VoceFlow& f, double e) {
  return f.yield_stress + f.saturation * (1 - std::exp(-f.rate * e)) + f.hardening_modulus * e;
}
double flow_stress(const TableFlow& f, double e) {
  return f.table(e);
}
double flow_stress(const LinearFlow& f, double e) {
  return f.yield_stress + f.hardening_modulus * e;
}

const Tensor direction{1, -0.5, -0.5, 0.3, 0, -0.2};

/// After proportional straining in any number of steps, with or without rate: on the yield surface to round-off, and
/// the elastic and the plastic strain add up to the strain.
template <typename Curve>
void expect_consistent(const Curve& curve, const CowperSymonds& rate, double total, int steps, double dt) {
  MaterialPoint<J2Hardening<Curve>> p{{steel, curve, rate}};
  const double size = total / steps;
  Tensor e;
  double norm = 0;
  for (std::size_t c = 0; c < 6; ++c) {
    e[c] = size * direction[c];
    norm += (c < 3 ? 1 : 2) * direction[c] * direction[c];
  }
  const double equivalent = std::sqrt(2.0 / 3.0 * norm) * total, three_g = 3 * steel.shear_modulus();
  for (int i = 0; i < steps; ++i) {
    const double before = p.eqps();
    p.strain(e, dt);
    const double increment = p.eqps() - before;
    if (increment == 0) continue;
    const double flow = flow_stress(curve, p.eqps()) * (1 + std::pow(increment / dt / rate.D, 1 / rate.p));
    // The increment is a difference of sums: what it loses shows where the rate term is steep.
    const double lost = 1e-15 * p.eqps() / increment;
    ASSERT_NEAR(p.von_mises(), flow, (2e-12 + lost) * flow) << total << " in " << steps << ", step " << i;
  }
  EXPECT_NEAR(p.von_mises() / three_g + p.eqps(), equivalent, 1e-12 * equivalent);
}

TEST(Hardening, StressIsOnTheCurveAtAnyStep) {
  for (const double total : {2e-3, 0.03, 0.5, 30.0})
    for (const int steps : {1, 7, 200}) {
      expect_consistent(voce, {}, total, steps, 1e-6);
      expect_consistent(TableFlow{table}, {}, total, steps, 1e-6);
      expect_consistent(LinearFlow{300e6, 1e9}, {}, total, steps, 1e-6);
    }
}

TEST(Hardening, RateFactorIsThatOfTheClosedForm) {
  for (const CowperSymonds rate : {CowperSymonds{40.4, 5}, CowperSymonds{6500, 4}, CowperSymonds{100, 1}})
    for (const double total : {2e-3, 0.03, 0.5})
      for (const double dt : {1e-12, 1e-7, 1e-3, 1e6}) {
        expect_consistent(voce, rate, total, 20, dt);
        expect_consistent(TableFlow{table}, rate, total, 20, dt);
        expect_consistent(LinearFlow{300e6, 0}, rate, total, 20, dt);
      }
}

TEST(Hardening, TableOfTwoPointsIsLinearHardening) {
  const TableFlow straight{PiecewiseLinear({{0, 400e6}, {10, 400e6 + 10e9}}, PiecewiseLinear::End::hold)};
  MaterialPoint<J2Hardening<TableFlow>> p{{steel, straight, {}}};
  MaterialPoint<J2LinearHardening> j2{{steel, 400e6, 1e9}};
  for (int i = 0; i < 40; ++i) {
    const Tensor e{1e-3, -4e-4 * (i % 3), -3e-4, 1e-3 * (i % 5 - 2), 2e-4, 0};
    p.strain(e), j2.strain(e);
    for (int c = 0; c < 6; ++c) ASSERT_NEAR(p[c], j2[c], 1e-12 * 400e6) << i;
  }
  EXPECT_NEAR(p.eqps(), j2.eqps(), 1e-14);
  EXPECT_NEAR(p.plastic_work, j2.plastic_work, 1e-12 * j2.plastic_work);
}

TEST(Hardening, WorkIsElasticEnergyPlusPlasticWorkInTheSecondOrder) {
  const auto gap = [](int steps) {
    MaterialPoint<J2Hardening<VoceFlow>> p{{steel, voce, {}}};
    p.strain({1e-3, -5e-4, -5e-4, 0, 0, 0});  // to the elastic limit, which lies at 1.3e-3
    for (int i = 0; i < steps; ++i) {
      const double d = 0.4 / steps;
      p.strain({d, -d / 2, -d / 2, 0, 0, 0});
    }
    const double exact = voce.yield_stress * p.eqps() + 0.5 * voce.hardening_modulus * p.eqps() * p.eqps() +
                         voce.saturation * (p.eqps() - (1 - std::exp(-voce.rate * p.eqps())) / voce.rate);
    return std::abs(p.plastic_work - exact) / exact;
  };
  EXPECT_LT(gap(64), 1e-4);
  EXPECT_NEAR(std::log2(gap(64) / gap(128)), 2, 0.1);
}

TEST(Hardening, UnloadsElastically) {
  MaterialPoint<J2Hardening<VoceFlow>> p{{steel, voce, {40, 5}}};
  p.pull(0.02, 1e-4);
  const double eqps = p.eqps(), work = p.plastic_work, stress = p[0];
  p.pull(-3e-3, 1e-4);
  EXPECT_EQ(p.eqps(), eqps);
  EXPECT_EQ(p.plastic_work, work);
  EXPECT_NEAR(p[0], stress - 200e9 * 3e-3, 1e-9 * stress);
}

TEST(Hardening, HugeAndTinyIncrementsStayFinite) {
  for (const double size : {1e-300, 1e-30, 1e-3, 1.0, 1e6, 1e40})
    for (const double dt : {1e-100, 1e-8, 1e30}) {
      const Tensor e{size, -2 * size, size, size, -size, 3 * size};
      MaterialPoint<J2Hardening<VoceFlow>> a{{steel, voce, {40, 5}}};
      MaterialPoint<J2Hardening<TableFlow>> b{{steel, {table}, {}}};
      for (int i = 0; i < 3; ++i) a.strain(e, dt), b.strain(e, dt);
      for (int c = 0; c < 6; ++c) ASSERT_TRUE(std::isfinite(a[c]) && std::isfinite(b[c])) << size << " " << dt;
      ASSERT_TRUE(a.eqps() >= 0 && a.plastic_work >= 0 && b.eqps() >= 0 && b.plastic_work >= 0);
    }
}

}  // namespace
}  // namespace tenon::testing

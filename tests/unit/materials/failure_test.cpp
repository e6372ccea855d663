// SPDX-License-Identifier: BSD-3-Clause
// Failure: each limit alone, together, and the damage of Johnson and Cook in closed form.
#include <gtest/gtest.h>

#include <cmath>

#include "components/materials/failure.hpp"
#include "components/materials/material.hpp"
#include "components/materials/material_model.hpp"
#include "material_point.hpp"

namespace tenon::testing {
namespace {

/// Damage after a step from `before` to `after` plastic strain under a stress.
double damage(const FailureCriterion& criterion, const Tensor& stress, double before, double after, double T = 293.15,
              double dt = 1, double start = 0) {
  Batch<1> d = everywhere<1>({start});
  const Batch<6> s = everywhere<6>(stress), none = everywhere<6>({});
  criterion.accumulate({s, everywhere<1>({before}), everywhere<1>({after}), everywhere<1>({T}), none, dt}, d);
  return d[0][5];
}

TEST(Failure, PlasticStrainFailsAtItsLimit) {
  FailureCriterion c;
  c.plastic_strain = 0.2;
  EXPECT_NEAR(damage(c, {}, 0, 0.1), 0.5, 1e-15);
  EXPECT_LT(damage(c, {}, 0.1, 0.1999999), 1);
  EXPECT_GE(damage(c, {}, 0.1, 0.2), 1);
}

TEST(Failure, PrincipalStressIsFoundInAnyDirection) {
  FailureCriterion c;
  c.tensile_stress = 100;
  EXPECT_EQ(damage(c, {99, -500, 0, 0, 0, 0}, 0, 0), 0);
  EXPECT_EQ(damage(c, {0, 101, -500, 0, 0, 0}, 0, 0), 1);
  EXPECT_EQ(damage(c, {0, 0, 0, 0, 100.1, 0}, 0, 0), 1);  // pure shear: principal 100.1
  EXPECT_EQ(damage(c, {0, 0, 0, 0, 99.9, 0}, 0, 0), 0);
  EXPECT_EQ(damage(c, {100, 100, 100, 0, 0, 0}, 0, 0), 1);
}

TEST(Failure, SpallNeedsMeanTension) {
  FailureCriterion c;
  c.spall_pressure = 100;
  EXPECT_EQ(damage(c, {299, 0, 0, 500, 0, 0}, 0, 0), 0);
  EXPECT_EQ(damage(c, {301, 0, 0, 0, 0, 0}, 0, 0), 1);
  EXPECT_EQ(damage(c, {-301, 0, 0, 0, 0, 0}, 0, 0), 0);
}

TEST(Failure, DamageNeverFalls) {
  FailureCriterion c;
  c.plastic_strain = 1;
  EXPECT_EQ(damage(c, {}, 0, 0.1, 293.15, 1, 0.7), 0.7);
}

/// 4340 steel, [JC85].
const JohnsonCookDamage steel_4340{0.05, 3.44, -2.12, 0.002, 0.61, 1, 293.15, 1793};

double fracture_strain(double triaxiality, double rate, double T) {
  const double hot = std::clamp((T - 293.15) / (1793 - 293.15), 0.0, 1.0);
  return (0.05 + 3.44 * std::exp(-2.12 * triaxiality)) * (1 + 0.002 * std::log(std::max(rate, 1.0))) * (1 + 0.61 * hot);
}

TEST(Failure, JohnsonCookDamageIsThatOfTheClosedForm) {
  FailureCriterion c;
  c.johnson_cook = steel_4340;
  for (const double pressure : {-600.0, 0.0, 300.0, 2000.0})  // mean stress besides uniaxial tension of 300
    for (const double dt : {1e-9, 1e-3, 1.0})
      for (const double T : {200.0, 293.15, 900.0, 2000.0}) {
        const double d = 1e-3, triaxiality = (100 + pressure) / 300;
        const double got = damage(c, {300 + pressure, pressure, pressure, 0, 0, 0}, 0.3, 0.3 + d, T, dt, 0.25);
        EXPECT_NEAR(got, 0.25 + d / fracture_strain(triaxiality, d / dt, T), 1e-13)
            << pressure << " " << dt << " " << T;
      }
}

TEST(Failure, DamageGrowsLinearlyToFracture) {
  MaterialDescription m;
  m.elastic = steel;
  m.plasticity = LinearHardeningParameters{400e6, 0};
  m.failure.emplace();
  m.failure->johnson_cook = JohnsonCookDamage{0.05, 3.44, -2.12, 0, 0, 1, 293.15, 1793};
  const auto model = make_material_model(m);
  ASSERT_EQ(model->state_size(), 2);
  EXPECT_EQ(model->state_name(1), "damage");
  EXPECT_EQ(model->damage(), 1);
  Batch<1> state[2] = {}, work;
  Batch<6> stress{};
  const Batch<1> T = everywhere<1>({293.15}), none{};
  const double d = 1e-3;  // isochoric strain: no mean stress, fracture at D1 + D2
  int steps = 0;
  while (state[1][0][0] < 1 && steps < 10000) {
    const Batch<6> e = everywhere<6>({d, -d / 2, -d / 2, 0, 0, 0});
    model->update({e, T, none, 1e-6}, stress, state, work);
    EXPECT_NEAR(state[1][0][0], state[0][0][0] / 3.49, 1e-11);
    ++steps;
  }
  EXPECT_NEAR(state[0][0][0], 3.49, 1.1 * d);
}

TEST(Failure, SmallerLimitCountsAndPressureCanOnlyPostpone) {
  FailureCriterion c;
  c.johnson_cook = steel_4340, c.plastic_strain = 0.5;
  EXPECT_NEAR(damage(c, {}, 0.1, 0.2), 0.4, 1e-15);  // the total over the limit of 0.5
  EXPECT_NEAR(damage(c, {3000, 2900, 2900, 0, 0, 0}, 0, 0.01), 0.01 / 0.05, 1e-3);
  c.plastic_strain.reset();
  EXPECT_LT(damage(c, {-3000, -2900, -2900, 0, 0, 0}, 0, 0.01), 1e-6);
  EXPECT_EQ(damage(c, {3000, 3000, 3000, 0, 0, 0}, 0, 0), 0);  // no plastic strain, no damage
}

}  // namespace
}  // namespace tenon::testing

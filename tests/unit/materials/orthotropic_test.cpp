// SPDX-License-Identifier: BSD-3-Clause
// Orthotropic elasticity: tension along skew axes, turning axes, the isotropic bound, impossible constants.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "components/materials/orthotropic_elastic.hpp"
#include "deforming_point.hpp"

namespace tenon::testing {
namespace {

/// Spruce-like, with axes of the columns of R.
OrthotropicParameters wood(const Matrix& R) {
  OrthotropicParameters p{11e9, 0.9e9, 0.5e9, 0.4, 0.45, 0.02, 0.7e9, 0.04e9, 0.65e9};
  for (std::size_t i = 0; i < 3; ++i) p.axis_1[i] = R[i][0], p.axis_2[i] = R[i][1];
  return p;
}
/// Small strain of a unit tension along axis `a`, in the axes of the material.
Matrix tension_strain(const OrthotropicParameters& p, std::size_t a) {
  const double strains[3][3] = {{1 / p.E1, -p.nu12 / p.E1, -p.nu31 / p.E3},
                                {-p.nu12 / p.E1, 1 / p.E2, -p.nu23 / p.E2},
                                {-p.nu31 / p.E3, -p.nu23 / p.E2, 1 / p.E3}};
  return stretch(strains[a][0], strains[a][1], strains[a][2]);
}
Tensor components(const Matrix& m) {
  return {m[0][0], m[1][1], m[2][2], m[0][1], m[1][2], m[2][0]};
}
MaterialPoint<OrthotropicElastic> point(const OrthotropicParameters& p, double expansion = 0) {
  MaterialPoint<OrthotropicElastic> q{OrthotropicElastic(p, expansion)};
  for (int i = 0; i < 6; ++i)
    for (int l = 0; l < lanes; ++l) q.state[i][l] = q.material.initial_state(i);
  return q;
}

TEST(OrthotropicElastic, TensionAlongEachSkewAxisIsUniaxial) {
  const Matrix R = turn(0.9);
  const OrthotropicParameters p = wood(R);
  for (std::size_t a = 0; a < 3; ++a) {
    auto q = point(p);
    q.strain(components(combine(1e6, R * tension_strain(p, a) * transposed(R), 0, identity())));
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = i; j < 3; ++j) {
        const int c = i == j ? static_cast<int>(i) : i + j == 1 ? 3 : i + j == 3 ? 4 : 5;
        EXPECT_NEAR(q[c], 1e6 * R[i][a] * R[j][a], 1e-9 * 1e6) << a << i << j;
      }
  }
}

TEST(OrthotropicElastic, ShearsHaveTheirOwnModuli) {
  auto q = point(wood(identity()));
  q.strain({0, 0, 0, 1e-3, 2e-3, 3e-3});
  EXPECT_NEAR(q[3], 2 * 0.7e9 * 1e-3, 1e-6);
  EXPECT_NEAR(q[4], 2 * 0.04e9 * 2e-3, 1e-6);
  EXPECT_NEAR(q[5], 2 * 0.65e9 * 3e-3, 1e-6);
}

TEST(OrthotropicElastic, FreeHeatingLeavesNoStress) {
  auto q = point(wood(turn(0.4)), 1e-5);
  q.strain({1e-3, 1e-3, 1e-3, 0, 0, 0}, 1, 100);
  for (int c = 0; c < 6; ++c) EXPECT_NEAR(q[c], 0, 1e-6);
}

TEST(OrthotropicElastic, AxesTurnWithTheBody) {
  const OrthotropicParameters p = wood(turn(0.3));
  DeformingPoint<OrthotropicElastic> q{OrthotropicElastic(p, 0)}, still{OrthotropicElastic(p, 0)};
  const Matrix R = turn(5 * std::numbers::pi / 18);  // by which it has turned in the end
  for (int i = 1; i <= 5; ++i) q.deform(turn(i * std::numbers::pi / 18));
  for (int c = 0; c < 6; ++c) EXPECT_NEAR(q[c], 0, 1e-5);
  const Matrix F{{{1.001, 2e-4, 0}, {-1e-4, 1, 5e-4}, {0, 0, 0.999}}};
  still.deform(F), q.deform(R * F);
  const Matrix expected = R * still.tensor() * transposed(R);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(q.tensor()[i][j], expected[i][j], 1e-3 * 1e6);
}

TEST(OrthotropicElastic, IsotropicConstantsGiveIsotropicElasticity) {
  const Elasticity e{200e9, 0.3, 0};
  const double G = e.shear_modulus();
  const OrthotropicElastic m({200e9, 200e9, 200e9, 0.3, 0.3, 0.3, G, G, G}, 0);
  EXPECT_NEAR(m.elasticity.p_wave_modulus(), e.p_wave_modulus(), 1e-3 * e.p_wave_modulus());
  MaterialPoint<LinearElastic> isotropic{{e}};
  auto q = point({200e9, 200e9, 200e9, 0.3, 0.3, 0.3, G, G, G});
  const Tensor strain{1e-3, -2e-4, 3e-4, 5e-4, -1e-4, 2e-4};
  q.strain(strain), isotropic.strain(strain);
  for (int c = 0; c < 6; ++c) EXPECT_NEAR(q[c], isotropic[c], 1e-3);
}

/// Of any strain the isotropic bound stores no less energy; and the bound is not idle.
TEST(OrthotropicElastic, BoundIsNowhereSofter) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int tried = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const auto random = [&] { return 1e9 * std::pow(10, uniform(generator)); };
    OrthotropicParameters p{
        random(), random(), random(), 0.3 * uniform(generator), 0.3 * uniform(generator), 0.3 * uniform(generator),
        random(), random(), random()};
    if (OrthotropicElastic::objection(p)) continue;
    ++tried;
    const OrthotropicElastic m(p, 0);
    const double lambda = m.elasticity.lame_lambda(), two_mu = 2 * m.elasticity.shear_modulus();
    EXPECT_LT(m.elasticity.p_wave_modulus(),
              m.normal[0][0] + m.normal[1][1] + m.normal[2][2] + m.shear[0] + m.shear[1] + m.shear[2]);
    for (int k = 0; k < 3; ++k) EXPECT_GE(two_mu, m.shear[k] * (1 - 1e-9));
    for (int k = 0; k < 300; ++k) {
      double e[3], own = 0, sum = 0, square = 0;
      for (double& x : e) x = uniform(generator), sum += x, square += x * x;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) own += e[i] * m.normal[i][j] * e[j];
      ASSERT_LE(own, (lambda * sum * sum + two_mu * square) * (1 + 1e-6)) << trial;
    }
  }
  EXPECT_GT(tried, 50);
}

TEST(OrthotropicElastic, RefusesConstantsOfNegativeEnergy) {
  OrthotropicParameters p = wood(identity());
  EXPECT_FALSE(OrthotropicElastic::objection(p));
  p.nu12 = 4;  // > sqrt(11/0.9)
  EXPECT_TRUE(OrthotropicElastic::objection(p));
  p = wood(identity()), p.nu31 = 0.3;  // > sqrt(0.5/11)
  EXPECT_NE(OrthotropicElastic::objection(p)->find("nu31"), std::string::npos);
}

}  // namespace
}  // namespace tenon::testing

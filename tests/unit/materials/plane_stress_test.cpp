// SPDX-License-Identifier: BSD-3-Clause
// Plane stress: closed forms, the projected return against the iteration on the thickness, lanes alone and together.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "components/materials/j2_hardening.hpp"
#include "components/materials/plane_stress.hpp"
#include "material_point.hpp"

namespace tenon::testing {
namespace {

constexpr double E = 200e9, nu = 0.3, sigma_y = 400e6;
const Elasticity hot_steel{E, nu, 12e-6};

/// Eight points under plane stress, by a law's own update or by the iteration that serves any law.
template <Material M>
struct Sheet {
  M material;
  bool iterate = false;
  Batch<6> stress{};
  StateBatch<M> state{};
  Batch<1> work{}, thickness{};
  double plastic_work = 0;

  void strain(const Batch<6>& e, const Batch<1>& dT = Batch<1>{}) {
    const Batch<1> t = everywhere<1>({300});
    const UpdateInput input{e, t, dT, 1e-6};
    bool own = false;
    if constexpr (requires { material.update_plane_stress(input, stress, state, work, thickness); }) {
      own = !iterate;
      if (own) material.update_plane_stress(input, stress, state, work, thickness);
    }
    if (!own) iterate_plane_stress(material, input, stress, state, work, thickness);
    plastic_work += work[0][0];
  }
  double q(int l) const {
    const auto& s = stress.v;
    return std::sqrt(s[0][l] * s[0][l] + s[1][l] * s[1][l] - s[0][l] * s[1][l] +
                     3 * (s[3][l] * s[3][l] + s[4][l] * s[4][l] + s[5][l] * s[5][l]));
  }
};

Batch<6> random_strain(std::mt19937& generator, double size) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Batch<6> e;
  for (int c = 0; c < 6; ++c)
    for (int l = 0; l < lanes; ++l) e[c][l] = (c == 2 ? 1e300 : size) * uniform(generator);  // zz must not be read
  return e;
}

TEST(PlaneStress, ElasticSheetFollowsHooke) {
  Sheet<LinearElastic> sheet{{hot_steel}};
  sheet.strain(everywhere<6>({1e-3, -2e-4, 77, 3e-4, 1e-4, -2e-4}), everywhere<1>({50}));
  const double thermal = 12e-6 * 50, x = 1e-3 - thermal, y = -2e-4 - thermal, plate = E / (1 - nu * nu);
  EXPECT_NEAR(sheet.stress[0][3], plate * (x + nu * y), 1e-3);
  EXPECT_NEAR(sheet.stress[1][3], plate * (y + nu * x), 1e-3);
  EXPECT_EQ(sheet.stress[2][3], 0);
  EXPECT_NEAR(sheet.stress[3][3], E / (1 + nu) * 3e-4, 1e-4);
  EXPECT_NEAR(sheet.thickness[0][3], thermal - nu / (1 - nu) * (x + y), 1e-17);
}

/// What stress there was through the thickness is let go.
TEST(PlaneStress, NormalStressOfTheStartIsReleased) {
  for (const bool iterate : {false, true}) {
    Sheet<LinearElastic> sheet{{hot_steel}, iterate};
    sheet.stress = everywhere<6>({0, 0, 100e6, 0, 0, 0});
    sheet.strain(everywhere<6>({}));
    EXPECT_NEAR(sheet.stress[0][0], -100e6 * nu / (1 - nu), 1e-2);
    EXPECT_NEAR(sheet.stress[2][0], 0, 1e-2);
  }
}

TEST(PlaneStress, J2EquiBiaxialIsExactAtAnyStep) {
  const double H = 1e9, strain = 0.1;
  // Biaxial: q = sigma, plastic strain zz = -eqps, eqps/2 in the plane.
  const double eqps = (2 * E / (2 * (1 - nu)) * strain - sigma_y) / (H + E / (2 * (1 - nu)));
  for (const int steps : {1, 9}) {
    Sheet<J2LinearHardening> sheet{{Elasticity{E, nu, 0}, sigma_y, H}};
    double thickness = 0;
    for (int i = 0; i < steps; ++i) {
      sheet.strain(everywhere<6>({strain / steps, strain / steps, 0, 0, 0, 0}));
      thickness += sheet.thickness[0][0];
    }
    EXPECT_NEAR(sheet.state[0][0], eqps, 1e-12) << steps;
    EXPECT_NEAR(sheet.stress[0][0], sigma_y + H * eqps, 1e-12 * sigma_y);
    EXPECT_NEAR(thickness, -eqps - 2 * nu / E * sheet.stress[0][0], 1e-12);
    EXPECT_NEAR(sheet.plastic_work, sigma_y * eqps + 0.5 * H * eqps * eqps, 1e-11 * sheet.plastic_work);
  }
}

TEST(PlaneStress, J2StaysOnTheYieldSurface) {
  std::mt19937 generator(5);
  for (const double poisson : {-0.9, 0.0, 0.3, 0.4999})
    for (const double H : {0.0, 1e9, 300e9})
      for (const double size : {1e-5, 1e-3, 1e-1, 1e6}) {
        const double tolerance = size < 1 ? 1e-11 : 1e-6;
        Sheet<J2LinearHardening> sheet{{Elasticity{E, poisson, 0}, sigma_y, H}};
        for (int i = 0; i < 30; ++i) {
          const Batch<1> before = sheet.state;
          sheet.strain(random_strain(generator, size));
          for (int l = 0; l < lanes; ++l) {
            const double flow = sigma_y + H * sheet.state[0][l];
            const bool flows = sheet.state[0][l] > before[0][l];
            ASSERT_GE(sheet.q(l), flows ? flow * (1 - tolerance) : 0) << poisson << " " << size;
            ASSERT_LE(sheet.q(l), flow * (1 + tolerance)) << poisson << " " << H << " " << size;
            ASSERT_GE(sheet.work[0][l], 0);
          }
        }
      }
}

TEST(PlaneStress, ProjectedReturnIsTheOneOfTheIteration) {
  std::mt19937 generator(6);
  for (const double H : {0.0, 2e9})
    for (const double size : {1e-4, 1e-3, 1e-2}) {
      Sheet<J2LinearHardening> own{{hot_steel, sigma_y, H}}, iterated{{hot_steel, sigma_y, H}, true};
      for (int i = 0; i < 40; ++i) {
        const Batch<6> e = random_strain(generator, size);
        const Batch<1> dT = everywhere<1>({i % 2 ? 3.0 : -2.0});
        own.strain(e, dT), iterated.strain(e, dT);
        for (int l = 0; l < lanes; ++l) {
          for (int c = 0; c < 6; ++c) ASSERT_NEAR(own.stress[c][l], iterated.stress[c][l], 1e-7 * sigma_y) << c << i;
          ASSERT_NEAR(own.thickness[0][l], iterated.thickness[0][l], 1e-8 * size + 1e-12);
          ASSERT_NEAR(own.state[0][l], iterated.state[0][l], 1e-8 * (1 + own.state[0][l]));
        }
      }
    }
}

template <Material M>
void expect_convergence(const M& material, double size) {
  std::mt19937 generator(7);
  Sheet<M> sheet{material, true};
  for (int i = 0; i < 40; ++i) {
    const Batch<6> before = sheet.stress, e = random_strain(generator, size);
    const StateBatch<M> history = sheet.state;
    sheet.strain(e);
    Batch<6> full = e, stress = before;
    StateBatch<M> state = history;
    Batch<1> work;
    for (int l = 0; l < lanes; ++l) full[2][l] = sheet.thickness[0][l];
    const Batch<1> t = everywhere<1>({300}), none{};
    material.update({full, t, none, 1e-6}, stress, state, work);
    // The state is that of the strain that is handed back, and the normal stress is gone.
    EXPECT_EQ(std::memcmp(&stress, &sheet.stress, sizeof stress), 0);
    EXPECT_EQ(std::memcmp(&state, &sheet.state, sizeof state), 0);
    for (int l = 0; l < lanes; ++l) ASSERT_LE(std::abs(sheet.stress[2][l]), 1e-9 * (sheet.q(l) + 1e-3 * sigma_y)) << i;
  }
}

TEST(PlaneStress, IterationConvergesForPlasticLaws) {
  const JohnsonCook cook{hot_steel, {806e6, 614e6, 0.168, 0.0089, 1.1, 1, 293.15, 1813}};
  const J2Hardening<VoceFlow> voce{hot_steel, {sigma_y, 200e6, 20, 0}, {}};
  const J2Hardening<TableFlow> perfect{hot_steel, {PiecewiseLinear({{0, sigma_y}}, PiecewiseLinear::End::hold)}, {}};
  const J2Hardening<LinearFlow> rate{hot_steel, {sigma_y, 1e9}, {40, 5}};
  for (const double size : {1e-5, 1e-4, 1e-2, 1.0}) {
    expect_convergence(cook, size);
    expect_convergence(voce, size);
    expect_convergence(perfect, size);
    expect_convergence(rate, size);
  }
}

template <Material M>
void expect_lanes_alone(const M& material, bool iterate) {
  std::mt19937 generator(8);
  Sheet<M> together{material, iterate};
  std::array<Sheet<M>, lanes> alone;
  alone.fill(Sheet<M>{material, iterate});
  for (int i = 0; i < 20; ++i) {
    const Batch<6> e = random_strain(generator, 1e-3);
    together.strain(e);
    for (int l = 0; l < lanes; ++l) {
      Batch<6> one{};
      const int at = (3 * l + 1) % lanes;
      for (int c = 0; c < 6; ++c) one[c][at] = e[c][l];
      Sheet<M>& sheet = alone[static_cast<std::size_t>(l)];
      sheet.strain(one);
      for (int c = 0; c < 6; ++c) ASSERT_EQ(sheet.stress[c][at], together.stress[c][l]);
      ASSERT_EQ(sheet.thickness[0][at], together.thickness[0][l]);
      ASSERT_EQ(sheet.state[0][at], together.state[0][l]);
    }
  }
}

TEST(PlaneStress, LanesAreIndependent) {
  for (const bool iterate : {false, true}) expect_lanes_alone(J2LinearHardening{hot_steel, sigma_y, 1e9}, iterate);
  expect_lanes_alone(JohnsonCook{hot_steel, {806e6, 614e6, 0.168, 0.0089, 1.1, 1, 293.15, 1813}}, true);
}

}  // namespace
}  // namespace tenon::testing

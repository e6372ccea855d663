// SPDX-License-Identifier: BSD-3-Clause
// A point gives the same bits in any lane and in any company.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "components/materials/crushable_foam.hpp"
#include "components/materials/hyperelastic.hpp"
#include "components/materials/j2_hardening.hpp"
#include "components/materials/j2_kinematic.hpp"
#include "components/materials/orthotropic_elastic.hpp"
#include "components/materials/soil.hpp"
#include "components/materials/with_equation_of_state.hpp"
#include "material_point.hpp"

namespace tenon::testing {
namespace {

constexpr int steps = 12;

/// A random path of eight points; lane l of the result depends only on the path of its point.
struct Path {
  std::array<Batch<6>, steps> strain;
  std::array<Batch<1>, steps> temperature, rise, volume, heat;
  std::array<Batch<9>, steps> gradient;

  explicit Path(unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int i = 0; i < steps; ++i)
      for (int l = 0; l < lanes; ++l) {
        const double size = std::pow(10, 2 * uniform(generator) - 3.5);  // from elastic to very plastic
        for (int c = 0; c < 6; ++c) strain[static_cast<std::size_t>(i)][c][l] = size * uniform(generator);
        temperature[static_cast<std::size_t>(i)][0][l] = 800 + 700 * uniform(generator);
        rise[static_cast<std::size_t>(i)][0][l] = 10 * uniform(generator);
        volume[static_cast<std::size_t>(i)][0][l] = 0.9 + 0.2 * uniform(generator);
        heat[static_cast<std::size_t>(i)][0][l] = 1e6 * (1 + uniform(generator));
        for (int c = 0; c < 9; ++c)
          gradient[static_cast<std::size_t>(i)][c][l] = (c % 4 == 0 ? 1 : 0) + 0.2 * uniform(generator);
      }
  }
};

template <int N>
void place(const Batch<N>& from, int lane, Batch<N>& to, int at, bool alone) {
  for (int c = 0; c < N; ++c)
    for (int l = 0; l < lanes; ++l) to[c][l] = l == at ? from[c][lane] : alone ? 0.0 : to[c][l];
}

template <Material M>
void expect_lanes_are_independent(const M& material, bool flows = M::state_size > 0) {
  const Path path(7);
  Batch<6> together = everywhere<6>({});
  StateBatch<M> state{};
  if constexpr (requires { material.initial_state(0); })
    for (int c = 0; c < M::state_size; ++c)
      for (int l = 0; l < lanes; ++l) state[c][l] = material.initial_state(c);
  Batch<1> work{};
  std::array<Batch<6>, lanes> stress{};
  std::array<StateBatch<M>, lanes> history;
  history.fill(state);
  int plastic = 0;
  for (std::size_t i = 0; i < steps; ++i) {
    material.update(
        {path.strain[i], path.temperature[i], path.rise[i], 1e-6, &path.gradient[i], &path.volume[i], &path.heat[i]},
        together, state, work);
    for (int l = 0; l < lanes; ++l) {
      const int at = (3 * l + 1) % lanes;  // another lane, all others at rest
      Batch<6> e;
      Batch<1> t, d, w{};
      place(path.strain[i], l, e, at, true);
      place(path.temperature[i], l, t, at, true);
      place(path.rise[i], l, d, at, true);
      auto& s = stress[static_cast<std::size_t>(l)];
      auto& h = history[static_cast<std::size_t>(l)];
      Batch<9> F = everywhere<9>({1, 0, 0, 0, 1, 0, 0, 0, 1});
      Batch<1> V = everywhere<1>({1}), q = everywhere<1>({0});
      place(path.gradient[i], l, F, at, false);
      place(path.volume[i], l, V, at, false);
      place(path.heat[i], l, q, at, false);
      material.update({e, t, d, 1e-6, &F, &V, &q}, s, h, w);
      for (int c = 0; c < 6; ++c) ASSERT_EQ(std::memcmp(&s[c][at], &together[c][l], 8), 0) << c << " " << l << " " << i;
      for (int c = 0; c < M::state_size; ++c) {
        ASSERT_EQ(std::memcmp(&h[c][at], &state[c][l], 8), 0);
      }
      ASSERT_EQ(std::memcmp(&w[0][at], &work[0][l], 8), 0);
      plastic += work[0][l] > 0;
    }
  }
  if (flows) {  // the path must try both branches
    EXPECT_GT(plastic, 10);
    EXPECT_LT(plastic, lanes * steps - 3);
  }
}

const Elasticity hot_steel{200e9, 0.3, 12e-6};

TEST(Lanes, LinearElastic) {
  expect_lanes_are_independent(LinearElastic{hot_steel});
}
TEST(Lanes, J2LinearHardening) {
  expect_lanes_are_independent(J2LinearHardening{hot_steel, 400e6, 1e9});
}
TEST(Lanes, J2Hardening) {
  expect_lanes_are_independent(J2Hardening<VoceFlow>{hot_steel, {400e6, 200e6, 10, 0}, {}});
  expect_lanes_are_independent(J2Hardening<VoceFlow>{hot_steel, {400e6, 200e6, 10, 0}, {40, 5}});
  const PiecewiseLinear table({{0, 400e6}, {0.001, 500e6}, {0.02, 450e6}}, PiecewiseLinear::End::hold);
  expect_lanes_are_independent(J2Hardening<TableFlow>{hot_steel, {table}, {}});
  expect_lanes_are_independent(J2Hardening<TableFlow>{hot_steel, {table}, {40, 5}});
}
TEST(Lanes, JohnsonCook) {
  expect_lanes_are_independent(JohnsonCook{hot_steel, {806e6, 614e6, 0.168, 0.0089, 1.1, 1, 293.15, 1813}});
}
TEST(Lanes, J2Kinematic) {
  expect_lanes_are_independent(J2Kinematic{hot_steel, {400e6, 1e9, 5e9, 0}});
  expect_lanes_are_independent(J2Kinematic{hot_steel, {400e6, 1e9, 40e9, 200}});
}
TEST(Lanes, MooneyRivlin) {
  const MooneyRivlinParameters p{0.4e6, 0.1e6, 50e6};
  expect_lanes_are_independent(MooneyRivlin{MooneyRivlin::small_strain(p, 1e-4), p}, false);
}
TEST(Lanes, OrthotropicElastic) {
  expect_lanes_are_independent(OrthotropicElastic({11e9, 0.9e9, 0.5e9, 0.4, 0.45, 0.02, 0.7e9, 0.04e9, 0.65e9}, 1e-5),
                               false);
}
TEST(Lanes, CrushableFoam) {
  const PiecewiseLinear strength({{0, 2e6}, {0.1, 3e6}, {0.2, 60e6}}, PiecewiseLinear::End::continue_slope);
  expect_lanes_are_independent(CrushableFoam{{100e6, 0.1, 1e-5}, strength, 1e6}, false);
}
TEST(Lanes, Soil) {
  const PiecewiseLinear pressure({{0, 0}, {0.1, 1e6}, {0.2, 5e6}}, PiecewiseLinear::End::continue_slope);
  expect_lanes_are_independent(Soil{{100e6, 0.2, 0}, pressure, 1e8, 1e4, 0.3, 1e4}, false);
}
TEST(Lanes, WithEquationOfState) {
  const Gruneisen g{7850, 4600, 1.3, 0, 0, 1.7, 0.4, 0};
  expect_lanes_are_independent(WithEquationOfState<J2Kinematic>({hot_steel, {400e6, 1e9, 5e9, 0}}, {g, -1e9}));
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// A point gives the same bits in any lane and in any company.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "components/materials/j2_hardening.hpp"
#include "material_point.hpp"

namespace tenon::testing {
namespace {

constexpr int steps = 12;

/// A random path of eight points; lane l of the result depends only on the path of its point.
struct Path {
  std::array<Batch<6>, steps> strain;
  std::array<Batch<1>, steps> temperature, rise;

  explicit Path(unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int i = 0; i < steps; ++i)
      for (int l = 0; l < lanes; ++l) {
        const double size = std::pow(10, 2 * uniform(generator) - 3.5);  // from elastic to very plastic
        for (int c = 0; c < 6; ++c) strain[static_cast<std::size_t>(i)][c][l] = size * uniform(generator);
        temperature[static_cast<std::size_t>(i)][0][l] = 800 + 700 * uniform(generator);
        rise[static_cast<std::size_t>(i)][0][l] = 10 * uniform(generator);
      }
  }
};

template <int N>
void place(const Batch<N>& from, int lane, Batch<N>& to, int at, bool alone) {
  for (int c = 0; c < N; ++c)
    for (int l = 0; l < lanes; ++l) to[c][l] = l == at ? from[c][lane] : alone ? 0.0 : to[c][l];
}

template <Material M>
void expect_lanes_are_independent(const M& material) {
  const Path path(7);
  Batch<6> together = everywhere<6>({});
  StateBatch<M> state{};
  Batch<1> work{};
  std::array<Batch<6>, lanes> stress{};
  std::array<StateBatch<M>, lanes> history{};
  int plastic = 0;
  for (std::size_t i = 0; i < steps; ++i) {
    material.update({path.strain[i], path.temperature[i], path.rise[i], 1e-6}, together, state, work);
    for (int l = 0; l < lanes; ++l) {
      const int at = (3 * l + 1) % lanes;  // another lane, all others at rest
      Batch<6> e;
      Batch<1> t, d, w{};
      place(path.strain[i], l, e, at, true);
      place(path.temperature[i], l, t, at, true);
      place(path.rise[i], l, d, at, true);
      auto& s = stress[static_cast<std::size_t>(l)];
      auto& h = history[static_cast<std::size_t>(l)];
      material.update({e, t, d, 1e-6}, s, h, w);
      for (int c = 0; c < 6; ++c) ASSERT_EQ(std::memcmp(&s[c][at], &together[c][l], 8), 0) << c << " " << l << " " << i;
      for (int c = 0; c < M::state_size; ++c) {
        ASSERT_EQ(std::memcmp(&h[c][at], &state[c][l], 8), 0);
      }
      ASSERT_EQ(std::memcmp(&w[0][at], &work[0][l], 8), 0);
      plastic += work[0][l] > 0;
    }
  }
  if (M::state_size > 0) {  // the path must try both branches
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

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// VERIFICATION E02 and E03 for L2 projections: exact linear fields, second order with the reference errors, integrals
// kept to round-off, values within bounds.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "projection_testing.hpp"

namespace tenon::transfer {
namespace {

using std::numbers::pi;
using testing::box;
using testing::distributed;
using testing::Pair;
using testing::ProjectionPair;

constexpr std::array<Location, 2> both{Location::node, Location::element};

double linear(const Vec3& x) {
  return 1 + 2 * x[0] - 3 * x[1] + 0.5 * x[2];
}

/// E02: f = product of sin(pi x) exp(x/2).
double e02(const Vec3& x) {
  double f = 1;
  for (const double c : x) f *= std::sin(pi * c) * std::exp(c / 2);
  return f;
}

Pair e02_pair(int n, bool source_tets = false, bool target_tets = false) {
  const int m = static_cast<int>(1.37 * n + 0.5);
  return {distributed(box(n, {.tetrahedra = source_tets})),
          distributed(box(m, {.tetrahedra = target_tets, .distortion = 0.15, .seed = 3}))};
}

TEST(Projection, IsSecondOrderWithTheReferenceErrors) {
  // Reference: E02_oneway_order.csv (other random shifts of the target nodes).
  const std::array<double, 2> reference{0.039955472, 0.010125959};
  std::array<double, 2> error{};
  for (std::size_t k = 0; k < 2; ++k) {
    const Pair pair = e02_pair(8 << k);
    const ProjectionPair project(pair);
    const auto values = testing::sampled(*pair.source, Location::node, e02);
    const auto result = project(values);
    error[k] = testing::relative_l2_error(*pair.target, Location::node, result, e02);
    EXPECT_NEAR(error[k] / reference[k], 1.0, 0.1) << "n = " << (8 << k);
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2.0, 0.15);
}

TEST(Projection, LinearFieldsAreExact) {
  for (const bool tets : {false, true})
    for (const Location to : both) {
      Pair pair = e02_pair(5, tets, !tets);
      pair.to = to;
      const auto values = testing::sampled(*pair.source, Location::node, linear);
      const auto result = ProjectionPair(pair)(values);
      // The centres of these hexahedra are not their centres of mass; those of tetrahedra are.
      if (to == Location::node || !tets) {
        EXPECT_LT(testing::greatest_error(*pair.target, to, result, linear), 1e-12);
      }
    }
}

TEST(Projection, KeepsTheIntegral) {
  for (const bool tets : {false, true})
    for (const Location from : both)
      for (const Location to : both) {
        Pair pair = e02_pair(6, tets, !tets);
        pair.from = from, pair.to = to;
        std::vector<double> values(testing::places(*pair.source, from).size());
        const Items items = items_of(*pair.source, from);
        for (std::size_t i = 0; i < values.size(); ++i)
          values[i] = testing::random_number(7, static_cast<std::uint64_t>(items.ids[i])) - 0.5;
        const ProjectionPair project(pair);
        const auto result = project(values);
        const double scale = testing::integral_of_magnitude(*pair.source, from, values);
        EXPECT_LT(std::abs(testing::integral(*pair.target, to, result) - testing::integral(*pair.source, from, values)),
                  1e-13 * scale);
      }
}

}  // namespace
}  // namespace tenon::transfer

// SPDX-License-Identifier: BSD-3-Clause
// VERIFICATION E04: a thousand projections to and fro.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "projection_testing.hpp"

namespace tenon::transfer {
namespace {

using std::numbers::pi;
using testing::distributed;
using testing::ProjectionPair;

/// A row of n hexahedra along x: fields of x alone behave as in one dimension.
testing::MeshPointer row(int n) {
  BoxShape shape;
  shape.elements = {n, 1, 1};
  shape.high = {1, 0.1, 0.1};
  return distributed(generate(shape));
}

/// Greatest change of each component over its greatest value, after 1, 10, 100 and 1000 round trips.
struct Loss {
  std::array<std::array<double, 4>, 3> change{};
  std::array<double, 3> drift{};  ///< of the integral, in the end
};

Loss ping_pong(int n, int m, const ProjectionOptions& options) {
  const testing::MeshPointer here = row(n), there = row(m);
  const ProjectionPair forth({here, there}, options), back({there, here}, options);
  const std::array<testing::Function, 3> functions{[](const Vec3& x) { return std::sin(pi * x[0]); },
                                                   [](const Vec3& x) { return std::cos(4 * pi * x[0]); },
                                                   [](const Vec3& x) { return 1 + x[0]; }};
  const auto start = testing::sampled(*here, Location::node, std::span<const testing::Function>(functions));
  auto values = start;
  Loss loss;
  std::size_t stage = 0;
  int next = 1;
  for (int trip = 1; trip <= 1000; ++trip) {
    values = back(forth(values, 3), 3);
    if (trip != next) continue;
    for (std::size_t i = 0; i < values.size(); ++i)
      loss.change[i % 3][stage] = std::max(loss.change[i % 3][stage], std::abs(values[i] - start[i]));
    ++stage, next *= 10;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    here->comm.max(std::span<double>(loss.change[c]));
    const int component = static_cast<int>(c);
    loss.drift[c] = testing::integral(*here, Location::node, values, 3, component) -
                    testing::integral(*here, Location::node, start, 3, component);
  }
  return loss;
}

/// Reference: E04_pingpong_1d.csv, exact projections to and fro.
constexpr std::array<double, 4> sine_16{0.00065929057, 0.004614109, 0.0090585557, 0.020219718};
constexpr std::array<double, 4> sine_32{0.00014757637, 0.0010252164, 0.0023687751, 0.0073195918};
constexpr std::array<double, 3> wave_16{0.0093739004, 0.069825974, 0.16220742};

void expect_nothing_lost(const Loss& loss) {
  const double volume = 0.01;
  for (const double drift : loss.drift) EXPECT_LT(std::abs(drift), 2e-13 * volume);
  EXPECT_LT(loss.change[2][3], 1e-11) << "a linear field";
}

TEST(ProjectionPingPong, WithEnoughPointsLosesNoMoreThanExactProjections) {
  const Loss loss = ping_pong(16, 23, {.points_per_edge = 4});
  for (std::size_t k = 0; k < 4; ++k) EXPECT_LT(loss.change[0][k], 1.05 * sine_16[k]);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_LT(loss.change[1][k], 1.05 * wave_16[k]);
  EXPECT_LT(loss.change[1][2], 2 * wave_16[2]);
  expect_nothing_lost(loss);
}

TEST(ProjectionPingPong, WithTheUsualPointsLosesAFewTimesAsMuch) {
  // Interpolation loses 0.67, 3.8, 27 and 96 % (16 -> 23 -> 16), 0.17, 1.1, 9.0 and 58 % (32 -> 45 -> 32).
  const Loss coarse = ping_pong(16, 23, {}), fine = ping_pong(32, 45, {});
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT(coarse.change[0][k], 4 * sine_16[k]);
    EXPECT_LT(fine.change[0][k], 3 * sine_32[k]);
  }
  expect_nothing_lost(coarse);
  expect_nothing_lost(fine);
}

TEST(ProjectionPingPong, NestedMeshesReturnEverything) {
  const Loss loss = ping_pong(16, 32, {});
  for (std::size_t c = 0; c < 3; ++c) EXPECT_LT(loss.change[c][3], 1e-11);
  expect_nothing_lost(loss);
}

TEST(ProjectionPingPong, NothingGrowsOnPerturbedMeshes) {
  // Quadrature that took squares too high would let some mode grow without bound.
  const testing::MeshPointer here = distributed(testing::box(5, {.distortion = 0.2})),
                             there = distributed(testing::box(6, {.distortion = 0.2, .seed = 2}));
  const ProjectionPair forth({here, there}), back({there, here});
  auto values = testing::sampled(*here, Location::node, [](const Vec3&) { return 0.0; });
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = testing::random_number(5, static_cast<std::uint64_t>(here->node_ids[i])) - 0.5;
  double greatest = 0;
  for (int trip = 1; trip <= 300; ++trip) values = back(forth(values));
  for (const double v : values) greatest = std::max(greatest, std::abs(v));
  EXPECT_LT(here->comm.max(greatest), 0.6);
}

}  // namespace
}  // namespace tenon::transfer

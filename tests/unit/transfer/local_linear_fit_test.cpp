// SPDX-License-Identifier: BSD-3-Clause
// The weights of one fit: exact for linear fields where points determine them, tame where they do not.
#include "transfer/local_linear_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "transfer_testing.hpp"

namespace tenon::transfer {
namespace {

using testing::random_number;

constexpr double ulp = 0x1p-52;

Vec3 random_point(std::uint64_t seed, std::uint64_t i) {
  return {2 * random_number(seed, 3 * i) - 1, 2 * random_number(seed, 3 * i + 1) - 1,
          2 * random_number(seed, 3 * i + 2) - 1};
}

std::vector<Vec3> random_cloud(std::uint64_t seed, int count, const Vec3& scale = {1, 1, 1}) {
  std::vector<Vec3> cloud;
  for (int i = 0; i < count; ++i) {
    const Vec3 x = random_point(seed, static_cast<std::uint64_t>(i));
    cloud.push_back({scale[0] * x[0], scale[1] * x[1], scale[2] * x[2]});
  }
  return cloud;
}

/// About the axis (1, 2, 3).
Vec3 turned(const Vec3& x) {
  const Vec3 axis = (1 / std::sqrt(14.0)) * Vec3{1, 2, 3};
  const double c = std::cos(0.7), s = std::sin(0.7);
  return c * x + (s * cross(axis, x) + (1 - c) * dot(axis, x) * axis);
}

struct Fit {
  FitOutcome outcome;
  std::vector<double> weights;
  double sum = 0, absolute = 0, least = 0;
  Vec3 moment{};  ///< sum w (x - t), m
};

Fit fit(const std::vector<Vec3>& cloud, const Vec3& t, const FitRules& rules = {}, bool all = false) {
  std::vector<Vec3> relative;
  for (const Vec3& x : cloud) relative.push_back(x - t);
  Fit result;
  result.weights.resize(cloud.size());
  result.outcome = linear_fit(relative, all, rules, result.weights);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double w = result.weights[i];
    result.sum += w, result.absolute += std::abs(w), result.least = std::min(result.least, w);
    result.moment = result.moment + w * relative[i];
  }
  return result;
}

TEST(LocalLinearFit, ReproducesLinearFieldsAtAnyScale) {
  for (const double scale : {1e-9, 1.0, 1e9})
    for (std::uint64_t seed = 1; seed < 200; ++seed) {
      const std::vector<Vec3> cloud = random_cloud(seed, 20, {scale, scale, scale});
      const Fit f = fit(cloud, scale * random_point(seed + 1000, 0));
      EXPECT_NEAR(f.sum, 1, ulp * f.absolute);
      EXPECT_LE(f.absolute, 1 + FitRules{}.trust + 1e-12);
      ASSERT_TRUE(f.outcome.exact || f.absolute > 3);
      if (f.outcome.exact) {
        EXPECT_LE(norm(f.moment), 1e-14 * scale * (1 + f.absolute)) << "seed " << seed;
      }
    }
}

TEST(LocalLinearFit, TakesFlatCloudsForWhatTheyAre) {
  for (std::uint64_t seed = 1; seed < 50; ++seed) {
    for (const int dimensions : {1, 2}) {
      std::vector<Vec3> cloud = random_cloud(seed, 20, {1, dimensions == 2 ? 1.0 : 0.0, 0});
      for (Vec3& x : cloud) x = turned(x) + Vec3{3, -2, 7};
      // Off the line or plane: as at the foot, with the slope along it.
      const Vec3 along = turned({0.3, dimensions == 2 ? -0.2 : 0.0, 0}), off = turned({0, 0, 0.5});
      const Fit f = fit(cloud, Vec3{3, -2, 7} + along + off);
      EXPECT_NEAR(f.sum, 1, ulp * f.absolute);
      EXPECT_LE(norm(f.moment + off), 1e-12);
      EXPECT_LE(f.absolute, 3);
      EXPECT_FALSE(f.outcome.exact);
      EXPECT_TRUE(f.outcome.deficient);
      EXPECT_LE(f.outcome.distance, 1);
    }
  }
}

TEST(LocalLinearFit, FewOrCoincidentPointsShareTheValue) {
  for (std::size_t count : {1u, 2u, 3u, 20u}) {
    const Fit away = fit(std::vector<Vec3>(count, Vec3{1, 2, 3}), {0, 0, 0}, {}, true);
    const Fit there = fit(std::vector<Vec3>(count, Vec3{1, 2, 3}), {1, 2, 3}, {}, true);
    for (const Fit& f : {away, there})
      for (const double w : f.weights) EXPECT_NEAR(w, 1.0 / static_cast<double>(count), 4 * ulp);
    EXPECT_DOUBLE_EQ(away.outcome.distance, std::sqrt(14.0));
    EXPECT_LE(away.outcome.spacing, 1e-14);
    EXPECT_EQ(there.outcome.distance, 0);
  }
  // Two points are a line, three a plane, four a solid.
  const std::vector<Vec3> corner{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t count = 2; count <= 4; ++count) {
    const std::vector<Vec3> some(corner.begin(), corner.begin() + static_cast<std::ptrdiff_t>(count));
    const Vec3 t{0.2, count > 2 ? 0.3 : 0.0, count > 3 ? 0.1 : 0.0};
    const Fit f = fit(some, t, {}, true);
    EXPECT_LE(norm(f.moment), 1e-14);
    EXPECT_EQ(f.outcome.exact, count == 4);
  }
}

TEST(LocalLinearFit, WeightsStayBoundedAndContinuousAsACloudFlattens) {
  const FitRules rules{.trust = 4};
  const std::vector<Vec3> shape = random_cloud(5, 20);
  std::vector<double> before;
  // From 1 to 1e-17 of the width, in steps of 0.2 %; the target stays where it is.
  for (double thickness = 1; thickness > 1e-17; thickness *= 0.998) {
    std::vector<Vec3> cloud;
    for (const Vec3& x : shape) cloud.push_back(turned({x[0], x[1], thickness * x[2]}));
    const Fit f = fit(cloud, turned({0.1, 0.2, 0.3}), rules);
    ASSERT_NEAR(f.sum, 1, ulp * f.absolute);
    ASSERT_LE(f.absolute, 5 + 1e-12) << "thickness " << thickness;
    if (thickness < 1e-3) {
      ASSERT_LE(norm(f.moment + turned({0, 0, 0.3})), 1e-2) << "thickness " << thickness;
    }
    for (std::size_t i = 0; i < before.size(); ++i)
      ASSERT_NEAR(f.weights[i], before[i], 0.02) << "thickness " << thickness;
    before = f.weights;
  }
}

TEST(LocalLinearFit, StopsExtrapolatingWhereItWouldNeedLargeWeights) {
  const std::vector<Vec3> cloud = random_cloud(9, 20);
  std::vector<double> before;
  double far = 0;
  for (double d = 0; d < 1e4; d = 1.01 * d + 0.01) {
    const Fit f = fit(cloud, {d, 0.3 * d, 0});
    ASSERT_NEAR(f.sum, 1, ulp * f.absolute);
    ASSERT_LE(f.absolute, 1 + FitRules{}.trust + 1e-9);
    ASSERT_EQ(f.outcome.exact, !f.outcome.deficient);
    if (d > 20) {
      ASSERT_FALSE(f.outcome.exact);
    }
    far = f.outcome.distance;
    for (std::size_t i = 0; i < before.size(); ++i) ASSERT_NEAR(f.weights[i], before[i], 0.25);
    before = f.weights;
  }
  EXPECT_GT(far, 9e3);
}

TEST(LocalLinearFit, NonNegativeWeightsStayAndKeepTheInterior) {
  int reduced = 0, kept = 0;
  for (std::uint64_t seed = 1; seed < 300; ++seed) {
    const std::vector<Vec3> cloud = random_cloud(seed, 20);
    const Vec3 t = (seed % 2 == 0 ? 1.2 : 0.5) * random_point(seed + 1000, 0);
    const Fit f = fit(cloud, t, {.non_negative = true}), free = fit(cloud, t);
    EXPECT_GE(f.least, 0) << "seed " << seed;
    EXPECT_NEAR(f.sum, 1, ulp * f.absolute);
    if (free.least >= 0) {
      ++kept;
      EXPECT_EQ(f.weights, free.weights);
      EXPECT_EQ(f.outcome.exact, free.outcome.exact);
    } else {
      ++reduced;
      EXPECT_FALSE(f.outcome.exact);
    }
  }
  EXPECT_GT(reduced, 10);
  EXPECT_GT(kept, 10);
}

TEST(LocalLinearFit, KnowsASpacingFromAGap) {
  // Beside a lattice of unit spacing: the nearest 20 of its points.
  const auto beside = [](double d) {
    const Vec3 t{-d, 0.5, 0.5};
    std::vector<Vec3> lattice;
    for (int i = 0; i < 1000; ++i)
      lattice.push_back(
          {static_cast<double>(i % 10), static_cast<double>(i / 10 % 10 - 5), static_cast<double>(i / 100 - 5)});
    std::sort(lattice.begin(), lattice.end(),
              [&](const Vec3& a, const Vec3& b) { return std::pair(norm(a - t), a) < std::pair(norm(b - t), b); });
    lattice.resize(20);
    const FitOutcome f = fit(lattice, t).outcome;
    return f.distance / f.spacing;
  };
  EXPECT_LT(beside(0.5), 0.8);  // the surface of particles stands half a spacing outside
  EXPECT_GT(beside(2), 1.1);
}

}  // namespace
}  // namespace tenon::transfer

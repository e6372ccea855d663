// SPDX-License-Identifier: BSD-3-Clause
// The branch-free logarithm and exponential against those of the C library.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "components/materials/lane_math.hpp"

namespace tenon {
namespace {

/// Distance in units of the last place of `exact`.
double ulps(double value, double exact) {
  return std::abs(value - exact) /
         (std::nextafter(std::abs(exact), std::numeric_limits<double>::infinity()) - std::abs(exact));
}

TEST(LaneMath, LogarithmIsWithinTwoUlps) {
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> exponent(-300, 300), near(0.5, 2);
  for (int i = 0; i < 100000; ++i) {
    const double x = i % 2 ? std::pow(10, exponent(generator)) : near(generator);
    ASSERT_LE(ulps(log_of(x), std::log(x)), 2) << x;
  }
  EXPECT_EQ(log_of(1), 0);
}

TEST(LaneMath, ExponentialIsWithinTwoUlps) {
  std::mt19937_64 generator(4);
  std::uniform_real_distribution<double> wide(-700, 700), near(-2, 2);
  for (int i = 0; i < 100000; ++i) {
    const double x = i % 2 ? wide(generator) : near(generator);
    ASSERT_LE(ulps(exp_of(x), std::exp(x)), 2) << x;
  }
  EXPECT_EQ(exp_of(0), 1);
  EXPECT_EQ(exp_of(-1e9), exp_of(-700));
  EXPECT_EQ(exp_of(1e9), exp_of(700));
}

}  // namespace
}  // namespace tenon

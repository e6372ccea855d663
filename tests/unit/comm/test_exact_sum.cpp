// SPDX-License-Identifier: BSD-3-Clause
// Exact sums against Shewchuk's expansions, in any order and on any ranks.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "framework/comm/communicator.hpp"
#include "framework/comm/exact_sum.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double least = std::numeric_limits<double>::denorm_min();

const Communicator& comm() {
  return testing::communicator();
}

/// Correctly rounded sum by non-overlapping expansions (Shewchuk 1997), if nothing overflows on the way.
double oracle(const std::vector<double>& terms) {
  std::vector<double> partial;
  for (double x : terms) {
    std::size_t kept = 0;
    for (double y : partial) {
      if (std::abs(x) < std::abs(y)) std::swap(x, y);
      const double high = x + y, low = y - (high - x);
      if (low != 0) partial[kept++] = low;
      x = high;
    }
    partial.resize(kept);
    partial.push_back(x);
  }
  if (partial.empty()) return 0;
  double high = partial.back(), low = 0;
  std::size_t n = partial.size() - 1;
  while (n > 0) {
    const double x = high, y = partial[--n];
    high = x + y;
    low = y - (high - x);
    if (low != 0) break;
  }
  // A tie that was rounded to even is wrong if what lies below leans the other way.
  if (n > 0 && ((low < 0 && partial[n - 1] < 0) || (low > 0 && partial[n - 1] > 0))) {
    const double y = 2 * low, x = high + y;
    if (y == x - high) high = x;
  }
  return high + 0.0;
}

double sum(const std::vector<double>& terms) {
  ExactSum s;
  s.add(terms);
  return s.value();
}

std::vector<double> random_terms(std::mt19937_64& random, int count, int exponents) {
  std::uniform_real_distribution<double> mantissa(-2, 2);
  std::uniform_int_distribution<int> exponent(-exponents, exponents);
  std::vector<double> terms;
  for (int i = 0; i < count; ++i) terms.push_back(std::ldexp(mantissa(random), exponent(random)));
  return terms;
}

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

TEST(ExactSum, IsCorrectlyRounded) {
  std::mt19937_64 random(1);
  for (const int exponents : {0, 3, 40, 70, 200, 900})
    for (const int count : {0, 1, 2, 3, 31, 32, 33, 255, 256, 257, 1000}) {
      std::vector<double> terms = random_terms(random, count, exponents);
      ASSERT_TRUE(same_bits(sum(terms), oracle(terms))) << count << " terms, exponents to " << exponents;
      for (double& x : terms) x = std::ldexp(x, -1040 + exponents);  // many are subnormal
      ASSERT_TRUE(same_bits(sum(terms), oracle(terms))) << count << " small terms";
    }
}

TEST(ExactSum, OrderAndGroupingDoNotMatter) {
  std::mt19937_64 random(2);
  for (const int exponents : {2, 300}) {
    std::vector<double> terms = random_terms(random, 3000, exponents);
    const double expected = sum(terms);
    for (int repeat = 0; repeat < 20; ++repeat) {
      std::shuffle(terms.begin(), terms.end(), random);
      std::vector<ExactSum> groups(1 + random() % 7);
      for (const double x : terms) groups[random() % groups.size()].add(x);
      ExactSum all;
      for (const ExactSum& group : groups) {
        if (random() % 2)
          all.add(group);
        else
          all.add(ExactSum::from_words(group.words()));
      }
      ASSERT_TRUE(same_bits(all.value(), expected));
    }
  }
}

TEST(ExactSum, CancelsToTheLastBit) {
  std::mt19937_64 random(3);
  for (const double rest : {0.0, least, -least, 1e-30, -3.0, 1e200}) {
    std::vector<double> terms = random_terms(random, 2000, 900);
    for (std::size_t i = 0; i < 2000; ++i) terms.push_back(-terms[i]);
    terms.push_back(rest);
    std::shuffle(terms.begin(), terms.end(), random);
    EXPECT_EQ(sum(terms), rest);
  }
  EXPECT_EQ(sum({1e100, 1, -1e100}), 1);
}

TEST(ExactSum, RoundsToNearestEven) {
  const double half_ulp = 0x1p-53, ulp = 0x1p-52;
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(sum({sign, sign * half_ulp}), sign);
    EXPECT_EQ(sum({sign, sign * half_ulp, sign * least}), sign * (1 + ulp));
    EXPECT_EQ(sum({sign, sign * half_ulp, -sign * least}), sign);
    EXPECT_EQ(sum({sign * (1 + ulp), sign * half_ulp}), sign * (1 + 2 * ulp));
    EXPECT_EQ(sum({sign * (1 + ulp), sign * half_ulp, -sign * least}), sign * (1 + ulp));
    EXPECT_EQ(sum({sign * (2 - ulp), sign * half_ulp}), sign * 2) << "carries into the exponent";
    EXPECT_EQ(sum({sign * DBL_MIN, -sign * least}), sign * (DBL_MIN - least));
  }
}

TEST(ExactSum, OverflowsOnlyInTheResult) {
  EXPECT_EQ(sum({DBL_MAX, DBL_MAX, DBL_MAX, -DBL_MAX, -DBL_MAX}), DBL_MAX);
  EXPECT_EQ(sum({DBL_MAX, DBL_MAX}), infinity);
  EXPECT_EQ(sum({-DBL_MAX, -DBL_MAX}), -infinity);
  EXPECT_EQ(sum({DBL_MAX, 0x1p970}), infinity) << "half an ulp above the greatest";
  EXPECT_EQ(sum({DBL_MAX, 0x1p970, -least}), DBL_MAX);
  EXPECT_EQ(sum(std::vector<double>(1000, DBL_MAX)), infinity);
  ExactSum huge;
  huge.add(DBL_MAX);
  for (int i = 0; i < 60; ++i) huge.add(huge);
  EXPECT_EQ(huge.value(), infinity);
}

TEST(ExactSum, InfiniteAndNotANumberGiveNotANumber) {
  for (const double bad : {infinity, -infinity, std::nan(""), -std::nan("")})
    for (const int others : {0, 10, 300}) {
      std::vector<double> terms(static_cast<std::size_t>(others), 1.0);
      terms.insert(terms.begin() + others / 2, bad);
      EXPECT_TRUE(std::isnan(sum(terms)));
    }
  EXPECT_TRUE(std::isnan(sum(std::vector<double>(256, std::nan("")))));
  ExactSum s;
  s.add_product(1e200, 1e200);
  EXPECT_TRUE(std::isnan(s.value()));
  s.clear();
  EXPECT_EQ(s.value(), 0);
}

TEST(ExactSum, ZeroIsPositive) {
  EXPECT_FALSE(std::signbit(ExactSum().value()));
  EXPECT_FALSE(std::signbit(sum({-0.0, -0.0})));
  EXPECT_FALSE(std::signbit(sum(std::vector<double>(256, -0.0))));
  EXPECT_FALSE(std::signbit(sum({-1.0, 1.0})));
}

TEST(ExactSum, DotProductsAreCorrectlyRounded) {
  std::mt19937_64 random(5);
  for (const int exponents : {0, 30, 200}) {
    const std::vector<double> a = random_terms(random, 1000, exponents), b = random_terms(random, 1000, exponents);
    ExactSum s;
    std::vector<double> terms;
    for (std::size_t i = 0; i < a.size(); ++i) {
      s.add_product(a[i], b[i]);
      const double product = a[i] * b[i];
      terms.insert(terms.end(), {product, std::fma(a[i], b[i], -product)});
    }
    EXPECT_TRUE(same_bits(s.value(), oracle(terms)));
    for (std::size_t i = 0; i < a.size(); ++i) s.add_product(-b[i], a[i]);
    EXPECT_EQ(s.value(), 0) << "the products cancel exactly";
  }
  ExactSum s;  // (1 + e)(1 - e) - 1 = -e^2, lost in plain arithmetic
  s.add_product(1 + 0x1p-30, 1 - 0x1p-30);
  s.add(-1.0);
  EXPECT_EQ(s.value(), -0x1p-60);
  s.clear();
  s.add_product(1e-200, 1e-200);  // below the least subnormal
  EXPECT_EQ(s.value(), 0);
}

TEST(ExactSum, CarriesAreDoneInTime) {
  for (const double x : {3.0, -5e-324, 1.7e300 * 0x1p-100}) {
    ExactSum s;
    s.add(x);
    for (int i = 0; i < 80; ++i) s.add(s);  // as many terms as 2^80 additions
    EXPECT_EQ(s.value(), std::ldexp(x, 80));
    const ExactSum again = ExactSum::from_words(s.words());
    EXPECT_EQ(again.value(), std::ldexp(x, 80));
  }
}

TEST(ExactSum, IsTheSameOnAnyRanks) {
  std::mt19937_64 random(7);
  constexpr int sums = 5;
  std::vector<double> serial;
  std::vector<ExactSum> local(sums);
  for (int k = 0; k < sums; ++k) {
    const std::vector<double> terms = random_terms(random, 500, 50 * k);
    serial.push_back(sum(terms));
    for (std::size_t i = 0; i < terms.size(); ++i)  // the last rank has none
      if (static_cast<int>(i) % std::max(1, comm().size() - 1) == comm().rank())
        local[static_cast<std::size_t>(k)].add(terms[i]);
  }
  std::vector<double> result(sums);
  comm().sum(local, result);
  for (std::size_t k = 0; k < sums; ++k) {
    EXPECT_TRUE(same_bits(result[k], serial[k]));
    EXPECT_TRUE(same_bits(comm().sum(local[k]), serial[k]));
  }
  ExactSum bad;
  bad.add(comm().rank() == comm().size() - 1 ? infinity : 1.0);
  EXPECT_TRUE(std::isnan(comm().sum(bad)));
}

}  // namespace
}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Sum of doubles without rounding: the result does not depend on the order or grouping of the terms.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace tenon {

/// A fixed-point accumulator as wide as the whole range of double (Kulisch; radix 2^32 digits held in
/// signed 64-bit words, so carries are deferred). Adding costs a few integer operations. Infinities and
/// NaN are counted and make the result NaN. Exact for up to 2^30 additions between normalisations, which
/// it does itself.
class ExactSum {
 public:
  static constexpr int digits = 68;

  void add(double value);
  void add(std::span<const double> values);
  /// Adds a*b with the rounding error of the product also added, so dot products are correctly rounded.
  void add_product(double a, double b);
  void add(const ExactSum& other);
  void clear();
  /// The sum, correctly rounded to nearest even.
  double value() const;

  /// Digits with all carries done: what is sent to other ranks; word `digits` counts non-finite terms.
  std::array<std::int64_t, digits + 1> words() const;
  static ExactSum from_words(std::span<const std::int64_t> words);

 private:
  void normalise();
  std::array<std::int64_t, digits> digit_{};
  std::int64_t special_ = 0;
  std::int32_t pending_ = 0;  // additions since the last normalisation
};

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Sum of doubles without rounding: the result does not depend on the order or grouping of the terms.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tenon {

/// A fixed-point accumulator as wide as the whole range of double (Kulisch; radix 2^32 digits held in
/// signed 64-bit words, so carries are deferred). Infinities and NaN are counted and make the result NaN. Terms are
/// gathered in a buffer, which is reduced to a few doubles with error-free transformations [ROO08] before it goes
/// into the digits: one to two nanoseconds a term. Zero sums are +0.
class ExactSum {
 public:
  static constexpr int digits = 68;

  void add(double value) {
    buffer_[waiting_++] = value;
    if (waiting_ == buffer_size) flush();
  }
  void add(std::span<const double> values);
  /// Adds a*b with the rounding error of the product also added, so dot products are correctly rounded. (Errors below
  /// the least subnormal are rounded to it, each by itself, so the order still does not matter.) A product that
  /// overflows counts as infinite.
  void add_product(double a, double b) {
    const double product = a * b;
    add(product);
    add(std::fma(a, b, -product));
  }
  void add(const ExactSum& other);
  void clear();
  /// The sum, correctly rounded to nearest even.
  double value() const;

  /// Digits with all carries done: what is sent to other ranks; word `digits` counts non-finite terms.
  std::array<std::int64_t, digits + 1> words() const;
  static ExactSum from_words(std::span<const std::int64_t> words);

 private:
  static constexpr std::size_t buffer_size = 256;

  void flush();
  bool flush_at_once();
  void place(double value);
  void normalise();

  std::array<std::int64_t, digits> digit_{};
  std::int64_t special_ = 0;
  std::int32_t pending_ = 0;  // terms placed since the last normalisation
  std::size_t waiting_ = 0;
  alignas(32) std::array<double, buffer_size> buffer_{};
};

}  // namespace tenon

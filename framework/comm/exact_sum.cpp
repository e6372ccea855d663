// SPDX-License-Identifier: BSD-3-Clause
#include "framework/comm/exact_sum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace tenon {

namespace {

using Signed128 = __int128;

constexpr std::int32_t pending_limit = 1 << 30;
constexpr std::int64_t low_digit = 0xffffffff;

// Digit 0 holds the bits 2^-1074 .. 2^-1043: the unit of the accumulator is the least subnormal double.
constexpr int unit_exponent = -1074;

struct Parts {
  std::int64_t mantissa;  // signed
  int exponent;           // biased, 1 for subnormal numbers; value = mantissa * 2^(exponent - 1075)
};

Parts split(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const int biased = static_cast<int>(bits >> 52) & 0x7ff;
  const std::int64_t fraction = static_cast<std::int64_t>(bits & 0xfffffffffffff);
  const std::int64_t magnitude = biased == 0 ? fraction : fraction | (std::int64_t{1} << 52);
  const std::int64_t sign = static_cast<std::int64_t>(bits) >> 63;
  return {(magnitude ^ sign) - sign, biased == 0 ? 1 : biased};
}

}  // namespace

void ExactSum::add(double value) {
  const auto [mantissa, exponent] = split(value);
  if (exponent == 0x7ff) {
    ++special_;
    return;
  }
  const int shift = exponent - 1;
  const Signed128 placed = Signed128{mantissa} << (shift & 31);
  std::int64_t* digit = &digit_[static_cast<std::size_t>(shift >> 5)];
  const auto low = static_cast<std::uint64_t>(placed);
  digit[0] += static_cast<std::int64_t>(low & low_digit);
  digit[1] += static_cast<std::int64_t>(low >> 32);
  digit[2] += static_cast<std::int64_t>(placed >> 64);
  if (++pending_ >= pending_limit) normalise();
}

void ExactSum::add(std::span<const double> values) {
  for (const double value : values) add(value);
}

void ExactSum::add_product(double a, double b) {
  const Parts x = split(a), y = split(b);
  if (x.exponent == 0x7ff || y.exponent == 0x7ff) {
    ++special_;
    return;
  }
  const int shift = x.exponent + y.exponent - 1076;
  if (shift < 0) {
    // The last bits may lie below the accumulator's unit; fma then rounds this term to it, whatever the order.
    const double product = a * b;
    add(product);
    add(std::fma(a, b, -product));
    return;
  }
  if (shift > 2015) {  // above 2^1046: far beyond double
    ++special_;
    return;
  }
  const Signed128 product = Signed128{x.mantissa} * y.mantissa;
  const int s = shift & 31;
  const auto low = static_cast<std::uint64_t>(product) << s;
  const auto high = static_cast<std::uint64_t>(product >> (64 - s));
  const auto top = static_cast<std::int64_t>(product >> 64) >> 1 >> (63 - s);
  std::int64_t* digit = &digit_[static_cast<std::size_t>(shift >> 5)];
  digit[0] += static_cast<std::int64_t>(low & low_digit);
  digit[1] += static_cast<std::int64_t>(low >> 32);
  digit[2] += static_cast<std::int64_t>(high & low_digit);
  digit[3] += static_cast<std::int64_t>(high >> 32);
  digit[4] += top;
  if (++pending_ >= pending_limit) normalise();
}

void ExactSum::add(const ExactSum& other) {
  if (other.pending_ > pending_limit / 2) {
    ExactSum copy = other;
    copy.normalise();
    add(copy);
    return;
  }
  if (pending_ > pending_limit / 2 - 2) normalise();
  for (std::size_t i = 0; i < digit_.size(); ++i) digit_[i] += other.digit_[i];
  special_ += other.special_;
  pending_ += other.pending_ + 1;  // the digits of a normalised sum weigh as much as one term
}

void ExactSum::clear() {
  *this = ExactSum();
}

void ExactSum::normalise() {
  std::int64_t carry = 0;
  for (std::size_t i = 0; i + 1 < digit_.size(); ++i) {
    const std::int64_t with_carry = digit_[i] + carry;
    digit_[i] = with_carry & low_digit;
    carry = with_carry >> 32;
  }
  digit_.back() += carry;
  pending_ = 1;
}

double ExactSum::value() const {
  if (special_ > 0) return std::numeric_limits<double>::quiet_NaN();
  ExactSum sum = *this;
  sum.normalise();
  const bool negative = sum.digit_.back() < 0;
  if (negative) {
    for (std::int64_t& d : sum.digit_) d = -d;
    sum.normalise();
  }
  int top = digits - 1;
  while (top >= 0 && sum.digit_[static_cast<std::size_t>(top)] == 0) --top;
  if (top < 0) return 0.0;
  if (top == digits - 1) {  // from 2^1070 on
    return negative ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
  }
  const auto digit = [&](int i) { return static_cast<std::uint64_t>(sum.digit_[static_cast<std::size_t>(i)]); };
  const int last_bit = 32 * top + std::bit_width(digit(top)) - 1;
  // Bits last_bit-52 .. last_bit make the mantissa; below bit 0 there are none, so small sums are exact.
  const int first_bit = last_bit > 52 ? last_bit - 52 : 0;
  const auto bit = [&](int i) { return (digit(i >> 5) >> (i & 31)) & 1; };
  std::uint64_t mantissa = 0;
  for (int i = last_bit; i >= first_bit; --i) mantissa = mantissa << 1 | bit(i);
  if (first_bit > 0 && bit(first_bit - 1)) {
    const int half = first_bit - 1;
    bool above_half = (digit(half >> 5) & ((std::uint64_t{1} << (half & 31)) - 1)) != 0;
    for (int i = (half >> 5) - 1; i >= 0 && !above_half; --i) above_half = digit(i) != 0;
    if (above_half || (mantissa & 1)) ++mantissa;
  }
  const double magnitude = std::ldexp(static_cast<double>(mantissa), first_bit + unit_exponent);
  return negative ? -magnitude : magnitude;
}

std::array<std::int64_t, ExactSum::digits + 1> ExactSum::words() const {
  ExactSum sum = *this;
  sum.normalise();
  std::array<std::int64_t, digits + 1> words{};
  std::copy(sum.digit_.begin(), sum.digit_.end(), words.begin());
  words[digits] = special_;
  return words;
}

ExactSum ExactSum::from_words(std::span<const std::int64_t> words) {
  ExactSum sum;
  std::copy_n(words.begin(), digits, sum.digit_.begin());
  sum.special_ = words[digits];
  sum.normalise();
  return sum;
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
#include "framework/comm/exact_sum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
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

// Four doubles at once. How they are passed where the machine has no such registers does not matter inside one file.
#pragma GCC diagnostic ignored "-Wpsabi"
constexpr std::size_t lanes = 4;
typedef double Vector __attribute__((vector_size(lanes * sizeof(double))));
typedef std::int64_t Bits __attribute__((vector_size(lanes * sizeof(double))));

Vector load(const double* from) {
  Vector v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
Vector magnitude(const Vector& v) {
  return std::bit_cast<Vector>(std::bit_cast<Bits>(v) & std::numeric_limits<std::int64_t>::max());
}
Vector greater(const Vector& a, const Vector& b) {
  return b > a ? b : a;
}
double sum_of_lanes(const Vector& v) {
  return (v[0] + v[1]) + (v[2] + v[3]);
}
double greatest_lane(const Vector& v) {
  return std::max({v[0], v[1], v[2], v[3]});
}

}  // namespace

// Puts a term into three neighbouring digits.
void ExactSum::place(double value) {
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

void ExactSum::flush() {
  constexpr std::size_t few = 32;  // below, one by one is as quick
  if (waiting_ < few || !flush_at_once())
    for (std::size_t i = 0; i < waiting_; ++i) place(buffer_[i]);
  waiting_ = 0;
}

// [ROO08, algorithm 3.3]: with sigma = 2^k >= 2^log2_terms max|x|, q = (sigma + x) - sigma is x rounded to a multiple
// of 2^-53 sigma, x - q is exact, and so is the sum of all q in any order. Three rounds take 3 x 44 bits below the
// greatest term. False, with nothing done, if a term reaches deeper, is not finite or nearly overflows.
bool ExactSum::flush_at_once() {
  constexpr int log2_terms = 9;         // 2^9 >= 256 + 2
  constexpr double narrower = 0x1p-44;  // 2^(log2_terms - 53)
  static_assert(buffer_size + 2 <= std::size_t{1} << log2_terms && buffer_size % lanes == 0);
  std::fill(buffer_.begin() + static_cast<std::ptrdiff_t>(waiting_), buffer_.end(), 0.0);

  Vector largest{};
  for (std::size_t i = 0; i < buffer_size; i += lanes) largest = greater(largest, magnitude(load(&buffer_[i])));
  const std::uint64_t biased = std::bit_cast<std::uint64_t>(greatest_lane(largest)) >> 52;
  if (biased > 2000) return false;
  const double sigma = std::bit_cast<double>((biased + 1 + log2_terms) << 52);
  const Vector sigma_1 = Vector{} + sigma, sigma_2 = sigma_1 * narrower, sigma_3 = sigma_2 * narrower;

  Vector sum_1{}, sum_2{}, sum_3{}, left{};
  for (std::size_t i = 0; i < buffer_size; i += lanes) {
    Vector x = load(&buffer_[i]);
    const Vector q_1 = (sigma_1 + x) - sigma_1;
    x -= q_1;
    const Vector q_2 = (sigma_2 + x) - sigma_2;
    x -= q_2;
    const Vector q_3 = (sigma_3 + x) - sigma_3;
    x -= q_3;
    sum_1 += q_1;
    sum_2 += q_2;
    sum_3 += q_3;
    left = greater(left, magnitude(x));
  }
  const double total_1 = sum_of_lanes(sum_1);
  if (greatest_lane(left) > 0 || total_1 != total_1) return false;  // the second: a term was not a number
  place(total_1);
  place(sum_of_lanes(sum_2));
  place(sum_of_lanes(sum_3));
  return true;
}

void ExactSum::add(std::span<const double> values) {
  for (const double value : values) add(value);
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
  pending_ += other.pending_ + 1;             // the digits of a normalised sum weigh as much as one term
  const std::size_t others = other.waiting_;  // may be this sum itself
  for (std::size_t i = 0; i < others; ++i) add(other.buffer_[i]);
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
  ExactSum sum = *this;
  sum.flush();
  if (sum.special_ > 0) return std::numeric_limits<double>::quiet_NaN();
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
  sum.flush();
  sum.normalise();
  std::array<std::int64_t, digits + 1> words{};
  std::copy(sum.digit_.begin(), sum.digit_.end(), words.begin());
  words[digits] = sum.special_;
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

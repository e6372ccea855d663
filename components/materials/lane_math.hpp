// SPDX-License-Identifier: BSD-3-Clause
// Logarithm and exponential without branches, which g++ vectorises in lane loops; the same bits on every machine.
#pragma once

#include <bit>
#include <cstdint>

namespace tenon {

/// Natural logarithm of a normal positive number, error below 1 ulp: the reduction and polynomial of fdlibm's e_log.c.
[[gnu::always_inline]] inline double log_of(double x) {
  constexpr std::uint64_t one = 0x3ff0000000000000, root_half = 0x3fe6a09e00000000, fraction = 0x000fffffffffffff;
  constexpr std::uint64_t two_52 = 0x4330000000000000;
  constexpr double ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x) + (one - root_half);
  // The biased exponent as a double: its bits in the mantissa of 2^52, less 2^52.
  const double k = std::bit_cast<double>((bits >> 52) | two_52) - (4503599627370496.0 + 1023.0);
  const double f =
      std::bit_cast<double>((bits & fraction) + root_half) - 1.0;  // x = 2^k (1 + f), 1 + f in sqrt(1/2) .. sqrt(2)
  const double s = f / (2.0 + f), z = s * s, w = z * z;
  const double odd = w * (3.999999999940941908e-01 + w * (2.222219843214978396e-01 + w * 1.531383769920937332e-01));
  const double even =
      z * (6.666666666666735130e-01 +
           w * (2.857142874366239149e-01 + w * (1.818357216161805012e-01 + w * 1.479819860511658591e-01)));
  const double half_square = 0.5 * f * f;
  return k * ln2_high - ((half_square - (s * (half_square + (odd + even)) + k * ln2_low)) - f);
}

/// e^x, error below 1 ulp for |x| <= 700, to which x is cut: fdlibm's e_exp.c.
[[gnu::always_inline]] inline double exp_of(double x) {
  constexpr double ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;
  constexpr double inverse_ln2 = 1.44269504088896338700;
  constexpr double shifter = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer in the low bits
  x = x < -700.0 ? -700.0 : x > 700.0 ? 700.0 : x;
  const double shifted = x * inverse_ln2 + shifter;
  const double k = shifted - shifter;
  const double high = x - k * ln2_high, low = k * ln2_low, r = high - low, t = r * r;
  const double c =
      r -
      t * (1.66666666666666019037e-01 +
           t * (-2.77777777770155933842e-03 +
                t * (6.61375632143793436117e-05 + t * (-1.65339022054652515390e-06 + t * 4.13813679705723846039e-08))));
  const double y = 1.0 - ((low - r * c / (2.0 - c)) - high);
  const std::uint64_t power = (std::bit_cast<std::uint64_t>(shifted) + 1023) << 52;
  return y * std::bit_cast<double>(power);
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Four points side by side in one machine vector, and the few operations that kernels need on them.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

/// The kernels are built of small functions of many values; kept as calls they would go through memory.
#define TENON_KERNEL [[gnu::always_inline]] inline

namespace tenon {

/// A GCC vector: every operator acts on each point alone, so a result never depends on the neighbours in the vector.
/// Machines without AVX get the same results from narrower instructions.
using Pack = double __attribute__((vector_size(32)));
using PackMask = std::int64_t __attribute__((vector_size(32)));
inline constexpr int pack_width = 4;

TENON_KERNEL Pack load(const double* from) {
  Pack p;
  std::memcpy(&p, from, sizeof p);
  return p;
}
TENON_KERNEL void store(double* to, const Pack& p) {
  std::memcpy(to, &p, sizeof p);
}

/// All points alike.
template <typename R>
TENON_KERNEL R broadcast(double value) {
  return R{} + value;
}

TENON_KERNEL double square_root(double x) {
  return std::sqrt(x);
}
TENON_KERNEL Pack square_root(const Pack& x) {
  return Pack{__builtin_sqrt(x[0]), __builtin_sqrt(x[1]), __builtin_sqrt(x[2]), __builtin_sqrt(x[3])};
}

/// The greater or lesser of two values at each point; the second where they cannot be compared.
template <typename R>
TENON_KERNEL R greater_of(const R& a, const R& b) {
  return a > b ? a : b;
}
template <typename R>
TENON_KERNEL R lesser_of(const R& a, const R& b) {
  return a < b ? a : b;
}

/// Whether it is so at any point.
TENON_KERNEL bool any(const PackMask& mask) {
#ifdef __AVX__
  return __builtin_ia32_movmskpd256(std::bit_cast<Pack>(mask)) != 0;
#else
  return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
#endif
}

/// Bit l is set where it is so at point l.
TENON_KERNEL unsigned bits(const PackMask& mask) {
#ifdef __AVX__
  return static_cast<unsigned>(__builtin_ia32_movmskpd256(std::bit_cast<Pack>(mask)));
#else
  return static_cast<unsigned>((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
#endif
}

/// Rows and columns of four points by four values change places.
TENON_KERNEL void transpose(Pack& a, Pack& b, Pack& c, Pack& d) {
  const Pack ab_low = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab_high = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Pack cd_low = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd_high = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Eight points side by side: for loops over pairs, which are long enough to fill the widest vectors.
#pragma once

#include <cstddef>
#include <cstring>

#include "framework/base/pack.hpp"

namespace tenon {

/// As Pack. Machines with narrower vectors get the same results from two or four instructions.
using WidePack = double __attribute__((vector_size(64)));
using WideMask = std::int64_t __attribute__((vector_size(64)));
inline constexpr int wide_pack_width = 8;

TENON_KERNEL WidePack load_wide(const double* from) {
  WidePack p;
  std::memcpy(&p, from, sizeof p);
  return p;
}
TENON_KERNEL void store(double* to, const WidePack& p) {
  std::memcpy(to, &p, sizeof p);
}

TENON_KERNEL WidePack square_root(const WidePack& x) {
#ifdef __AVX512F__
  constexpr int rounding_of_the_moment = 4;
  return __builtin_ia32_sqrtpd512_mask(x, WidePack{}, 0xff, rounding_of_the_moment);
#else
  return WidePack{__builtin_sqrt(x[0]), __builtin_sqrt(x[1]), __builtin_sqrt(x[2]), __builtin_sqrt(x[3]),
                  __builtin_sqrt(x[4]), __builtin_sqrt(x[5]), __builtin_sqrt(x[6]), __builtin_sqrt(x[7])};
#endif
}

/// Bit l is set where it is so at point l.
TENON_KERNEL unsigned bits(const WideMask& mask) {
#ifdef __AVX512DQ__
  using Longs [[gnu::may_alias]] = long long __attribute__((vector_size(64)));
  return static_cast<unsigned char>(__builtin_ia32_cvtq2mask512(reinterpret_cast<const Longs&>(mask)));
#else
  const PackMask low = __builtin_shufflevector(mask, mask, 0, 1, 2, 3);
  const PackMask high = __builtin_shufflevector(mask, mask, 4, 5, 6, 7);
  return bits(low) | bits(high) << pack_width;
#endif
}

/// Bit l is set where a < b.
TENON_KERNEL unsigned where_less(const WidePack& a, const WidePack& b) {
#ifdef __AVX512F__
  constexpr int less = 1, rounding_of_the_moment = 4;
  return static_cast<unsigned char>(__builtin_ia32_cmppd512_mask(a, b, less, -1, rounding_of_the_moment));
#else
  return bits(a < b);
#endif
}

/// Those values whose bit is set, one after the other. Up to eight places are written, with anything beyond them.
TENON_KERNEL void store_chosen(double* to, const WidePack& p, unsigned chosen) {
#ifdef __AVX512F__
  store(to, WidePack(__builtin_ia32_compressdf512_mask(p, WidePack{}, static_cast<unsigned char>(chosen))));
#else
  for (int l = 0; l < wide_pack_width; ++l) {
    *to = p[l];
    to += chosen >> l & 1u;
  }
#endif
}
/// As above, of eight from `from`.
TENON_KERNEL void store_chosen(std::int32_t* to, const std::int32_t* from, unsigned chosen) {
#ifdef __AVX512VL__
  using Integers = int __attribute__((vector_size(32)));
  Integers p;
  std::memcpy(&p, from, sizeof p);
  p = Integers(__builtin_ia32_compresssi256_mask(p, Integers{}, static_cast<unsigned char>(chosen)));
  std::memcpy(to, &p, sizeof p);
#else
  for (int l = 0; l < wide_pack_width; ++l) {
    const std::int32_t value = from[l];
    *to = value;
    to += chosen >> l & 1u;
  }
#endif
}

/// Four values each at eight places: `first` is where they begin, `stride` apart, and `at` counts places.
TENON_KERNEL void gather(const double* first, std::size_t stride, const std::int32_t* at, WidePack& a, WidePack& b,
                         WidePack& c, WidePack& d) {
  const auto pair = [&](int low) {
    const Pack p = load(first + stride * static_cast<std::size_t>(at[low])),
               q = load(first + stride * static_cast<std::size_t>(at[low + 4]));
    return WidePack(__builtin_shufflevector(p, q, 0, 1, 2, 3, 4, 5, 6, 7));
  };
  const WidePack r0 = pair(0), r1 = pair(1), r2 = pair(2), r3 = pair(3);
  const WidePack ab_low = __builtin_shufflevector(r0, r1, 0, 8, 2, 10, 4, 12, 6, 14),
                 ab_high = __builtin_shufflevector(r0, r1, 1, 9, 3, 11, 5, 13, 7, 15),
                 cd_low = __builtin_shufflevector(r2, r3, 0, 8, 2, 10, 4, 12, 6, 14),
                 cd_high = __builtin_shufflevector(r2, r3, 1, 9, 3, 11, 5, 13, 7, 15);
  a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 8, 9, 4, 5, 12, 13);
  b = __builtin_shufflevector(ab_high, cd_high, 0, 1, 8, 9, 4, 5, 12, 13);
  c = __builtin_shufflevector(ab_low, cd_low, 2, 3, 10, 11, 6, 7, 14, 15);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 10, 11, 6, 7, 14, 15);
}

/// All eight added up, always in the same order.
TENON_KERNEL double sum_of(const WidePack& p) {
  return ((p[0] + p[4]) + (p[2] + p[6])) + ((p[1] + p[5]) + (p[3] + p[7]));
}

/// `sum_of` of eight packs at once; the sums stand in the order a, e, b, f, c, g, d, h.
TENON_KERNEL WidePack sums_of(const WidePack& a, const WidePack& b, const WidePack& c, const WidePack& d,
                              const WidePack& e, const WidePack& f, const WidePack& g, const WidePack& h) {
  const auto halves = [](const WidePack& p, const WidePack& q) {
    return WidePack(__builtin_shufflevector(p, q, 0, 1, 2, 3, 8, 9, 10, 11) +
                    __builtin_shufflevector(p, q, 4, 5, 6, 7, 12, 13, 14, 15));
  };
  const auto quarters = [](const WidePack& p, const WidePack& q) {
    return WidePack(__builtin_shufflevector(p, q, 0, 1, 4, 5, 8, 9, 12, 13) +
                    __builtin_shufflevector(p, q, 2, 3, 6, 7, 10, 11, 14, 15));
  };
  const WidePack abcd = quarters(halves(a, b), halves(c, d)), efgh = quarters(halves(e, f), halves(g, h));
  return __builtin_shufflevector(abcd, efgh, 0, 8, 2, 10, 4, 12, 6, 14) +
         __builtin_shufflevector(abcd, efgh, 1, 9, 3, 11, 5, 13, 7, 15);
}

/// Room for a whole number of packs.
inline std::size_t padded_to_pack(std::size_t n) {
  return (n + wide_pack_width - 1) / wide_pack_width * wide_pack_width;
}

}  // namespace tenon

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
  return WidePack{__builtin_sqrt(x[0]), __builtin_sqrt(x[1]), __builtin_sqrt(x[2]), __builtin_sqrt(x[3]),
                  __builtin_sqrt(x[4]), __builtin_sqrt(x[5]), __builtin_sqrt(x[6]), __builtin_sqrt(x[7])};
}

/// Bit l is set where it is so at point l.
TENON_KERNEL unsigned bits(const WideMask& mask) {
  const PackMask low = __builtin_shufflevector(mask, mask, 0, 1, 2, 3);
  const PackMask high = __builtin_shufflevector(mask, mask, 4, 5, 6, 7);
  return bits(low) | bits(high) << pack_width;
}

/// All eight added up, always in the same order.
TENON_KERNEL double sum_of(const WidePack& p) {
  return ((p[0] + p[4]) + (p[2] + p[6])) + ((p[1] + p[5]) + (p[3] + p[7]));
}

/// Room for a whole number of packs.
inline std::size_t padded_to_pack(std::size_t n) {
  return (n + wide_pack_width - 1) / wide_pack_width * wide_pack_width;
}

}  // namespace tenon

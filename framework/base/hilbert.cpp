// SPDX-License-Identifier: BSD-3-Clause
#include "framework/base/hilbert.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

namespace tenon {

namespace {

// Spreads 16 bits, two zeros between each.
std::uint64_t spread(std::uint64_t x) {
#ifdef __BMI2__
  return __builtin_ia32_pdep_di(x, 0x249249249249);
#else
  x = (x | x << 16) & 0x0000ff0000ff;
  x = (x | x << 8) & 0x00f00f00f00f;
  x = (x | x << 4) & 0x0c30c30c30c3;
  return (x | x << 2) & 0x249249249249;
#endif
}

/// Place of a cell on the Hilbert curve through 2^48 cells, before interleaving (Skilling's transposition [Ski04]).
/// Cell: a number, or a machine vector of them.
template <typename Cell>
[[gnu::always_inline]] inline void transpose_hilbert(Cell (&x)[3]) {
  constexpr int bits = 16;
  const auto all_if = [](const Cell& v, int bit) { return Cell{} - (v >> bit & 1); };  // all ones where the bit is set
#pragma GCC unroll 16
  for (int bit = bits - 1; bit > 0; --bit) {
    const std::uint32_t below = (1u << bit) - 1;
#pragma GCC unroll 3
    for (int c = 0; c < 3; ++c) {
      const Cell set = all_if(x[c], bit), swapped = (x[0] ^ x[c]) & below;
      const Cell exchange = ~set & swapped;
      x[0] ^= (set & below) | exchange;
      x[c] ^= exchange;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  Cell flip{};
  for (int bit = bits - 1; bit > 0; --bit) flip ^= all_if(x[2], bit) & ((1u << bit) - 1);
  for (int c = 0; c < 3; ++c) x[c] ^= flip;
}

std::uint64_t interleaved(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spread(x) << 2 | spread(y) << 1 | spread(z);
}

}  // namespace

HilbertCurve::HilbertCurve(const Box& bounds) {
  if (bounds.empty()) return;
  low_ = bounds.low;
  double extent = 0;
  for (std::size_t c = 0; c < 3; ++c) extent = std::max(extent, bounds.high[c] - bounds.low[c]);
  scale_ = extent > 0 && std::isfinite(65535 / extent) ? 65535 / extent : 0;
}

std::uint64_t HilbertCurve::code(const Vec3& x) const {
  std::uint32_t cells[3] = {0, 0, 0};
  if (is_finite(x))
    for (std::size_t c = 0; c < 3; ++c) cells[c] = cell(x, c);
  transpose_hilbert(cells);
  return interleaved(cells[0], cells[1], cells[2]);
}

void HilbertCurve::codes_of(const EightCells& cells, std::array<std::uint64_t, 8>& codes) {
  using Eight = std::uint32_t __attribute__((vector_size(32)));
  Eight x[3];
  for (std::size_t c = 0; c < 3; ++c) std::memcpy(&x[c], cells[c].data(), sizeof x[c]);
  transpose_hilbert(x);
  for (std::size_t k = 0; k < 8; ++k) codes[k] = interleaved(x[0][k], x[1][k], x[2][k]);
}

namespace {

constexpr int upper_bits = 32,
              dropped_bits = 16;  // of the 48: those that the radix sort takes, and those that are left
constexpr int first_bits = 11, digit_bits = 7, digits = 3;
constexpr std::uint64_t digit_values = 1 << digit_bits;

// Sorts keys by their lower 21 upper bits, from `from` to `to`, which are used in turn.
void sort_bucket(std::uint64_t* from, std::uint64_t* to, std::size_t count) {
  constexpr std::size_t few = 48;
  if (count <= few) {
    std::copy_n(from, count, to);
    std::sort(to, to + count);  // the index is part of the key
    return;
  }
  std::array<std::array<std::uint32_t, digit_values>, digits> begin{};
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t d = 0; d < digits; ++d) ++begin[d][from[i] >> (upper_bits + digit_bits * d) & (digit_values - 1)];
  for (std::size_t d = 0; d < digits; ++d) {
    auto& next = begin[d];
    std::exclusive_scan(next.begin(), next.end(), next.begin(), std::uint32_t{0});
    const std::size_t shift = upper_bits + digit_bits * d;
    for (std::size_t i = 0; i < count; ++i) to[next[from[i] >> shift & (digit_values - 1)]++] = from[i];
    std::swap(from, to);
  }
}

}  // namespace

// A radix sort by the upper 32 of the 48 bits: into buckets first, which then fit into a cache. Few keys have
// neighbours with the same upper bits: those are sorted by the rest.
void order_of_codes(CurveRoom& room, std::vector<LocalIndex>& order) {
  constexpr std::size_t buckets = 1 << first_bits;
  const std::vector<std::uint64_t>& codes = room.codes;
  const std::size_t count = codes.size();
  std::vector<std::uint64_t>&keys = room.keys, &other = room.other;  // upper bits of a code, and its index
  keys.resize(count), other.resize(count);
  const auto bucket_of = [](std::uint64_t code) { return code >> (48 - first_bits); };
  std::array<std::uint32_t, buckets + 1> begin{};
  for (const std::uint64_t code : codes) ++begin[bucket_of(code) + 1];
  std::inclusive_scan(begin.begin(), begin.end(), begin.begin());
  std::array<std::uint32_t, buckets> next;
  std::copy_n(begin.begin(), buckets, next.begin());
  for (std::size_t i = 0; i < count; ++i)
    other[next[bucket_of(codes[i])]++] = codes[i] >> dropped_bits << upper_bits | i;
  for (std::size_t b = 0; b < buckets; ++b)
    if (begin[b + 1] > begin[b]) sort_bucket(other.data() + begin[b], keys.data() + begin[b], begin[b + 1] - begin[b]);

  const auto index = [](std::uint64_t key) { return static_cast<std::size_t>(key & 0xffffffff); };
  const auto before = [&](std::uint64_t a, std::uint64_t b) {
    const std::uint64_t code_a = codes[index(a)], code_b = codes[index(b)];
    return code_a != code_b ? code_a < code_b : a < b;
  };
  for (std::size_t first = 0, last; first < count; first = last) {
    for (last = first + 1; last < count && keys[last] >> upper_bits == keys[first] >> upper_bits;) ++last;
    if (last > first + 1)
      std::sort(keys.begin() + static_cast<std::ptrdiff_t>(first), keys.begin() + static_cast<std::ptrdiff_t>(last),
                before);
  }
  order.resize(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = static_cast<LocalIndex>(index(keys[i]));
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
#include "framework/base/hilbert.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace tenon {

namespace {

// Spreads 16 bits, two zeros between each.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 16) & 0x0000ff0000ff;
  x = (x | x << 8) & 0x00f00f00f00f;
  x = (x | x << 4) & 0x0c30c30c30c3;
  return (x | x << 2) & 0x249249249249;
}

// Place of a cell on the Hilbert curve through 2^48 cells, interleaved (Skilling's transposition [Ski04]).
std::uint64_t hilbert_code(std::array<std::uint32_t, 3> x) {
  constexpr std::uint32_t top = 1u << 15;
  for (std::uint32_t bit = top; bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t swapped = (x[0] ^ x[c]) & below;
      const std::uint32_t invert = x[c] & bit ? below : 0, exchange = x[c] & bit ? 0 : swapped;
      x[0] ^= invert | exchange;
      x[c] ^= exchange;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t flip = 0;
  for (std::uint32_t bit = top; bit > 1; bit >>= 1) flip ^= x[2] & bit ? bit - 1 : 0;
  return spread(x[0] ^ flip) << 2 | spread(x[1] ^ flip) << 1 | spread(x[2] ^ flip);
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
  std::array<std::uint32_t, 3> cell{};
  if (std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]))
    for (std::size_t c = 0; c < 3; ++c)
      cell[c] = static_cast<std::uint32_t>(std::clamp((x[c] - low_[c]) * scale_, 0.0, 65535.0));
  return hilbert_code(cell);
}

// A radix sort of 48-bit codes, byte by byte; bytes in which all agree are skipped.
void sort_along_curve(std::vector<HilbertPlace>& places) {
  std::vector<HilbertPlace> other(places.size());
  for (int shift = 0; shift < 48; shift += 8) {
    std::array<std::size_t, 256> begin{};
    for (const HilbertPlace& p : places) ++begin[p.code >> shift & 0xff];
    if (std::find(begin.begin(), begin.end(), places.size()) != begin.end()) continue;
    std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), std::size_t{0});
    for (const HilbertPlace& p : places) other[begin[p.code >> shift & 0xff]++] = p;
    places.swap(other);
  }
}

}  // namespace tenon

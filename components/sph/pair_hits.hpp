// SPDX-License-Identifier: BSD-3-Clause
// The neighbours of one particle that are within the support right now, side by side for vector loops.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/base/wide_pack.hpp"

namespace tenon {

/// Pairs (i, j) nearer than the support of either, in canonical order, padded to whole packs by pairs whose `inside` is
/// 0: i with itself, far away. What a list holds beyond the support leaves no trace, so sums over hits do not know when
/// the list was made.
struct PairHits {
  std::size_t count = 0;  ///< without padding
  std::vector<LocalIndex> j;
  std::vector<double> dx, dy, dz;  ///< x_i - x_j, m
  std::vector<double> squared;     ///< of the distance, m^2
  std::vector<double> h;           ///< mean smoothing length of the pair, m
  std::vector<double> inside;      ///< 1, or 0 in the padding

  std::size_t padded() const { return padded_to_pack(count); }

  /// Finds the hits of particle i among its candidates. `x` has three values a particle, `length` one.
  void find(std::size_t i, std::span<const LocalIndex> candidates, const double* x, const double* length,
            double support) {
    reserve(candidates.size() + wide_pack_width);
    const double xi = x[3 * i], yi = x[3 * i + 1], zi = x[3 * i + 2], hi = length[i];
    std::size_t n = 0;
    for (const LocalIndex candidate : candidates) {
      const auto k = static_cast<std::size_t>(candidate);
      const double a = xi - x[3 * k], b = yi - x[3 * k + 1], c = zi - x[3 * k + 2];
      const double hk = length[k], reach = support * (hi > hk ? hi : hk), r2 = a * a + b * b + c * c;
      j[n] = candidate, dx[n] = a, dy[n] = b, dz[n] = c, squared[n] = r2, h[n] = 0.5 * (hi + hk);
      n += r2 < reach * reach ? 1 : 0;
    }
    count = n;
    for (; n < padded(); ++n) {
      j[n] = static_cast<LocalIndex>(i), dx[n] = dy[n] = dz[n] = 0, inside[n] = 0;
      squared[n] = 4 * support * support * hi * hi, h[n] = hi;
    }
    for (std::size_t m = 0; m < count; ++m) inside[m] = 1;
  }

 private:
  void reserve(std::size_t size) {
    if (j.size() >= size) return;
    j.resize(size);
    for (std::vector<double>* const array : {&dx, &dy, &dz, &squared, &h, &inside}) array->resize(size);
  }
};

}  // namespace tenon

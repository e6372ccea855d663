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
    reserve(candidates.size() + 2 * wide_pack_width);
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
    pad(i, hi, support);
  }

  /// The same, eight candidates at a time, from records of x, y, z and h. With `equal_lengths`, all h are the same and
  /// `h` and `inside` are left alone. Whole packs of candidates are read: NeighbourLists allows that.
  template <bool equal_lengths>
  TENON_KERNEL void find(std::size_t i, std::span<const LocalIndex> candidates, const double* places, double support) {
    reserve(candidates.size() + 2 * wide_pack_width);
    const double hi = places[4 * i + 3];
    const WidePack xi = broadcast<WidePack>(places[4 * i]), yi = broadcast<WidePack>(places[4 * i + 1]),
                   zi = broadcast<WidePack>(places[4 * i + 2]);
    const WidePack reach_i = broadcast<WidePack>(support * hi * (support * hi));
    const std::size_t size = candidates.size();
    LocalIndex* const to = j.data();
    double *const to_x = dx.data(), *const to_y = dy.data(), *const to_z = dz.data(),
                  *const to_squared = squared.data(), *const to_h = h.data();
    std::size_t n = 0;
    for (std::size_t first = 0; first < size; first += wide_pack_width) {
      const LocalIndex* const at = candidates.data() + first;
      WidePack x, y, z, hj;
      gather(places, 4, at, x, y, z, hj);
      const WidePack a = xi - x, b = yi - y, c = zi - z, r2 = a * a + b * b + c * c;
      WidePack reach = reach_i;
      if constexpr (!equal_lengths) {
        const WidePack reach_j = (support * hj) * (support * hj);
        reach = greater_of<WidePack>(reach_i, reach_j);
      }
      unsigned chosen = where_less(r2, reach);
      if (size - first < wide_pack_width) chosen &= (1u << (size - first)) - 1;
      store_chosen(to + n, at, chosen);
      store_chosen(to_x + n, a, chosen);
      store_chosen(to_y + n, b, chosen);
      store_chosen(to_z + n, c, chosen);
      store_chosen(to_squared + n, r2, chosen);
      if constexpr (!equal_lengths) store_chosen(to_h + n, 0.5 * (hi + hj), chosen);
      n += static_cast<std::size_t>(__builtin_popcount(chosen));
    }
    count = n;
    if constexpr (!equal_lengths) {
      pad(i, hi, support);
    } else {
      const WidePack far = broadcast<WidePack>(4 * support * support * hi * hi), none{};
      store(&squared[n], far), store(&dx[n], none), store(&dy[n], none), store(&dz[n], none);
      for (int l = 0; l < wide_pack_width; ++l) j[n + static_cast<std::size_t>(l)] = static_cast<LocalIndex>(i);
    }
  }

 private:
  void pad(std::size_t i, double hi, double support) {
    for (std::size_t n = count; n < padded(); ++n) {
      j[n] = static_cast<LocalIndex>(i), dx[n] = dy[n] = dz[n] = 0, inside[n] = 0;
      squared[n] = 4 * support * support * hi * hi, h[n] = hi;
    }
    for (std::size_t m = 0; m < count; ++m) inside[m] = 1;
  }
  void reserve(std::size_t size) {
    if (j.size() >= size) return;
    j.resize(size);
    for (std::vector<double>* const array : {&dx, &dy, &dz, &squared, &h, &inside}) array->resize(size);
  }
};

}  // namespace tenon

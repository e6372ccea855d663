// SPDX-License-Identifier: BSD-3-Clause
// The Hilbert curve through a box, along which neighbours stay near each other.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "framework/base/box.hpp"
#include "framework/base/types.hpp"

namespace tenon {

/// Room for orders that are worked out again and again: it grows and stays.
struct CurveRoom {
  std::vector<std::uint64_t> codes, keys, other;
};

/// The curve through 2^48 cubic cells over a box. Unlike Morton's it does not jump, so neighbours along it make compact
/// groups.
class HilbertCurve {
 public:
  explicit HilbertCurve(const Box& bounds);
  /// Points outside count as on the bounds; those that are not finite come first.
  std::uint64_t code(const Vec3& x) const;
  /// The points point(i), i < count, in order along the curve; those in the same cell stay in their order.
  template <typename Point>
  std::vector<LocalIndex> order(std::size_t count, Point&& point) const {
    CurveRoom room;
    std::vector<LocalIndex> result;
    order(count, point, room, result);
    return result;
  }
  /// The same, stored in `result`.
  template <typename Point>
  void order(std::size_t count, Point&& point, CurveRoom& room, std::vector<LocalIndex>& result) const;

 private:
  /// Cells of eight points, coordinate by coordinate.
  using EightCells = std::array<std::array<std::uint32_t, 8>, 3>;
  static void codes_of(const EightCells& cells, std::array<std::uint64_t, 8>& codes);
  static bool is_finite(const Vec3& x) { return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]); }
  std::uint32_t cell(const Vec3& x, std::size_t c) const {
    const double t = (x[c] - low_[c]) * scale_;
    return t > 0 ? static_cast<std::uint32_t>(std::min(t, 65535.0)) : 0;  // 0 for what is not a number
  }

  Vec3 low_{};
  double scale_ = 0;
};

/// Indices of `room.codes` in ascending order; equal ones stay in their order.
void order_of_codes(CurveRoom& room, std::vector<LocalIndex>& order);

template <typename Point>
void HilbertCurve::order(std::size_t count, Point&& point, CurveRoom& room, std::vector<LocalIndex>& result) const {
  room.codes.resize(count);
  EightCells cells{};
  std::array<std::uint64_t, 8> eight;
  for (std::size_t first = 0; first < count; first += 8) {
    const std::size_t here = std::min<std::size_t>(8, count - first);
    for (std::size_t k = 0; k < here; ++k) {
      const Vec3 x = point(first + k);
      const bool finite = is_finite(x);
      for (std::size_t c = 0; c < 3; ++c) cells[c][k] = finite ? cell(x, c) : 0;
    }
    codes_of(cells, eight);
    std::copy_n(eight.begin(), here, room.codes.begin() + static_cast<std::ptrdiff_t>(first));
  }
  order_of_codes(room, result);
}

}  // namespace tenon

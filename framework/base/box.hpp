// SPDX-License-Identifier: BSD-3-Clause
// Axis-aligned boxes.
#pragma once

#include <algorithm>
#include <limits>

#include "framework/base/types.hpp"

namespace tenon {

/// Closed box; empty when made without arguments.
struct Box {
  Vec3 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
           std::numeric_limits<double>::infinity()};
  Vec3 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
            -std::numeric_limits<double>::infinity()};

  void add(const Vec3& p) {
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], p[c]);
      high[c] = std::max(high[c], p[c]);
    }
  }
  void add(const Box& b) {
    add(b.low);
    add(b.high);
  }
  void inflate(double by) {
    for (int c = 0; c < 3; ++c) {
      low[c] -= by;
      high[c] += by;
    }
  }
  bool empty() const { return !(low[0] <= high[0]); }
  bool contains(const Vec3& p) const {
    return low[0] <= p[0] && p[0] <= high[0] && low[1] <= p[1] && p[1] <= high[1] && low[2] <= p[2] && p[2] <= high[2];
  }
  bool overlaps(const Box& b) const {
    return low[0] <= b.high[0] && b.low[0] <= high[0] && low[1] <= b.high[1] && b.low[1] <= high[1] &&
           low[2] <= b.high[2] && b.low[2] <= high[2];
  }
  double diagonal() const { return empty() ? 0.0 : norm(high - low); }
  /// Distance from a point to the box, 0 inside.
  double distance(const Vec3& p) const {
    Vec3 d{};
    for (int c = 0; c < 3; ++c) d[c] = std::max({low[c] - p[c], 0.0, p[c] - high[c]});
    return norm(d);
  }
};

}  // namespace tenon

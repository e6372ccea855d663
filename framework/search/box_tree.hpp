// SPDX-License-Identifier: BSD-3-Clause
// Local search among boxes: a packed tree over boxes sorted along a space-filling curve. Serves transfer, contact and
// particles.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "framework/base/box.hpp"
#include "framework/base/types.hpp"

namespace tenon {

/// An implicit tree of fixed fan-out over boxes sorted along the Hilbert curve of their centres [KF93]; flat arrays, no
/// pointers. Boxes may differ in size by any factor, coincide, or be points. A box with a coordinate that is not a
/// number is never found. Queries may run in several threads at once and allocate nothing but room in `found`.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::span<const Box> boxes) { build(boxes); }

  /// Rebuilds for new boxes.
  void build(std::span<const Box> boxes);
  LocalIndex size() const { return static_cast<LocalIndex>(order_.size()); }
  std::int64_t memory() const {
    return static_cast<std::int64_t>(order_.capacity() * sizeof(LocalIndex) + boxes_.capacity() * sizeof(Box) +
                                     groups_.capacity() * sizeof(Group));
  }

  /// Indices of all boxes that contain the point, appended in no particular order.
  void containing(const Vec3& point, std::vector<LocalIndex>& found) const;
  /// The same boxes elsewhere: the order in the tree stays, its bounds follow. Right for any motion, and as fast to
  /// search as long as neighbours stay neighbours.
  void refit(std::span<const Box> boxes);

  /// Indices of all boxes that overlap the box, appended in no particular order.
  void overlapping(const Box& box, std::vector<LocalIndex>& found) const;

  /// Leaves (each of up to eight boxes) that overlap the box, appended in no particular order: what points of that box
  /// may be in, found once for all of them.
  void leaves_overlapping(const Box& box, std::vector<LocalIndex>& leaves) const;
  /// A point as leaves compare it.
  struct LeafPoint {
    std::array<float, 3> low, high;
  };
  LeafPoint leaf_point(const Vec3& point) const;
  /// Bit k is set if the point is in box k of the leaf, or beside it by the rounding of floats.
  unsigned hits(LocalIndex leaf, const LeafPoint& point) const;
  LocalIndex in_leaf(LocalIndex leaf, int k) const {
    return order_[static_cast<std::size_t>(fan_out) * static_cast<std::size_t>(leaf) + static_cast<std::size_t>(k)];
  }

  /// Visits boxes, the nearer branch first: calls `distance(index)`, which returns the true distance from the point
  /// to what is in that box, only where the box is nearer than, or exactly as near as, the best so far; so every
  /// item at the least distance is visited. ("As near" allows for round-off: 1e-14 of the distance and of the
  /// coordinates.) Boxes farther than `limit` are not visited. Returns the least distance, or infinity if nothing was
  /// found within `limit`.
  template <typename Distance>
  double nearest(const Vec3& point, double limit, Distance&& distance) const;

 private:
  static constexpr int fan_out = 8;
  static constexpr int max_levels = 11;  // 8^11 > 2^31
  /// Eight numbers that are compared and added at once.
  typedef float Eight __attribute__((vector_size(fan_out * sizeof(float))));
  /// Eight children, coordinate by coordinate, relative to the origin, rounded outward; those that are not there are
  /// empty.
  struct Group {
    Eight low[3], high[3];
  };
  struct FloatBox {
    std::array<float, 3> low, high;
  };
  struct Candidate {
    double distance;  // from the point to the box of the child, never too great
    int level;
    LocalIndex child;
  };

  const Group& group(int level, LocalIndex child) const {
    return groups_[level_begin_[static_cast<std::size_t>(level)] + static_cast<std::size_t>(child)];
  }
  FloatBox rounded_outward(const Box& box) const;
  static void overlaps(const Group& group, const FloatBox& box, std::uint64_t& hits);
  static void squared_distances(const Group& group, const FloatBox& point, Eight& squared);
  template <int lowest, typename Hit>
  void visit_overlapping(const Box& box, Hit&& hit) const;
  void fill_groups();

  std::vector<LocalIndex> order_;  // sorted position -> caller's index
  std::vector<Box> boxes_;         // in the caller's order
  /// Level by level. Group g of level 0 holds the sorted boxes 8g .. 8g+7; child c of a group of level n > 0 is the
  /// group c of level n-1. The top level has one group.
  std::vector<Group> groups_;
  std::array<std::size_t, max_levels> level_begin_{};
  int levels_ = 0;
  Vec3 origin_{};  // floats hold what is relative to it, so that they resolve bodies far from zero
};

inline BoxTree::LeafPoint BoxTree::leaf_point(const Vec3& point) const {
  // A little more than the rounding, either way.
  constexpr float unit = 1.5f * std::numeric_limits<float>::epsilon(), least = std::numeric_limits<float>::denorm_min();
  LeafPoint result;
  for (std::size_t c = 0; c < 3; ++c) {
    const float f = static_cast<float>(point[c] - origin_[c]), round = std::abs(f) * unit + least;
    result.low[c] = f - round, result.high[c] = f + round;
  }
  return result;
}

inline unsigned BoxTree::hits(LocalIndex leaf, const LeafPoint& point) const {
  const Group& g = groups_[static_cast<std::size_t>(leaf)];
  const auto in = (g.low[0] <= point.high[0]) & (g.high[0] >= point.low[0]) & (g.low[1] <= point.high[1]) &
                  (g.high[1] >= point.low[1]) & (g.low[2] <= point.high[2]) & (g.high[2] >= point.low[2]);
#ifdef __AVX__
  return static_cast<unsigned>(__builtin_ia32_movmskps256(std::bit_cast<Eight>(in)));
#else
  unsigned mask = 0;
  for (int k = 0; k < fan_out; ++k) mask |= in[k] ? 1u << k : 0u;
  return mask;
#endif
}

inline void BoxTree::squared_distances(const Group& group, const FloatBox& point, Eight& squared) {
  squared = Eight{};
  for (std::size_t c = 0; c < 3; ++c) {
    const Eight below = group.low[c] - point.high[c], above = point.low[c] - group.high[c];
    const Eight greater = below > above ? below : above;
    const Eight apart = greater > 0 ? greater : Eight{};
    squared += apart * apart;
  }
}

template <typename Distance>
double BoxTree::nearest(const Vec3& point, double limit, Distance&& distance) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double greatest_float = static_cast<double>(std::numeric_limits<float>::max());
  constexpr double slack = 1e-14;
  if (!(point[0] == point[0] && point[1] == point[1] && point[2] == point[2])) return infinity;
  const FloatBox query = rounded_outward({point, point});
  const double extent = std::max({std::abs(point[0]), std::abs(point[1]), std::abs(point[2])});
  double best = infinity, reach = 0;
  const auto shorten = [&](double to) {
    reach = std::min(to + slack * (to + extent), std::numeric_limits<double>::max());
  };
  shorten(limit);

  std::array<Candidate, fan_out * max_levels> stack;
  std::size_t waiting = 0;
  if (levels_ > 0) stack[waiting++] = {0.0, levels_ - 1, 0};
  while (waiting > 0) {
    const Candidate here = stack[--waiting];
    if (!(here.distance <= reach)) continue;
    if (here.level < 0) {
      const LocalIndex index = order_[static_cast<std::size_t>(here.child)];
      if (!(boxes_[static_cast<std::size_t>(index)].distance(point) <= reach)) continue;
      const double d = distance(index);
      if (d < best) {
        best = d;
        if (best < limit) shorten(best);
      }
      continue;
    }
    const Group& children = group(here.level, here.child);
    Eight squared;
    squared_distances(children, query, squared);
    const std::size_t first = waiting;
    for (int k = 0; k < fan_out; ++k) {
      // Less by more than the rounding of the floats; distances beyond their range count as its end.
      const double d = 0.999999 * std::sqrt(std::min(static_cast<double>(squared[k]), greatest_float));
      if (!(d <= reach) || !(children.low[0][k] <= children.high[0][k])) continue;
      std::size_t place = waiting++;  // the nearest goes on top
      for (; place > first && stack[place - 1].distance < d; --place) stack[place] = stack[place - 1];
      stack[place] = {d, here.level - 1, fan_out * here.child + k};
    }
  }
  return best <= limit ? best : infinity;
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Boxes in eights along a space-filling curve, in floats that are compared eight at a time, and the boxes around them.
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
#include "framework/base/hilbert.hpp"
#include "framework/base/types.hpp"

namespace tenon {

/// An implicit tree of fixed fan-out over boxes sorted along the Hilbert curve of their centres [KF93]; flat arrays, no
/// pointers. A box that is empty or has a coordinate that is not a number overlaps nothing.
class PackedBoxes {
 public:
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
  /// Bounds of all centres that are finite.
  static Box bounds_of_centres(std::span<const Box> boxes);
  /// Bounds, about, of most finite centres of two sets, by a sample: what few boxes far away do not stretch.
  static Box bounds_of_most(std::span<const Box> first, std::span<const Box> second);
  static Vec3 centre(const Box& box);

  /// Sorts the boxes along the curve through these bounds. Floats hold what is relative to the bounds' centre, so that
  /// they resolve bodies far from zero. Allocates nothing once all has grown.
  void build(std::span<const Box> boxes, const Box& bounds, CurveRoom& room);
  /// The same boxes elsewhere: the order stays.
  void refit(std::span<const Box> boxes);
  /// Groups with one child on top, until there are that many levels.
  void raise(int levels);

  std::size_t size() const { return order_.size(); }
  int levels() const { return levels_; }
  /// Group g of level 0 holds the sorted boxes 8g .. 8g+7; child c of a group of level n > 0 is the group c of level
  /// n-1. The top level has one group.
  const Group& group(int level, LocalIndex child) const {
    return groups_[level_begin_[static_cast<std::size_t>(level)] + static_cast<std::size_t>(child)];
  }
  /// Sorted position -> caller's index.
  LocalIndex index(std::size_t sorted) const { return order_[sorted]; }
  const LocalIndex* indices_of_leaf(LocalIndex leaf) const { return order_.data() + fan_out * std::size_t(leaf); }
  const Vec3& origin() const { return origin_; }
  FloatBox rounded_outward(const Box& box) const;
  std::int64_t memory() const {
    return static_cast<std::int64_t>(order_.capacity() * sizeof(LocalIndex) + groups_.capacity() * sizeof(Group));
  }

  /// All ones in the lanes of children that overlap the box from `low` to `high`.
  template <typename Low, typename High>
  static auto overlap(const Group& group, const Low& low, const High& high) {
    return (group.low[0] <= high[0]) & (group.high[0] >= low[0]) & (group.low[1] <= high[1]) &
           (group.high[1] >= low[1]) & (group.low[2] <= high[2]) & (group.high[2] >= low[2]);
  }
  /// Bit k is set if the sign of lane k is, as in lanes that are all ones.
  template <typename Lanes>
  static unsigned bits(const Lanes& signs) {
#ifdef __AVX__
    return static_cast<unsigned>(__builtin_ia32_movmskps256(std::bit_cast<Eight>(signs)));
#else
    unsigned mask = 0;
    for (int k = 0; k < fan_out; ++k) mask |= std::signbit(std::bit_cast<Eight>(signs)[k]) ? 1u << k : 0u;
    return mask;
#endif
  }

 private:
  void fetch(std::span<const Box> boxes, std::size_t first, std::size_t count) const;
  void fill_leaves(std::span<const Box> boxes);
  void fill_upper_levels();

  std::vector<LocalIndex> order_;
  std::vector<Group> groups_;  // level by level
  std::array<std::size_t, max_levels + 1> level_begin_{};
  int levels_ = 0;
  Vec3 origin_{};
};

}  // namespace tenon

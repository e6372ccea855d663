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
#include "framework/search/packed_boxes.hpp"

namespace tenon {

/// A packed tree over boxes. Boxes may differ in size by any factor, coincide, or be points. A box that is empty or has
/// a coordinate that is not a number is never found. Queries may run in several threads at once and allocate nothing
/// but room in `found`.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::span<const Box> boxes) { build(boxes); }

  /// Rebuilds for new boxes.
  void build(std::span<const Box> boxes);
  LocalIndex size() const { return static_cast<LocalIndex>(packed_.size()); }
  std::int64_t memory() const { return packed_.memory() + static_cast<std::int64_t>(boxes_.capacity() * sizeof(Box)); }

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
  LocalIndex in_leaf(LocalIndex leaf, int k) const { return packed_.indices_of_leaf(leaf)[k]; }

  /// Visits boxes, the nearer branch first: calls `distance(index)`, which returns the true distance from the point
  /// to what is in that box, only where the box is nearer than, or exactly as near as, the best so far; so every
  /// item at the least distance is visited. ("As near" allows for round-off: 1e-14 of the distance and of the
  /// coordinates.) Boxes farther than `limit` are not visited. Returns the least distance, or infinity if nothing was
  /// found within `limit`.
  template <typename Distance>
  double nearest(const Vec3& point, double limit, Distance&& distance) const;

 private:
  static constexpr int fan_out = PackedBoxes::fan_out, max_levels = PackedBoxes::max_levels;
  using Eight = PackedBoxes::Eight;
  using Group = PackedBoxes::Group;
  using FloatBox = PackedBoxes::FloatBox;
  struct Candidate {
    double distance;  // from the point to the box of the child, never too great
    int level;
    LocalIndex child;
  };

  static void overlaps(const Group& group, const FloatBox& box, std::uint64_t& hits);
  static void squared_distances(const Group& group, const FloatBox& point, Eight& squared);
  template <int lowest, typename Hit>
  void visit_overlapping(const Box& box, Hit&& hit) const;

  std::vector<Box> boxes_;  // in the caller's order
  PackedBoxes packed_;
};

inline BoxTree::LeafPoint BoxTree::leaf_point(const Vec3& point) const {
  // A little more than the rounding, either way.
  constexpr float unit = 1.5f * std::numeric_limits<float>::epsilon(), least = std::numeric_limits<float>::denorm_min();
  LeafPoint result;
  for (std::size_t c = 0; c < 3; ++c) {
    const float f = static_cast<float>(point[c] - packed_.origin()[c]), round = std::abs(f) * unit + least;
    result.low[c] = f - round, result.high[c] = f + round;
  }
  return result;
}

inline unsigned BoxTree::hits(LocalIndex leaf, const LeafPoint& point) const {
  return PackedBoxes::bits(PackedBoxes::overlap(packed_.group(0, leaf), point.low, point.high));
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
  const FloatBox query = packed_.rounded_outward({point, point});
  const double extent = std::max({std::abs(point[0]), std::abs(point[1]), std::abs(point[2])});
  double best = infinity, reach = 0;
  const auto shorten = [&](double to) {
    reach = std::min(to + slack * (to + extent), std::numeric_limits<double>::max());
  };
  shorten(limit);

  std::array<Candidate, fan_out * max_levels> stack;
  std::size_t waiting = 0;
  if (packed_.levels() > 0) stack[waiting++] = {0.0, packed_.levels() - 1, 0};
  while (waiting > 0) {
    const Candidate here = stack[--waiting];
    if (!(here.distance <= reach)) continue;
    if (here.level < 0) {
      const LocalIndex index = packed_.index(static_cast<std::size_t>(here.child));
      if (!(boxes_[static_cast<std::size_t>(index)].distance(point) <= reach)) continue;
      const double d = distance(index);
      if (d < best) {
        best = d;
        if (best < limit) shorten(best);
      }
      continue;
    }
    const Group& children = packed_.group(here.level, here.child);
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

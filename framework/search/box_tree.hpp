// SPDX-License-Identifier: BSD-3-Clause
// Local search among boxes: a packed tree over Morton-sorted boxes. Serves transfer, contact and particles.
#pragma once

#include <span>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/base/box.hpp"

namespace tenon {

/// An implicit tree of fixed fan-out over boxes sorted by the Morton code of their centres; flat arrays, no
/// pointers. Boxes may differ in size by any factor, coincide, or be points.
class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(std::span<const Box> boxes) { build(boxes); }

  /// Rebuilds for new boxes.
  void build(std::span<const Box> boxes);
  LocalIndex size() const { return count_; }

  /// Indices of all boxes that contain the point, appended in no particular order.
  void containing(const Vec3& point, std::vector<LocalIndex>& found) const;
  /// Indices of all boxes that overlap the box, appended in no particular order.
  void overlapping(const Box& box, std::vector<LocalIndex>& found) const;

  /// Visits boxes in order of nearness: calls `distance(index)`, which returns the true distance from the point
  /// to what is in that box, only where the box is nearer than, or exactly as near as, the best so far; so every
  /// item at the least distance is visited. Returns the least distance (infinity if there are no boxes).
  template <typename Distance>
  double nearest(const Vec3& point, double limit, Distance&& distance) const;

 private:
  static constexpr int fan_out = 8;
  struct Node {
    Box box;
  };
  LocalIndex count_ = 0;
  std::vector<LocalIndex> order_;        // sorted position -> caller's index
  std::vector<Node> nodes_;              // level by level, leaves first
  std::vector<LocalIndex> level_begin_;  // first node of each level; level 0 = one node per box
};

}  // namespace tenon

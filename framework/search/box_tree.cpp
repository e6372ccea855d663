// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/box_tree.hpp"

#include <bit>
#include <cstdint>

namespace tenon {

void BoxTree::build(std::span<const Box> boxes) {
  boxes_.assign(boxes.begin(), boxes.end());
  CurveRoom room;
  packed_.build(boxes, PackedBoxes::bounds_of_centres(boxes), room);
}

void BoxTree::refit(std::span<const Box> boxes) {
  boxes_.assign(boxes.begin(), boxes.end());
  packed_.refit(boxes);
}

// Sets byte k of `hits` to 0xff if child k overlaps, else to 0.
void BoxTree::overlaps(const Group& group, const FloatBox& box, std::uint64_t& hits) {
  typedef std::int8_t EightBytes __attribute__((vector_size(fan_out)));
  const auto together = PackedBoxes::overlap(group, box.low, box.high);
  hits = std::bit_cast<std::uint64_t>(__builtin_convertvector(together, EightBytes));
}

// Visits the children of groups of the lowest level that is asked for.
template <int lowest, typename Hit>
void BoxTree::visit_overlapping(const Box& box, Hit&& hit) const {
  if (packed_.levels() == 0) return;
  if (packed_.levels() <= lowest) return hit(std::size_t{0});
  const FloatBox query = packed_.rounded_outward(box);
  // One entry per level: the group under visit and which of its children are still to come.
  std::array<LocalIndex, max_levels> visited;
  std::array<std::uint64_t, max_levels> left;
  int level = packed_.levels() - 1;
  visited[static_cast<std::size_t>(level)] = 0;
  overlaps(packed_.group(level, 0), query, left[static_cast<std::size_t>(level)]);
  while (level < packed_.levels()) {
    const auto l = static_cast<std::size_t>(level);
    if (left[l] == 0) {
      ++level;
      continue;
    }
    const int bit = std::countr_zero(left[l]);
    left[l] &= ~(std::uint64_t{0xff} << bit);
    const LocalIndex child = fan_out * visited[l] + bit / 8;
    if (level == lowest) {
      hit(static_cast<std::size_t>(child));
      continue;
    }
    --level;
    visited[l - 1] = child;
    overlaps(packed_.group(level, child), query, left[l - 1]);
  }
}

void BoxTree::containing(const Vec3& point, std::vector<LocalIndex>& found) const {
  visit_overlapping<0>(Box{point, point}, [&](std::size_t sorted) {
    if (boxes_[static_cast<std::size_t>(packed_.index(sorted))].contains(point)) found.push_back(packed_.index(sorted));
  });
}

void BoxTree::overlapping(const Box& box, std::vector<LocalIndex>& found) const {
  visit_overlapping<0>(box, [&](std::size_t sorted) {
    if (boxes_[static_cast<std::size_t>(packed_.index(sorted))].overlaps(box)) found.push_back(packed_.index(sorted));
  });
}

void BoxTree::leaves_overlapping(const Box& box, std::vector<LocalIndex>& leaves) const {
  visit_overlapping<1>(box, [&](std::size_t leaf) { leaves.push_back(static_cast<LocalIndex>(leaf)); });
}

}  // namespace tenon

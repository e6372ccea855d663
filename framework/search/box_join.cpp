// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/box_join.hpp"

#include <bit>
#include <cmath>

namespace tenon {

namespace {

constexpr int eight = PackedBoxes::fan_out;

// Bits 8 k + i for i < k: of the pairs in one leaf, each once.
constexpr std::uint64_t below_diagonal = [] {
  std::uint64_t bits = 0;
  for (int k = 0; k < eight; ++k)
    for (int i = 0; i < k; ++i) bits |= std::uint64_t{1} << (eight * k + i);
  return bits;
}();

using Eight = PackedBoxes::Eight;

/// By how much each of the first boxes overlaps box k of the second group, in the direction in which that is least;
/// negative if they are apart. Numbers that touch have the difference +0, so the sign tells.
[[gnu::always_inline]] inline Eight depths(const PackedBoxes::Group& a, const PackedBoxes::Group& b, int k) {
  const auto lesser = [](const Eight& x, const Eight& y) { return x < y ? x : y; };
  const auto along = [&](std::size_t c) { return lesser(a.high[c] - b.low[c][k], b.high[c][k] - a.low[c]); };
  return lesser(lesser(along(0), along(1)), along(2));
}

/// Bit 8 k + i is set if box i of the first group overlaps box k of the second.
[[gnu::always_inline]] inline std::uint64_t overlaps(const PackedBoxes::Group& a, const PackedBoxes::Group& b) {
  std::uint64_t apart = 0;
#pragma GCC unroll 8
  for (int k = 0; k < eight; ++k) apart |= std::uint64_t{PackedBoxes::bits(depths(a, b, k))} << (eight * k);
  return ~apart;
}

/// The same, and those that overlap by less than the margin.
[[gnu::always_inline]] inline std::uint64_t overlaps(const PackedBoxes::Group& a, const PackedBoxes::Group& b,
                                                     float margin, std::uint64_t& doubtful) {
  std::uint64_t apart = 0, little = 0;
#pragma GCC unroll 8
  for (int k = 0; k < eight; ++k) {
    const Eight depth = depths(a, b, k);
    apart |= std::uint64_t{PackedBoxes::bits(depth)} << (eight * k);
    little |= std::uint64_t{PackedBoxes::bits(depth - margin)} << (eight * k);
  }
  doubtful = little & ~apart;
  return ~apart;
}

// The greatest coordinate of all boxes, or infinity.
float extent(const PackedBoxes& packed) {
  float greatest = 0;
  if (packed.levels() == 0) return greatest;
  const PackedBoxes::Group& top = packed.group(packed.levels() - 1, 0);
  for (int k = 0; k < eight; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      if (top.low[c][k] <= top.high[c][k])
        greatest = std::max({greatest, std::abs(top.low[c][k]), std::abs(top.high[c][k])});
  return greatest;
}

}  // namespace

void BoxJoin::build(std::span<const Box> first, std::span<const Box> second) {
  const Box bounds = PackedBoxes::bounds_of_most(first, second);
  boxes_[0] = first, boxes_[1] = second, second_ = &packed_[1];
  packed_[0].build(first, bounds, room_);
  packed_[1].build(second, bounds, room_);
  const int levels = std::max(packed_[0].levels(), packed_[1].levels());
  for (PackedBoxes& packed : packed_) packed.raise(levels);
  margin_ = 6 * std::numeric_limits<float>::epsilon() * std::max(extent(packed_[0]), extent(packed_[1])) +
            8 * std::numeric_limits<float>::denorm_min();
}

void BoxJoin::build(std::span<const Box> boxes) {
  boxes_[0] = boxes_[1] = boxes, second_ = &packed_[0];
  packed_[0].build(boxes, PackedBoxes::bounds_of_most(boxes, {}), room_);
  margin_ =
      6 * std::numeric_limits<float>::epsilon() * extent(packed_[0]) + 8 * std::numeric_limits<float>::denorm_min();
}

void BoxJoin::visit_pairs(const Visit& visit) {
  tests_ = 0;
  if (packed_[0].levels() == 0 || second_->levels() == 0) return;
  visit_ = &visit;
  meet(packed_[0].levels() - 1, 0, 0);
  flush();
}

void BoxJoin::find_pairs(std::vector<Pair>& pairs) {
  pairs.clear();
  visit_pairs([&](std::span<const Pair> some) { pairs.insert(pairs.end(), some.begin(), some.end()); });
}

// Groups a of the first and b of the second tree, of the same level. Of one tree with itself: a <= b.
void BoxJoin::meet(int level, LocalIndex a, LocalIndex b) {
  if (level == 0) return meet_leaves(a, b);
  tests_ += fan_out * fan_out;
  std::uint64_t hits = overlaps(packed_[0].group(level, a), second_->group(level, b));
  if (second_ == &packed_[0] && a == b) {
    constexpr std::uint64_t diagonal = 0x8040201008040201;
    hits &= below_diagonal | diagonal;
  }
  for (; hits != 0; hits &= hits - 1) {
    const int bit = std::countr_zero(hits);
    meet(level - 1, fan_out * a + bit % fan_out, fan_out * b + bit / fan_out);
  }
}

void BoxJoin::meet_leaves(LocalIndex a, LocalIndex b) {
  tests_ += fan_out * fan_out;
  const Group &group_a = packed_[0].group(0, a), &group_b = second_->group(0, b);
  std::uint64_t doubtful = 0, hits = overlaps(group_a, group_b, margin_, doubtful);
  if (second_ == &packed_[0] && a == b) hits &= below_diagonal, doubtful &= below_diagonal;
  if (hits == 0) return;
  const LocalIndex *const index_a = packed_[0].indices_of_leaf(a), *const index_b = second_->indices_of_leaf(b);
  for (; doubtful != 0; doubtful &= doubtful - 1) {
    const int bit = std::countr_zero(doubtful);
    const auto i = static_cast<std::size_t>(index_a[bit % fan_out]),
               k = static_cast<std::size_t>(index_b[bit / fan_out]);
    if (!boxes_[0][i].overlaps(boxes_[1][k])) hits &= ~(std::uint64_t{1} << bit);
  }
  for (; hits != 0; hits &= hits - 1) {
    const int bit = std::countr_zero(hits);
    waiting_[waiting_count_++] = {index_a[bit % fan_out], index_b[bit / fan_out]};
  }
  if (waiting_count_ >= chunk) flush();
}

void BoxJoin::flush() {
  if (waiting_count_ > 0) (*visit_)(std::span<const Pair>(waiting_).first(waiting_count_));
  waiting_count_ = 0;
}

std::int64_t BoxJoin::memory() const {
  return packed_[0].memory() + packed_[1].memory() +
         static_cast<std::int64_t>((room_.codes.capacity() + room_.keys.capacity() + room_.other.capacity()) *
                                   sizeof(std::uint64_t));
}

}  // namespace tenon

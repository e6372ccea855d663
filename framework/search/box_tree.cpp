// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/box_tree.hpp"

#include <bit>
#include <cstdint>

#include "framework/base/hilbert.hpp"

namespace tenon {

namespace {

constexpr float float_infinity = std::numeric_limits<float>::infinity();

/// The float next to f away from zero; zero and infinity stay.
float outward(float f) {
  return f == 0 || !std::isfinite(f) ? f : std::bit_cast<float>(std::bit_cast<std::uint32_t>(f) + 1);
}
/// The float next to f towards zero, which is none of zero and infinity.
float inward(float f) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(f) - 1);
}
constexpr float smallest = std::numeric_limits<float>::denorm_min();

float rounded_down(double x) {
  const float f = static_cast<float>(x);
  if (!(static_cast<double>(f) > x)) return f;
  if (f == 0) return -smallest;
  if (f > std::numeric_limits<float>::max()) return std::numeric_limits<float>::max();
  return f > 0 ? inward(f) : outward(f);
}
float rounded_up(double x) {
  return -rounded_down(-x);
}

bool is_number(const Vec3& x) {
  return x[0] == x[0] && x[1] == x[1] && x[2] == x[2];
}
bool is_number(const Box& box) {
  return is_number(box.low) && is_number(box.high);
}

Vec3 centre(const Box& box) {
  return {0.5 * box.low[0] + 0.5 * box.high[0], 0.5 * box.low[1] + 0.5 * box.high[1],
          0.5 * box.low[2] + 0.5 * box.high[2]};
}

bool is_finite(const Vec3& x) {
  return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]);
}

// Bounds of all centres that are finite.
Box bounds_of_centres(std::span<const Box> boxes) {
  Box bounds;
  for (const Box& box : boxes)
    if (const Vec3 x = centre(box); is_finite(x)) bounds.add(x);
  return bounds;
}

}  // namespace

void BoxTree::build(std::span<const Box> boxes) {
  const Box bounds = bounds_of_centres(boxes);
  origin_ = bounds.empty() ? Vec3{} : centre(bounds);
  const HilbertCurve curve(bounds);
  std::vector<HilbertPlace> codes(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) codes[i] = {curve.code(centre(boxes[i])), static_cast<LocalIndex>(i)};
  sort_along_curve(codes);
  order_.resize(boxes.size());
  boxes_.resize(boxes.size());
  for (std::size_t i = 0; i < codes.size(); ++i) {
    order_[i] = codes[i].index;
    boxes_[i] = boxes[static_cast<std::size_t>(codes[i].index)];
  }
  groups_.clear();
  levels_ = 0;
  if (boxes.empty()) return;

  std::size_t total = 0;
  for (std::size_t count = boxes.size(); levels_ == 0 || count > 1; ++levels_) {
    count = (count + fan_out - 1) / fan_out;
    level_begin_[static_cast<std::size_t>(levels_)] = total;
    total += count;
  }
  Group empty;
  for (std::size_t c = 0; c < 3; ++c) {
    empty.low[c] = Eight{} + float_infinity;
    empty.high[c] = Eight{} - float_infinity;
  }
  groups_.assign(total, empty);
  const auto put = [&](Group& group, std::size_t child, const FloatBox& box) {
    for (std::size_t c = 0; c < 3; ++c) {
      group.low[c][child] = box.low[c];
      group.high[c][child] = box.high[c];
    }
  };
  for (std::size_t i = 0; i < boxes_.size(); ++i)
    if (is_number(boxes_[i])) put(groups_[i / fan_out], i % fan_out, rounded_outward(boxes_[i]));
  for (int level = 1; level < levels_; ++level) {
    const std::size_t below = level_begin_[static_cast<std::size_t>(level - 1)];
    const std::size_t here = level_begin_[static_cast<std::size_t>(level)];
    for (std::size_t child = 0; child < here - below; ++child) {
      const Group& group = groups_[below + child];
      FloatBox box;
      for (std::size_t c = 0; c < 3; ++c) {
        box.low[c] = group.low[c][0];
        box.high[c] = group.high[c][0];
        for (std::size_t k = 1; k < fan_out; ++k) {
          box.low[c] = std::min(box.low[c], group.low[c][k]);
          box.high[c] = std::max(box.high[c], group.high[c][k]);
        }
      }
      put(groups_[here + child / fan_out], child % fan_out, box);
    }
  }
}

// Subtraction rounds monotonically, so what touches still touches.
BoxTree::FloatBox BoxTree::rounded_outward(const Box& box) const {
  FloatBox f;
  for (std::size_t c = 0; c < 3; ++c) {
    f.low[c] = rounded_down(box.low[c] - origin_[c]);
    f.high[c] = rounded_up(box.high[c] - origin_[c]);
  }
  return f;
}

// Sets byte k of `hits` to 0xff if child k overlaps, else to 0.
void BoxTree::overlaps(const Group& group, const FloatBox& box, std::uint64_t& hits) {
  typedef std::int8_t EightBytes __attribute__((vector_size(fan_out)));
  const auto together = (group.low[0] <= box.high[0]) & (group.high[0] >= box.low[0]) & (group.low[1] <= box.high[1]) &
                        (group.high[1] >= box.low[1]) & (group.low[2] <= box.high[2]) & (group.high[2] >= box.low[2]);
  hits = std::bit_cast<std::uint64_t>(__builtin_convertvector(together, EightBytes));
}

template <typename Hit>
void BoxTree::visit_overlapping(const Box& box, Hit&& hit) const {
  if (levels_ == 0) return;
  const FloatBox query = rounded_outward(box);
  // One entry per level: the group under visit and which of its children are still to come.
  std::array<LocalIndex, max_levels> visited;
  std::array<std::uint64_t, max_levels> left;
  int level = levels_ - 1;
  visited[static_cast<std::size_t>(level)] = 0;
  overlaps(group(level, 0), query, left[static_cast<std::size_t>(level)]);
  while (level < levels_) {
    const auto l = static_cast<std::size_t>(level);
    if (left[l] == 0) {
      ++level;
      continue;
    }
    const int bit = std::countr_zero(left[l]);
    left[l] &= ~(std::uint64_t{0xff} << bit);
    const LocalIndex child = fan_out * visited[l] + bit / 8;
    if (level == 0) {
      hit(static_cast<std::size_t>(child));
      continue;
    }
    --level;
    visited[l - 1] = child;
    overlaps(group(level, child), query, left[l - 1]);
  }
}

void BoxTree::containing(const Vec3& point, std::vector<LocalIndex>& found) const {
  visit_overlapping(Box{point, point}, [&](std::size_t sorted) {
    if (boxes_[sorted].contains(point)) found.push_back(order_[sorted]);
  });
}

void BoxTree::overlapping(const Box& box, std::vector<LocalIndex>& found) const {
  visit_overlapping(box, [&](std::size_t sorted) {
    if (boxes_[sorted].overlaps(box)) found.push_back(order_[sorted]);
  });
}

}  // namespace tenon

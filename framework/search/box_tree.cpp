// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/box_tree.hpp"

#include <bit>
#include <cstdint>

#include "framework/base/hilbert.hpp"

namespace tenon {

namespace {

constexpr float float_infinity = std::numeric_limits<float>::infinity();

/// Below x, and above it, by the rounding of floats and a little more.
constexpr float rounding = 1.5f * std::numeric_limits<float>::epsilon();
constexpr float smallest = std::numeric_limits<float>::denorm_min();

float rounded_down(double x) {
  const float f = static_cast<float>(x);
  const float below = f - (std::abs(f) * rounding + smallest);
  return x >= std::numeric_limits<float>::max() ? std::numeric_limits<float>::max() : below;
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
  boxes_.assign(boxes.begin(), boxes.end());
  order_ = HilbertCurve(bounds).order(boxes.size(), [&](std::size_t i) { return centre(boxes[i]); });
  levels_ = 0;
  std::size_t total = 0;
  for (std::size_t count = boxes.size(); count > 0 && (levels_ == 0 || count > 1); ++levels_) {
    count = (count + fan_out - 1) / fan_out;
    level_begin_[static_cast<std::size_t>(levels_)] = total;
    total += count;
  }
  groups_.resize(total);
  fill_groups();
}

void BoxTree::refit(std::span<const Box> boxes) {
  boxes_.assign(boxes.begin(), boxes.end());
  fill_groups();
}

void BoxTree::fill_groups() {
  if (levels_ == 0) return;
  const std::size_t leaves = levels_ > 1 ? level_begin_[1] : 1;
  for (std::size_t g = 0; g < leaves; ++g) {
    Group& group = groups_[g];
    const std::size_t first = g * fan_out, count = std::min<std::size_t>(fan_out, order_.size() - first);
    for (std::size_t k = 0; k < fan_out; ++k) {
      const Box* const box = k < count ? &boxes_[static_cast<std::size_t>(order_[first + k])] : nullptr;
      const bool there = box && is_number(*box);
      const FloatBox rounded = there ? rounded_outward(*box) : FloatBox{};
      for (std::size_t c = 0; c < 3; ++c) {
        group.low[c][k] = there ? rounded.low[c] : float_infinity;
        group.high[c][k] = there ? rounded.high[c] : -float_infinity;
      }
    }
  }
  for (int level = 1; level < levels_; ++level) {
    const std::size_t below = level_begin_[static_cast<std::size_t>(level - 1)];
    const std::size_t here = level_begin_[static_cast<std::size_t>(level)];
    const std::size_t end = level + 1 < levels_ ? level_begin_[static_cast<std::size_t>(level + 1)] : groups_.size();
    for (std::size_t g = here; g < end; ++g)
      for (std::size_t k = 0; k < fan_out; ++k) {
        const std::size_t child = (g - here) * fan_out + k;
        for (std::size_t c = 0; c < 3; ++c) {
          float low = float_infinity, high = -float_infinity;
          if (child < here - below)
            for (std::size_t i = 0; i < fan_out; ++i) {
              low = std::min(low, groups_[below + child].low[c][i]);
              high = std::max(high, groups_[below + child].high[c][i]);
            }
          groups_[g].low[c][k] = low, groups_[g].high[c][k] = high;
        }
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

// Visits the children of groups of the lowest level that is asked for.
template <int lowest, typename Hit>
void BoxTree::visit_overlapping(const Box& box, Hit&& hit) const {
  if (levels_ == 0) return;
  if (levels_ <= lowest) return hit(std::size_t{0});
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
    if (level == lowest) {
      hit(static_cast<std::size_t>(child));
      continue;
    }
    --level;
    visited[l - 1] = child;
    overlaps(group(level, child), query, left[l - 1]);
  }
}

void BoxTree::containing(const Vec3& point, std::vector<LocalIndex>& found) const {
  visit_overlapping<0>(Box{point, point}, [&](std::size_t sorted) {
    if (boxes_[static_cast<std::size_t>(order_[sorted])].contains(point)) found.push_back(order_[sorted]);
  });
}

void BoxTree::overlapping(const Box& box, std::vector<LocalIndex>& found) const {
  visit_overlapping<0>(box, [&](std::size_t sorted) {
    if (boxes_[static_cast<std::size_t>(order_[sorted])].overlaps(box)) found.push_back(order_[sorted]);
  });
}

void BoxTree::leaves_overlapping(const Box& box, std::vector<LocalIndex>& leaves) const {
  visit_overlapping<1>(box, [&](std::size_t leaf) { leaves.push_back(static_cast<LocalIndex>(leaf)); });
}

}  // namespace tenon

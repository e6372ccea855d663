// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/packed_boxes.hpp"

#include <cstring>

namespace tenon {

namespace {

constexpr float float_infinity = std::numeric_limits<float>::infinity();

/// Below x, and above it, by the rounding of floats and a little more. Beyond their range everything counts as its end,
/// so that no box meets one that is not there.
float rounded_down(double x) {
  constexpr float unit = 1.5f * std::numeric_limits<float>::epsilon(), least = std::numeric_limits<float>::denorm_min();
  constexpr float greatest = std::numeric_limits<float>::max();
  const float f = static_cast<float>(std::min(std::max(x, -double{greatest}), double{greatest}));
  return std::max(f - (std::abs(f) * unit + least), -greatest);
}
float rounded_up(double x) {
  return -rounded_down(-x);
}

bool is_finite(const Vec3& x) {
  return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]);
}

/// Eight boxes, coordinate by coordinate.
struct EightBoxes {
  std::array<double, 8> low[3], high[3];
};

// As `rounded_down` and `rounded_up` of each.
void round_outward(const EightBoxes& boxes, const Vec3& origin, PackedBoxes::Group& group) {
  std::array<bool, 8> there;
  for (std::size_t k = 0; k < 8; ++k)
    there[k] = (boxes.low[0][k] <= boxes.high[0][k]) & (boxes.low[1][k] <= boxes.high[1][k]) &
               (boxes.low[2][k] <= boxes.high[2][k]);
  for (std::size_t c = 0; c < 3; ++c) {
    std::array<float, 8> low, high;
    for (std::size_t k = 0; k < 8; ++k) {
      const float down = rounded_down(boxes.low[c][k] - origin[c]), up = rounded_up(boxes.high[c][k] - origin[c]);
      low[k] = there[k] ? down : float_infinity;
      high[k] = there[k] ? up : -float_infinity;
    }
    std::memcpy(&group.low[c], low.data(), sizeof low);
    std::memcpy(&group.high[c], high.data(), sizeof high);
  }
}

float least_of(const PackedBoxes::Eight& x) {
  float least = x[0];
  for (int k = 1; k < PackedBoxes::fan_out; ++k) least = std::min(least, x[k]);
  return least;
}
float greatest_of(const PackedBoxes::Eight& x) {
  float greatest = x[0];
  for (int k = 1; k < PackedBoxes::fan_out; ++k) greatest = std::max(greatest, x[k]);
  return greatest;
}

}  // namespace

Vec3 PackedBoxes::centre(const Box& box) {
  return {0.5 * box.low[0] + 0.5 * box.high[0], 0.5 * box.low[1] + 0.5 * box.high[1],
          0.5 * box.low[2] + 0.5 * box.high[2]};
}

Box PackedBoxes::bounds_of_centres(std::span<const Box> boxes) {
  Box bounds;
  for (const Box& box : boxes)
    if (const Vec3 x = centre(box); is_finite(x)) bounds.add(x);
  return bounds;
}

// The middle nine tenths and four times their extent on either side, but no more than the sample fills.
Box PackedBoxes::bounds_of_most(std::span<const Box> first, std::span<const Box> second) {
  constexpr std::size_t sample_of_set = 512;
  std::array<std::array<double, 2 * sample_of_set>, 3> x;
  std::size_t count = 0;
  for (const std::span<const Box> boxes : {first, second}) {
    const std::size_t stride = (boxes.size() + sample_of_set - 1) / sample_of_set;
    for (std::size_t i = 0; i < boxes.size(); i += stride)
      if (const Vec3 middle = centre(boxes[i]); is_finite(middle)) {
        for (std::size_t c = 0; c < 3; ++c) x[c][count] = middle[c];
        ++count;
      }
  }
  Box bounds;
  if (count == 0) return bounds;
  double extent = 0;
  Box middle;
  for (std::size_t c = 0; c < 3; ++c) {
    std::sort(x[c].begin(), x[c].begin() + static_cast<std::ptrdiff_t>(count));
    middle.low[c] = x[c][count / 20], middle.high[c] = x[c][count - 1 - count / 20];
    extent = std::max(extent, middle.high[c] - middle.low[c]);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    bounds.low[c] = std::max(x[c][0], middle.low[c] - 4 * extent);
    bounds.high[c] = std::min(x[c][count - 1], middle.high[c] + 4 * extent);
  }
  return bounds;
}

void PackedBoxes::build(std::span<const Box> boxes, const Box& bounds, CurveRoom& room) {
  origin_ = bounds.empty() ? Vec3{} : centre(bounds);
  HilbertCurve(bounds).order(
      boxes.size(), [&](std::size_t i) { return centre(boxes[i]); }, room, order_);
  levels_ = 0;
  std::size_t total = 0;
  for (std::size_t count = boxes.size(); count > 0 && (levels_ == 0 || count > 1); ++levels_) {
    count = (count + fan_out - 1) / fan_out;
    level_begin_[static_cast<std::size_t>(levels_)] = total;
    total += count;
  }
  level_begin_[static_cast<std::size_t>(levels_)] = total;
  groups_.resize(total);
  refit(boxes);
}

void PackedBoxes::refit(std::span<const Box> boxes) {
  if (levels_ == 0) return;
  fill_leaves(boxes);
  fill_upper_levels();
}

// Starts to bring boxes from memory.
void PackedBoxes::fetch(std::span<const Box> boxes, std::size_t first, std::size_t count) const {
  for (std::size_t i = first; i < std::min(first + count, order_.size()); ++i) {
    const Box* const next = &boxes[static_cast<std::size_t>(order_[i])];
    __builtin_prefetch(next), __builtin_prefetch(&next->high[2]);
  }
}

void PackedBoxes::fill_leaves(std::span<const Box> boxes) {
  constexpr std::size_t ahead = 32;
  const std::size_t leaves = level_begin_[1], size = order_.size();
  fetch(boxes, 0, ahead);
  for (std::size_t g = 0; g < leaves; ++g) {
    const std::size_t first = g * fan_out, count = std::min<std::size_t>(fan_out, size - first);
    fetch(boxes, first + ahead, fan_out);
    EightBoxes here;
    for (std::size_t k = 0; k < fan_out; ++k) {
      const Box box = k < count ? boxes[static_cast<std::size_t>(order_[first + k])] : Box();
      for (std::size_t c = 0; c < 3; ++c) here.low[c][k] = box.low[c], here.high[c][k] = box.high[c];
    }
    round_outward(here, origin_, groups_[g]);
  }
}

void PackedBoxes::fill_upper_levels() {
  for (int level = 1; level < levels_; ++level) {
    const std::size_t below = level_begin_[static_cast<std::size_t>(level - 1)];
    const std::size_t here = level_begin_[static_cast<std::size_t>(level)];
    const std::size_t end = level_begin_[static_cast<std::size_t>(level + 1)];
    for (std::size_t g = here; g < end; ++g)
      for (std::size_t k = 0; k < fan_out; ++k) {
        const std::size_t child = (g - here) * fan_out + k;
        const bool there = child < here - below;
        for (std::size_t c = 0; c < 3; ++c) {
          groups_[g].low[c][k] = there ? least_of(groups_[below + child].low[c]) : float_infinity;
          groups_[g].high[c][k] = there ? greatest_of(groups_[below + child].high[c]) : -float_infinity;
        }
      }
  }
}

void PackedBoxes::raise(int levels) {
  if (levels_ == 0) return;
  for (; levels_ < levels; ++levels_) {
    const Group& top = groups_.back();
    Group above;
    for (std::size_t c = 0; c < 3; ++c) {
      above.low[c] = Eight{} + float_infinity, above.high[c] = Eight{} - float_infinity;
      above.low[c][0] = least_of(top.low[c]), above.high[c][0] = greatest_of(top.high[c]);
    }
    level_begin_[static_cast<std::size_t>(levels_)] = groups_.size();
    groups_.push_back(above);
    level_begin_[static_cast<std::size_t>(levels_ + 1)] = groups_.size();
  }
}

// Subtraction rounds monotonically, so what touches still touches.
PackedBoxes::FloatBox PackedBoxes::rounded_outward(const Box& box) const {
  FloatBox f;
  for (std::size_t c = 0; c < 3; ++c) {
    f.low[c] = rounded_down(box.low[c] - origin_[c]);
    f.high[c] = rounded_up(box.high[c] - origin_[c]);
  }
  return f;
}

}  // namespace tenon

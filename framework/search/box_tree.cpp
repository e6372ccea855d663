// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/box_tree.hpp"

#include <bit>
#include <cstdint>
#include <numeric>

namespace tenon {

namespace {

constexpr float float_infinity = std::numeric_limits<float>::infinity();

float rounded_down(double x) {
  const float f = static_cast<float>(x);
  return static_cast<double>(f) > x ? std::nextafter(f, -float_infinity) : f;
}
float rounded_up(double x) {
  const float f = static_cast<float>(x);
  return static_cast<double>(f) < x ? std::nextafter(f, float_infinity) : f;
}

bool is_number(const Vec3& x) {
  return x[0] == x[0] && x[1] == x[1] && x[2] == x[2];
}
bool is_number(const Box& box) {
  return is_number(box.low) && is_number(box.high);
}

// Spreads 16 bits, two zeros between each.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 16) & 0x0000ff0000ff;
  x = (x | x << 8) & 0x00f00f00f00f;
  x = (x | x << 4) & 0x0c30c30c30c3;
  return (x | x << 2) & 0x249249249249;
}

struct Coded {
  std::uint64_t code;
  LocalIndex index;
};

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

// Place of a cell on the Hilbert curve through 2^48 cells, interleaved (Skilling's transposition [Ski04]).
std::uint64_t hilbert_code(std::array<std::uint32_t, 3> x) {
  constexpr std::uint32_t top = 1u << 15;
  for (std::uint32_t bit = top; bit > 1; bit >>= 1) {
    const std::uint32_t below = bit - 1;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t swapped = (x[0] ^ x[c]) & below;
      const std::uint32_t invert = x[c] & bit ? below : 0, exchange = x[c] & bit ? 0 : swapped;
      x[0] ^= invert | exchange;
      x[c] ^= exchange;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t flip = 0;
  for (std::uint32_t bit = top; bit > 1; bit >>= 1) flip ^= x[2] & bit ? bit - 1 : 0;
  return spread(x[0] ^ flip) << 2 | spread(x[1] ^ flip) << 1 | spread(x[2] ^ flip);
}

// Hilbert codes of 16 bits a direction in cubic cells; centres that are not finite come first. Unlike Morton's, this
// curve does not jump, so neighbours along it make compact groups.
std::vector<Coded> hilbert_codes(std::span<const Box> boxes, const Box& bounds) {
  double extent = 0;
  if (!bounds.empty())
    for (std::size_t c = 0; c < 3; ++c) extent = std::max(extent, bounds.high[c] - bounds.low[c]);
  const double scale = extent > 0 && std::isfinite(65535 / extent) ? 65535 / extent : 0;
  std::vector<Coded> codes(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Vec3 x = centre(boxes[i]);
    std::array<std::uint32_t, 3> cell{};
    if (is_finite(x))
      for (std::size_t c = 0; c < 3; ++c)
        cell[c] = static_cast<std::uint32_t>(std::clamp((x[c] - bounds.low[c]) * scale, 0.0, 65535.0));
    codes[i] = {hilbert_code(cell), static_cast<LocalIndex>(i)};
  }
  return codes;
}

// Stable radix sort of 48-bit codes, byte by byte; bytes in which all agree are skipped.
void sort_codes(std::vector<Coded>& codes) {
  std::vector<Coded> other(codes.size());
  for (int shift = 0; shift < 48; shift += 8) {
    std::array<std::size_t, 256> begin{};
    for (const Coded& c : codes) ++begin[c.code >> shift & 0xff];
    if (std::find(begin.begin(), begin.end(), codes.size()) != begin.end()) continue;
    std::exclusive_scan(begin.begin(), begin.end(), begin.begin(), std::size_t{0});
    for (const Coded& c : codes) other[begin[c.code >> shift & 0xff]++] = c;
    codes.swap(other);
  }
}

}  // namespace

void BoxTree::build(std::span<const Box> boxes) {
  const Box bounds = bounds_of_centres(boxes);
  origin_ = bounds.empty() ? Vec3{} : centre(bounds);
  std::vector<Coded> codes = hilbert_codes(boxes, bounds);
  sort_codes(codes);
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

// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/search_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenon {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const Box everywhere{{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}};

bool is_finite(const Vec3& x) {
  return std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]);
}

// The nearest point of the bounds.
Vec3 clamped(const Vec3& x, const Box& bounds) {
  Vec3 y;
  for (std::size_t c = 0; c < 3; ++c) y[c] = std::min(std::max(x[c], bounds.low[c]), bounds.high[c]);
  return y;
}

Box bounds_of_all(const Communicator& comm, std::span<const Vec3> points) {
  Box box;
  for (const Vec3& x : points)
    if (is_finite(x)) box.add(x);
  comm.min(box.low);
  comm.max(box.high);
  return box;
}

}  // namespace

bool SearchParts::is_in(const Vec3& x, const Box& part) {
  for (std::size_t c = 0; c < 3; ++c)
    if (!(part.low[c] <= x[c] && (x[c] < part.high[c] || part.high[c] == infinity))) return false;
  return true;
}

bool SearchParts::meets(const Box& box, const Box& part) {
  for (std::size_t c = 0; c < 3; ++c)
    if (!(part.low[c] <= box.high[c] && (box.low[c] < part.high[c] || part.high[c] == infinity))) return false;
  return true;
}

void SearchParts::cut(SearchDecomposition decomposition, std::span<const Vec3> centres,
                      std::span<const double> weights) {
  const auto ranks = static_cast<std::size_t>(count_);
  bounds_ = bounds_of_all(comm_, centres);
  parts_.assign(ranks, Box());
  parts_[0] = everywhere;
  if (!bounds_.empty()) {
    if (decomposition == SearchDecomposition::slices) {
      parts_ = slices(centres, weights);
    } else {
      rcb_.partition_by_sample(centres, weights);
      for (std::size_t r = 0; r < ranks; ++r) parts_[r] = rcb_.part(static_cast<int>(r));
    }
  }
  std::vector<Box> within;
  for (const Box& part : parts_)
    within.push_back(part.empty() || bounds_.empty() ? part
                                                     : Box{clamped(part.low, bounds_), clamped(part.high, bounds_)});
  tree_.build(within);
  last_ = comm_.rank();
}

void SearchParts::ranks_meeting(const Box& box, std::vector<int>& ranks) const {
  ranks.clear();
  const Box& guess = parts_[static_cast<std::size_t>(last_)];
  if (is_in(box.low, guess) && is_in(box.high, guess)) return ranks.push_back(last_);
  const Box within = bounds_.empty() ? box : Box{clamped(box.low, bounds_), clamped(box.high, bounds_)};
  tree_.overlapping(within, ranks);
  std::erase_if(ranks, [&](int r) { return !meets(box, parts_[static_cast<std::size_t>(r)]); });
  std::sort(ranks.begin(), ranks.end());
  if (!ranks.empty()) last_ = ranks.front();
}

// Weights in bins along the longest axis; cuts stand between bins. Sums of whole numbers are the same on all ranks.
std::vector<Box> SearchParts::slices(std::span<const Vec3> centres, std::span<const double> weights) const {
  constexpr std::size_t bins = 1 << 14;
  std::size_t axis = 0;
  for (std::size_t c = 1; c < 3; ++c)
    if (bounds_.high[c] - bounds_.low[c] > bounds_.high[axis] - bounds_.low[axis]) axis = c;
  const double low = bounds_.low[axis], length = bounds_.high[axis] - low;
  std::vector<std::int64_t> weight(bins, 0);
  for (std::size_t i = 0; i < centres.size(); ++i) {
    if (!is_finite(centres[i])) continue;
    const double t = length > 0 ? (centres[i][axis] - low) / length * bins : 0.0;
    weight[std::min(static_cast<std::size_t>(t), bins - 1)] += std::llround(weights[i]);
  }
  comm_.sum(std::span(weight));
  std::int64_t all = 0, below = 0;
  for (const std::int64_t w : weight) all += w;
  const auto ranks = static_cast<std::size_t>(count_);
  std::vector<Box> parts(ranks, everywhere);
  std::size_t part = 0;
  for (std::size_t b = 0; b < bins && part + 1 < ranks; ++b) {
    below += weight[b];
    for (; part + 1 < ranks && below * static_cast<std::int64_t>(ranks) >= all * static_cast<std::int64_t>(part + 1);
         ++part) {
      const double cut = low + length * static_cast<double>(b + 1) / bins;
      parts[part].high[axis] = parts[part + 1].low[axis] = cut;
    }
  }
  return parts;
}

}  // namespace tenon

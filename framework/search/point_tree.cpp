// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/point_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "framework/base/hilbert.hpp"

namespace tenon {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
/// Neighbours kept beyond k before the farthest are thrown out: such a selection costs about as much as scanning this
/// many points.
constexpr std::size_t spare = 24;
/// Points are searched for together if they lie within this part of the distance to the last k-th neighbour from their
/// middle; candidates grow as its cube, the work for each point alone does not.
constexpr double compact = 0.9;
/// The distance to the k-th neighbour changes little from point to point: by which factor it may grow before a point is
/// searched for alone.
constexpr double growth = 1.15;
/// Greatest number of neighbours that are put in order by comparing each with each.
constexpr std::size_t few = 64;
/// Of bounds, for the rounding of what they are made of.
constexpr double widened = 1 + 1e-12;

double greatest_distance(std::span<const PointTree::Neighbour> found) {
  double squared = 0;
  for (const PointTree::Neighbour& n : found) squared = std::max(squared, n.squared_distance);
  return std::sqrt(squared);
}

}  // namespace

PointTree::PointTree(std::span<const Vec3> points, std::span<const GlobalId> ids) : ids_(ids.begin(), ids.end()) {
  leaves_.resize((points.size() + leaf_size - 1) / leaf_size);
  std::vector<Box> boxes(leaves_.size());
  for (std::size_t l = 0; l < leaves_.size(); ++l) {
    for (std::size_t k = 0; k < leaf_size; ++k) {
      const std::size_t i = l * leaf_size + k;
      const Vec3 x = i < points.size() ? points[i] : Vec3{nowhere, nowhere, nowhere};
      for (std::size_t c = 0; c < 3; ++c) leaves_[l].coordinate[c][k] = x[c];
      if (!std::isnan(x[0] + x[1] + x[2])) boxes[l].add(x);
    }
  }
  boxes_.build(boxes);
}

void PointTree::select(std::size_t k, std::vector<Neighbour>& found) const {
  const auto nearer = [this](const Neighbour& a, const Neighbour& b) {
    if (a.squared_distance != b.squared_distance) return a.squared_distance < b.squared_distance;
    return ids_[static_cast<std::size_t>(a.index)] < ids_[static_cast<std::size_t>(b.index)];
  };
  if (found.size() > k + 4) {
    std::nth_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(k), found.end(), nearer);
    found.resize(k);
  }
  for (; found.size() > k; found.pop_back())
    std::swap(*std::max_element(found.begin(), found.end(), nearer), found.back());
}

// Comparing each with each takes no branch, so the compiler does it in vectors.
void PointTree::order_by_id(std::vector<Neighbour>& found) const {
  const auto id = [this](const Neighbour& n) { return ids_[static_cast<std::size_t>(n.index)]; };
  const std::size_t count = found.size();
  if (count > few) {
    std::sort(found.begin(), found.end(), [&](const Neighbour& a, const Neighbour& b) { return id(a) < id(b); });
    return;
  }
  std::array<GlobalId, few> ids;
  std::array<Neighbour, few> sorted;
  for (std::size_t i = 0; i < count; ++i) ids[i] = id(found[i]);
  for (std::size_t i = 0; i < count; ++i) {
    GlobalId before = 0;
    for (std::size_t j = 0; j < count; ++j) before += ids[j] < ids[i];
    sorted[static_cast<std::size_t>(before)] = found[i];
  }
  std::copy_n(sorted.begin(), count, found.begin());
}

void PointTree::k_nearest_unordered(const Vec3& x, std::size_t k, double limit, std::vector<Neighbour>& found) const {
  found.clear();
  if (k == 0) return;
  double worst = limit * limit;
  boxes_.nearest(x, limit, [&](LocalIndex l) {
    const Leaf& leaf = leaves_[static_cast<std::size_t>(l)];
    const Lanes dx = leaf.coordinate[0] - x[0], dy = leaf.coordinate[1] - x[1], dz = leaf.coordinate[2] - x[2];
    const Lanes squared = dx * dx + dy * dy + dz * dz;
    for (std::size_t i = 0; i < leaf_size; ++i)
      if (squared[i] <= worst)
        found.push_back({squared[i], static_cast<LocalIndex>(static_cast<std::size_t>(l) * leaf_size + i)});
    if (found.size() < k + spare) return infinity;
    select(k, found);
    const double radius = greatest_distance(found);
    worst = std::min(worst, widened * radius * radius);
    return radius;
  });
  select(k, found);
}

void PointTree::k_nearest(const Vec3& x, int k, double limit, std::vector<Neighbour>& found) const {
  k_nearest_unordered(x, static_cast<std::size_t>(std::max(k, 0)), limit, found);
  order_by_id(found);
}

void PointTree::collect(const Vec3& centre, double radius, Candidates& candidates) const {
  const Vec3 reach{radius, radius, radius};
  candidates.leaves.clear();
  boxes_.overlapping({centre - reach, centre + reach}, candidates.leaves);
  const std::size_t room = candidates.leaves.size() * leaf_size;
  if (room > candidates.x.size())
    for (auto* values : {&candidates.x, &candidates.y, &candidates.z, &candidates.squared}) values->resize(room);
  if (room > candidates.index.size()) candidates.index.resize(room);
  const double most = radius * radius;
  std::size_t count = 0;
  for (const LocalIndex l : candidates.leaves) {
    const Leaf& leaf = leaves_[static_cast<std::size_t>(l)];
    const Lanes dx = leaf.coordinate[0] - centre[0], dy = leaf.coordinate[1] - centre[1];
    const Lanes dz = leaf.coordinate[2] - centre[2];
    const Lanes squared = dx * dx + dy * dy + dz * dz;
    for (std::size_t i = 0; i < leaf_size; ++i) {
      candidates.x[count] = leaf.coordinate[0][i];
      candidates.y[count] = leaf.coordinate[1][i];
      candidates.z[count] = leaf.coordinate[2][i];
      candidates.index[count] = static_cast<LocalIndex>(static_cast<std::size_t>(l) * leaf_size + i);
      count += squared[i] <= most;
    }
  }
  candidates.count = count;
}

// The threshold below which there are k candidates is sought by counting, which takes no branch, from a guess on: the
// number grows about as the cube of the distance.
void PointTree::take_nearest(Candidates& from, const Vec3& x, std::size_t k, double limit, double guess,
                             std::vector<Neighbour>& found) const {
  double* const squared = from.squared.data();
  const std::size_t all = from.count;
  for (std::size_t i = 0; i < all; ++i) {
    const double dx = from.x[i] - x[0], dy = from.y[i] - x[1], dz = from.z[i] - x[2];
    squared[i] = dx * dx + dy * dy + dz * dz;
  }
  const auto count_within = [&](double most) {
    std::int64_t count = 0;
    for (std::size_t i = 0; i < all; ++i) count += squared[i] <= most;
    return static_cast<std::size_t>(count);
  };
  found.clear();
  double high = limit * limit, low = 0;
  std::size_t count = count_within(high);
  if (count < k) return;
  double middle = std::min(guess * guess, high);
  for (int repeat = 0; repeat < 6 && count > k + 3 && low < middle && middle < high; ++repeat) {
    const std::size_t within = count_within(middle);
    if (within < k)
      low = middle;
    else
      high = middle, count = within;
    const double ratio = (static_cast<double>(k) + 1.5) / (static_cast<double>(within) + 0.5);
    middle = std::clamp(middle * std::cbrt(ratio * ratio), 0.75 * low + 0.25 * high, 0.25 * low + 0.75 * high);
  }
  found.resize(all + 1);
  std::size_t taken = 0;
  for (std::size_t i = 0; i < all; ++i) {
    found[taken] = {squared[i], from.index[i]};
    taken += squared[i] <= high;
  }
  found.resize(taken);
  select(k, found);
}

void PointTree::for_each_k_nearest(std::span<const Vec3> points, int k, double limit, const Visit& visit) const {
  const std::vector<LocalIndex> order = order_along_curve(points);
  const auto at = [&](std::size_t i) -> const Vec3& { return points[static_cast<std::size_t>(order[i])]; };
  const auto wanted = static_cast<std::size_t>(std::max(k, 0));
  std::vector<Neighbour> found;
  Candidates candidates;
  Vec3 last{};
  double last_radius = infinity;  // of the ball about `last` that just holds k points
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    Vec3 centre{};
    double spread = infinity;
    for (std::size_t size = block_size; spread > compact * last_radius && size > 1; size /= 2) {
      end = std::min(begin + size, order.size());
      Box around;
      for (std::size_t i = begin; i < end; ++i) around.add(at(i));
      centre = 0.5 * (around.low + around.high);
      spread = 0.5 * around.diagonal();
    }
    const bool together = last_radius < infinity && spread <= compact * last_radius;
    const double radius = growth * last_radius + spread;
    if (together)
      collect(centre, radius, candidates);
    else
      end = begin + 1;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3& x = at(i);
      // All points within `sure` of x are among the candidates.
      const double sure = together ? (radius - norm(x - centre)) / widened : 0;
      found.clear();
      if (together) take_nearest(candidates, x, wanted, std::min(sure, limit), last_radius, found);
      if (found.size() < wanted && sure < limit)
        k_nearest_unordered(x, wanted, std::min(widened * (last_radius + norm(x - last)), limit), found);
      if (found.size() < wanted) continue;
      last = x, last_radius = greatest_distance(found);
      order_by_id(found);
      visit(order[i], found);
    }
  }
}

std::vector<LocalIndex> order_along_curve(std::span<const Vec3> points) {
  Box bounds;
  for (const Vec3& x : points)
    if (std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2])) bounds.add(x);
  return HilbertCurve(bounds).order(points.size(), [&](std::size_t i) { return points[i]; });
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/point_tree.hpp"

#include <algorithm>
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
/// Points are searched for together if they lie within this part of the distance to the k-th neighbour from their
/// middle; candidates grow as its cube, the work for each point alone does not.
constexpr double compact = 0.75;
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
  if (found.size() <= k) return;
  const auto middle = found.begin() + static_cast<std::ptrdiff_t>(k - 1);
  std::nth_element(found.begin(), middle, found.end(), [this](const Neighbour& a, const Neighbour& b) {
    if (a.squared_distance != b.squared_distance) return a.squared_distance < b.squared_distance;
    return ids_[static_cast<std::size_t>(a.index)] < ids_[static_cast<std::size_t>(b.index)];
  });
  found.resize(k);
}

void PointTree::order_by_id(std::vector<Neighbour>& found) const {
  std::sort(found.begin(), found.end(), [this](const Neighbour& a, const Neighbour& b) {
    return ids_[static_cast<std::size_t>(a.index)] < ids_[static_cast<std::size_t>(b.index)];
  });
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
    worst = found.back().squared_distance;
    return std::sqrt(worst);
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

void PointTree::take_nearest(Candidates& from, const Vec3& x, std::size_t k, double limit,
                             std::vector<Neighbour>& found) const {
  const double most = limit * limit;
  double* const squared = from.squared.data();
  for (std::size_t i = 0; i < from.count; ++i) {
    const double dx = from.x[i] - x[0], dy = from.y[i] - x[1], dz = from.z[i] - x[2];
    squared[i] = dx * dx + dy * dy + dz * dz;
  }
  found.resize(from.count + 1);
  std::size_t count = 0;
  for (std::size_t i = 0; i < from.count; ++i) {
    found[count] = {squared[i], from.index[i]};
    count += squared[i] <= most;
  }
  found.resize(count);
  select(k, found);
}

void PointTree::for_each_k_nearest(std::span<const Vec3> points, int k, double limit, const Visit& visit) const {
  const std::vector<LocalIndex> order = order_along_curve(points);
  const auto at = [&](std::size_t i) -> const Vec3& { return points[static_cast<std::size_t>(order[i])]; };
  const auto wanted = static_cast<std::size_t>(std::max(k, 0));
  std::vector<Neighbour> found;
  Candidates candidates;
  Vec3 last{};
  double last_radius = infinity;  // a ball about `last` that holds k points
  const auto bound = [&](const Vec3& x) { return widened * (last_radius + norm(x - last)); };
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    end = std::min(begin + block_size, order.size());
    Box around;
    for (std::size_t i = begin; i < end; ++i) around.add(at(i));
    const Vec3 centre = 0.5 * (around.low + around.high);
    double spread = 0;
    for (std::size_t i = begin; i < end; ++i) spread = std::max(spread, norm(at(i) - centre));
    bool together = spread <= compact * last_radius;
    if (together) {
      k_nearest_unordered(centre, wanted, std::min(bound(centre), limit + 2 * spread), found);
      together = found.size() == wanted;
      if (together) last = centre, last_radius = greatest_distance(found);
      together = together && spread <= compact * last_radius;
    }
    if (together) collect(centre, widened * (last_radius + 2 * spread), candidates);
    for (std::size_t i = begin; i < end; ++i) {
      if (together)
        take_nearest(candidates, at(i), wanted, std::min(bound(at(i)), limit), found);
      else
        k_nearest_unordered(at(i), wanted, std::min(bound(at(i)), limit), found);
      if (found.size() < wanted) continue;
      if (!together) last = at(i), last_radius = greatest_distance(found);
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

// SPDX-License-Identifier: BSD-3-Clause
#include "framework/search/point_tree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "framework/base/hilbert.hpp"

namespace tenon {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
/// Candidates kept beyond k before the farthest are thrown out: each such selection costs about as much as scanning
/// this many points.
constexpr std::size_t slack = 24;

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

void PointTree::k_nearest(const Vec3& x, int k, double limit, std::vector<Neighbour>& found) const {
  found.clear();
  if (k <= 0) return;
  const auto wanted = static_cast<std::size_t>(k);
  const auto before = [this](const Neighbour& a, const Neighbour& b) {
    if (a.squared_distance != b.squared_distance) return a.squared_distance < b.squared_distance;
    return ids_[static_cast<std::size_t>(a.index)] < ids_[static_cast<std::size_t>(b.index)];
  };
  const auto select = [&] {
    std::nth_element(found.begin(), found.begin() + (k - 1), found.end(), before);
    found.resize(wanted);
  };
  double worst = limit * limit;
  boxes_.nearest(x, limit, [&](LocalIndex l) {
    const Leaf& leaf = leaves_[static_cast<std::size_t>(l)];
    const Lanes dx = leaf.coordinate[0] - x[0], dy = leaf.coordinate[1] - x[1], dz = leaf.coordinate[2] - x[2];
    const Lanes squared = dx * dx + dy * dy + dz * dz;
    for (std::size_t i = 0; i < leaf_size; ++i)
      if (squared[i] <= worst)
        found.push_back({squared[i], static_cast<LocalIndex>(static_cast<std::size_t>(l) * leaf_size + i)});
    if (found.size() < wanted + slack) return infinity;
    select();
    worst = found.back().squared_distance;
    return std::sqrt(worst);
  });
  if (found.size() > wanted) select();
  std::sort(found.begin(), found.end(), before);
}

std::vector<LocalIndex> order_along_curve(std::span<const Vec3> points) {
  Box bounds;
  for (const Vec3& x : points)
    if (std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2])) bounds.add(x);
  const HilbertCurve curve(bounds);
  std::vector<HilbertPlace> places(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) places[i] = {curve.code(points[i]), static_cast<LocalIndex>(i)};
  sort_along_curve(places);
  std::vector<LocalIndex> order(points.size());
  for (std::size_t i = 0; i < places.size(); ++i) order[i] = places[i].index;
  return order;
}

}  // namespace tenon

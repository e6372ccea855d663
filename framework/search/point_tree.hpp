// SPDX-License-Identifier: BSD-3-Clause
// Local search among points: the k nearest ones, with ties decided by their global ids.
#pragma once

#include <span>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/search/box_tree.hpp"

namespace tenon {

/// A tree of boxes over leaves of eight points. Points may coincide, lie on a line or in a plane, and crowd by any
/// factor; one with a coordinate that is not a number is never found. Queries allocate nothing but room in `found`.
class PointTree {
 public:
  struct Neighbour {
    double squared_distance;  ///< m^2
    LocalIndex index;         ///< of the point, as given
  };

  PointTree() = default;
  /// Copies both; leaves are made of points that follow each other, so give them in order along a curve
  /// (`order_along_curve`): no answer depends on it, but the time does.
  PointTree(std::span<const Vec3> points, std::span<const GlobalId> ids);

  LocalIndex size() const { return static_cast<LocalIndex>(ids_.size()); }

  /// The k points nearest to x, or all if there are fewer, of those not farther than `limit` (m); in ascending order of
  /// (squared distance, id). The squared distance is dx dx + dy dy + dz dz, added in this order.
  void k_nearest(const Vec3& x, int k, double limit, std::vector<Neighbour>& found) const;

 private:
  static constexpr std::size_t leaf_size = 8;
  typedef double Lanes __attribute__((vector_size(leaf_size * sizeof(double))));
  struct Leaf {
    Lanes coordinate[3];
  };
  std::vector<Leaf> leaves_;
  std::vector<GlobalId> ids_;
  BoxTree boxes_;  // of the leaves
};

/// Indices of the points in order along the Hilbert curve through their bounds.
std::vector<LocalIndex> order_along_curve(std::span<const Vec3> points);

}  // namespace tenon

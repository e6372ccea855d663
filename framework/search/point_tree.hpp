// SPDX-License-Identifier: BSD-3-Clause
// Local search among points: the k nearest ones, with ties decided by their global ids.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/search/box_tree.hpp"

namespace tenon {

/// A tree of boxes over leaves of eight points. Points may coincide, lie on a line or in a plane, and crowd by any
/// factor; one with a coordinate that is not a number is never found. Queries allocate nothing but room for what they
/// find.
class PointTree {
 public:
  struct Neighbour {
    double squared_distance;  ///< dx dx + dy dy + dz dz, added in this order, m^2
    LocalIndex index;         ///< of the point, as given
  };
  using Visit = std::function<void(LocalIndex, std::span<const Neighbour>)>;

  PointTree() = default;
  /// Copies both; leaves are made of points that follow each other, so give them in order along a curve
  /// (`order_along_curve`): no answer depends on it, but the time does.
  PointTree(std::span<const Vec3> points, std::span<const GlobalId> ids);

  LocalIndex size() const { return static_cast<LocalIndex>(ids_.size()); }

  /// The k points nearest to x, or all if there are fewer, of those not farther than `limit` (m); of equal distances
  /// the smaller ids. They ascend by id.
  void k_nearest(const Vec3& x, int k, double limit, std::vector<Neighbour>& found) const;

  /// The same for many points: calls visit(i, neighbours) for each of `points` that has k within `limit`. Those that
  /// follow each other along a curve are searched for together.
  void for_each_k_nearest(std::span<const Vec3> points, int k, double limit, const Visit& visit) const;

 private:
  static constexpr std::size_t leaf_size = 8, block_size = 8;
  typedef double Lanes __attribute__((vector_size(leaf_size * sizeof(double))));
  struct Leaf {
    Lanes coordinate[3];
  };
  /// The points near a block of points that ask, coordinate by coordinate.
  struct Candidates {
    std::size_t count = 0;
    std::vector<double> x, y, z, squared;
    std::vector<LocalIndex> index, leaves;
  };

  void k_nearest_unordered(const Vec3& x, std::size_t k, double limit, std::vector<Neighbour>& found) const;
  void select(std::size_t k, std::vector<Neighbour>& found) const;
  void order_by_id(std::vector<Neighbour>& found) const;
  void collect(const Vec3& centre, double radius, Candidates& candidates) const;
  void take_nearest(Candidates& from, const Vec3& x, std::size_t k, double limit, double guess,
                    std::vector<Neighbour>& found) const;

  std::vector<Leaf> leaves_;
  std::vector<GlobalId> ids_;
  BoxTree boxes_;  // of the leaves
};

/// Indices of the points in order along the Hilbert curve through their bounds.
std::vector<LocalIndex> order_along_curve(std::span<const Vec3> points);

}  // namespace tenon

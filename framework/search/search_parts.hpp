// SPDX-License-Identifier: BSD-3-Clause
// How a search divides space among the ranks: which ranks a box meets, and whose a point is.
#pragma once

#include <span>
#include <vector>

#include "framework/base/box.hpp"
#include "framework/base/types.hpp"
#include "framework/comm/communicator.hpp"
#include "framework/decomposition/rcb.hpp"
#include "framework/search/box_tree.hpp"

namespace tenon {

/// `rcb`: boxes of equal work [BB87]. `slices`: slabs of equal work across the longest axis. `owner_boxes`: no division
/// of space; items stay on their ranks, which know each other's bounding boxes. The last two are for comparison.
enum class SearchDecomposition { rcb, slices, owner_boxes };

/// One box per rank. Parts fill space and share no point: a point on a cut belongs to the upper side, and every rank
/// decides so by comparing the same numbers.
class SearchParts {
 public:
  explicit SearchParts(const Communicator& comm) : SearchParts(comm, comm.size()) {}
  /// The same cuts for any number of parts, to plan for more ranks than there are.
  SearchParts(const Communicator& comm, int parts) : comm_(comm), count_(parts), rcb_(comm, parts) {}

  /// Collective. Parts of equal weight by centres and weights (> 0); what is not finite is passed over.
  void cut(SearchDecomposition decomposition, std::span<const Vec3> centres, std::span<const double> weights);
  bool empty() const { return parts_.empty(); }

  /// Whether the point lies in the part of this rank.
  bool owns(const Vec3& x) const { return is_in(x, parts_[static_cast<std::size_t>(comm_.rank())]); }
  /// Parts (ranks) that the box meets, in ascending order, in place of what was in `ranks`.
  void ranks_meeting(const Box& box, std::vector<int>& ranks) const;

 private:
  static bool is_in(const Vec3& x, const Box& part);
  static bool meets(const Box& box, const Box& part);
  std::vector<Box> slices(std::span<const Vec3> centres, std::span<const double> weights) const;

  Communicator comm_;
  int count_;
  Rcb rcb_;
  std::vector<Box> parts_;  // of all ranks; upper faces excluded
  Box bounds_;              // all cuts are in it
  BoxTree tree_;            // over the parts within the bounds
  mutable int last_ = 0;    // part that the last box met
};

}  // namespace tenon

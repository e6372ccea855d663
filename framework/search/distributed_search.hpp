// SPDX-License-Identifier: BSD-3-Clause
// Brings points and the boxes that may contain them together on the same rank, then searches there with the
// serial tree: recursive bisection of both sets, boxes cloned across cuts (Plimpton et al. 1998, section 3, step 4).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "framework/comm/exchange_plan.hpp"
#include "framework/decomposition/rcb.hpp"
#include "framework/search/box_tree.hpp"

namespace tenon {

/// The rendezvous of two distributed sets. Items are identified by their place in the caller's arrays; what
/// belongs to them (coordinates of element corners, ids ...) travels by `boxes` and `points`, in the same order.
class DistributedSearch {
 public:
  /// Collective. `boxes` and `points` are those of this rank (either may be empty). `reach` (m) is how far a
  /// point may be from a box and still meet it: clones go to every part within reach. Boxes that are empty or not
  /// finite go nowhere; a point that is not finite goes to rank 0.
  DistributedSearch(const Communicator& comm, std::span<const Box> boxes, std::span<const Vec3> points, double reach,
                    std::string name);
  /// The same with cuts kept by the caller, so that a search after small motion moves few items. `work` (empty: equal)
  /// is how costly each point was in the last search: the parts get equal shares.
  DistributedSearch(const Communicator& comm, Rcb& rcb, std::span<const Box> boxes, std::span<const Vec3> points,
                    double reach, std::string name, std::span<const float> work = {});

  /// Collective. New places of the points, which stay on the ranks that they were sent to.
  void move_points(std::span<const Vec3> points);

  /// Moves data of boxes to the rendezvous; a box that overlaps several parts is cloned. Item i of this plan is
  /// box `box_of_send()[i]` of the caller.
  const ExchangePlan& boxes() const { return box_plan_; }
  const std::vector<LocalIndex>& box_of_send() const { return box_of_send_; }
  /// Moves data of points to the rendezvous and results back (reverse). Each point goes to exactly one rank.
  const ExchangePlan& points() const { return point_plan_; }

  /// Tree over the boxes that have arrived here, indexed in order of arrival.
  const BoxTree& tree() const { return tree_; }
  BoxTree take_tree() { return std::move(tree_); }
  std::span<const Vec3> arrived_points() const { return arrived_points_; }
  std::span<const Box> arrived_boxes() const { return arrived_boxes_; }

 private:
  void search(const Communicator& comm, Rcb& rcb, std::span<const Box> boxes, std::span<const Vec3> points,
              double reach, const std::string& name, std::span<const float> work);

  ExchangePlan box_plan_, point_plan_;
  std::vector<LocalIndex> box_of_send_;
  std::vector<Vec3> arrived_points_;
  std::vector<Box> arrived_boxes_;
  BoxTree tree_;
};

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Recursive coordinate bisection of points (Zoltan RCB), kept between calls so that small motion moves few points.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "framework/base/box.hpp"
#include "framework/base/types.hpp"
#include "framework/comm/communicator.hpp"

namespace tenon {

/// Cuts space into one box per rank with equal weight of points in each [BB87]. Cut directions are locked
/// after the first cut and parts are not renumbered, so a repartition after small motion moves few points.
class Rcb {
 public:
  explicit Rcb(const Communicator& comm);
  /// The same cuts for any number of parts, to plan for more ranks than there are.
  Rcb(const Communicator& comm, int parts);

  /// Collective. Part (= rank, unless parts were given) of each point. `coordinates` is n x 3, m; `weights` is empty or
  /// n, > 0. Ties on a cut are decided by Zoltan: take the ownership from here, never from `rank_of`. No points: fine.
  std::vector<int> partition(std::span<const Vec3> coordinates, std::span<const double> weights);

  /// Collective. The same with cuts from a sample of many points, and the part of each point by those cuts (one that
  /// lies on a cut is in the upper part): much cheaper, and balanced to about a percent.
  std::vector<int> partition_by_sample(std::span<const Vec3> coordinates, std::span<const double> weights);

  /// Ranks whose part overlaps the box, appended to `ranks` in ascending order. Local, after `partition`.
  void ranks_overlapping(const Box& box, std::vector<int>& ranks) const;

  /// The part of a rank, endless where it has no neighbour; the upper faces belong to the neighbours. The parts of all
  /// ranks fill space. Empty if there were no points (then all is rank 0's). Local, after `partition`.
  Box part(int rank) const;

 private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

}  // namespace tenon

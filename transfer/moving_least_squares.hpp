// SPDX-License-Identifier: BSD-3-Clause
// Maps from and to clouds of points by moving least squares: linear-exact, and its transpose, which keeps totals.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "framework/comm/communicator.hpp"
#include "transfer/local_linear_fit.hpp"
#include "transfer/mesh_items.hpp"
#include "transfer/row_map.hpp"

namespace tenon::transfer {

struct MovingLeastSquaresOptions {
  /// Points that each fit looks at; from 1 to max_neighbours. The farthest has no weight. A fit that they do not
  /// determine, because they stand in a line or a plane, is repeated with max_neighbours.
  int neighbours = 20;
  FitRules rules{};
};

/// What the fit at a point found, beside the weights.
struct FittedPoint {
  double distance = 0;   ///< to the nearest point of the cloud, m
  double spacing = 0;    ///< of the cloud there, m
  bool outside = false;  ///< not among the points of the cloud, and farther from it than they are from each other
  bool exact = false;    ///< linear fields are reproduced in all directions
};

/// Collective. A row for each of `targets` (this rank's; any points): weights of the nearest items of the source, which
/// add up to 1 to an ulp and reproduce linear fields wherever the items around extend in all directions.
/// `cloud`: the places of the owned items, in order of `items.owned`. A target at an item does in general not receive
/// just that item's value. Terms ascend by source id; the same bits on any ranks. Throws Error(usage) for options out
/// of range, Error(geometry) for an empty cloud or coordinates that are no places.
Rows moving_least_squares_rows(const Communicator& comm, const Items& items, std::span<const Vec3> cloud,
                               std::span<const Vec3> targets, const MovingLeastSquaresOptions& options,
                               const std::string& name, std::vector<FittedPoint>& fitted);

/// A place at which part of a source item's amount is let go.
struct SpreadPoint {
  Vec3 x{};  ///< m
  GlobalId source = no_id;
  int owner = -1;
  LocalIndex at_owner = no_index;
  double part = 1;  ///< of the item's amount
};

/// Collective. The transpose: rows for the owned items of the cloud (in order of `items.owned`), by which amounts at
/// `points` go to the cloud. Points of the same source that follow each other make one column; the parts of each
/// column, which add up to its points' parts to an ulp, ascend by target. So sums are kept, and with them, wherever the
/// fits are exact, first moments (of forces: the torque). Every source item's points must be on one rank.
Rows moving_least_squares_transpose(const Communicator& comm, const Items& items, std::span<const Vec3> cloud,
                                    std::span<const SpreadPoint> points, const MovingLeastSquaresOptions& options,
                                    const std::string& name, std::vector<FittedPoint>& fitted);

}  // namespace tenon::transfer

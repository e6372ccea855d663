// SPDX-License-Identifier: BSD-3-Clause
// The points by which source items spread their amounts over the target mesh.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "transfer/rows.hpp"

namespace tenon::transfer {

/// Points of this rank, grouped: group g has the points begin[g] .. begin[g+1]).
struct SpreadingPoints {
  /// Part of a source item's amount that one group of points spreads.
  struct Share {
    GlobalId source;
    int owner;
    LocalIndex at_owner;
    double amount;             ///< by which weights are multiplied: 1 for totals, the volume for densities, m^3
    double volume;             ///< that the share fills, m^3; 0 for a point at a node
    std::size_t first_weight;  ///< in `weights`: one for each point of the group, their sum 1
  };
  std::vector<Vec3> points;
  std::vector<GlobalId> ids;  ///< global id of the source item (or element) of each point
  std::vector<std::size_t> begin{0};
  std::vector<std::size_t> first_share{0};
  std::vector<Share> shares;
  std::vector<double> weights;
  std::size_t groups() const { return begin.size() - 1; }
};

/// Collective. Amounts of elements spread by midpoints of sub-cells, finer where the element is large against the
/// target mesh's mean; totals of nodes by one point at the node; densities of nodes, which are fields between the nodes
/// too, by the sub-cells of the elements around, weighted with the node's shape function.
SpreadingPoints spreading_points(const Side& source, const Side& target, bool density);
/// Local. Totals of points without a mesh: each by one point.
SpreadingPoints spreading_points(const Items& points, std::span<const Vec3> places);

/// Collective. The rows of conservation_rows from points that spread whatever it may be.
Rows spreading_rows(SpreadingPoints&& spreading, const Side& target, const PlaceRules& rules, bool density,
                    const std::string& name, Sought& sought);

}  // namespace tenon::transfer

// SPDX-License-Identifier: BSD-3-Clause
// Springs and dashpots between nodes that may live on any ranks, and from nodes to the ground.
#pragma once

#include "components/mechanics/load.hpp"
#include "components/mechanics/load_options.hpp"
#include "components/mechanics/remote_nodes.hpp"

namespace tenon {

/// Two nodes, or one and the ground.
struct Link {
  GlobalId first = -1, second = -1;  ///< second -1: ground
  Vec3 first_place{}, second_place{};
};

/// Collective. The links of a connector that touch an owned node of this rank, ascending by their nodes. Throws
/// Error(usage) for unknown sets and nodes, and for a node linked with itself.
std::vector<Link> find_links(const Mesh& mesh, const Connector& connector);

/// True if the law is one straight line through the origin.
bool is_linear(const Connector& connector);
/// Force of a law (N), and the greatest slope anywhere.
double law_force(const Connector& connector, double extent);
double greatest_slope(const Connector& connector);

/// Forces of one connector. Each rank computes every link that has an owned end, so that its nodes get all of their
/// forces in the order of the links. Explicit: they count in the stable step by `add_bounds`.
class ConnectorForce final : public Load {
 public:
  /// Collective.
  ConnectorForce(const Mesh& mesh, const Connector& connector);
  std::vector<LocalIndex> nodes() const override;
  /// Collective.
  void add_forces(const LoadState& state, std::span<ForceRow> force) const override;
  /// Adds to each owned node a bound on the row sum of its stiffness (N/m) or, of a dashpot, damping (N s/m).
  void add_bounds(std::span<double> row_sums) const;

 private:
  Vec3 link_force(const Link& link, const Vec3& between, const Vec3& relative) const;

  Connector connector_;
  std::vector<Link> links_;
  std::vector<LocalIndex> ends_;  // owned end nodes, two per link, or no_index
  RemoteNodes remote_;            // both ends of each link between nodes, the first end of each link to the ground
  mutable std::vector<Vec3> position_, velocity_;
};

}  // namespace tenon

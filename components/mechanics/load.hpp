// SPDX-License-Identifier: BSD-3-Clause
// What pushes on nodes from outside the elements.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "components/mechanics/element_groups.hpp"
#include "components/mechanics/nodal_state.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon {

/// What a load may look at: the present positions and the velocities of half a step before.
struct LoadState {
  NodalState& nodes;  ///< only its velocities, positions and masses are read
  const ElementGroups& groups;
  double time;  ///< s
};

/// A force law. Terms of a node are added in an order that does not depend on the ranks.
class Load {
 public:
  virtual ~Load() = default;
  /// Local nodes that it may push, ascending; owned ones must be complete, ghosts need not be.
  virtual std::vector<LocalIndex> nodes() const = 0;
  /// Adds its forces, N.
  virtual void add_forces(const LoadState& state, std::span<ForceRow> force) const = 0;
};

/// Owned and ghost nodes of one or more sets, ascending, each once. Throws Error(usage), on all ranks, for an unknown
/// set.
std::vector<LocalIndex> nodes_of_sets(const Mesh& mesh, const std::vector<std::string>& sets, const std::string& label);

}  // namespace tenon

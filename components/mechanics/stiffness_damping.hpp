// SPDX-License-Identifier: BSD-3-Clause
// Damping in proportion to the stiffness of the elements.
#pragma once

#include <fmt/core.h>

#include <algorithm>
#include <numeric>

#include "components/mechanics/load.hpp"

namespace tenon {

/// -beta K v by the elastic stiffness of the elements in their present geometry. Explicit, with the velocities of half
/// a step before, so it lowers the stable step: the damping ratio of a mode is beta omega/2.
class StiffnessDamping final : public Load {
 public:
  /// Throws Error(usage) if some formulation has no product with its stiffness.
  StiffnessDamping(const Mesh& mesh, const ElementGroups& groups, double beta)
      : beta_(beta), nodes_(static_cast<std::size_t>(mesh.nodes())) {
    for (const auto& group : groups)
      if (!group->has_product())
        throw Error(
            ExitCode::usage,
            fmt::format("damping.stiffness: elements of block '{}' ({}) cannot be damped in proportion to their "
                        "stiffness; use damping.mass",
                        group->elements().name, group->formulation()));
    std::iota(nodes_.begin(), nodes_.end(), LocalIndex{0});
  }
  std::vector<LocalIndex> nodes() const override { return nodes_; }
  void add_forces(const LoadState& state, std::span<ForceRow> force) const override {
    const NodeArrays arrays = state.nodes.arrays();
    for (const auto& group : state.groups)
      if (!force.empty()) group->add_product(arrays, arrays.velocity, -beta_, 0, force.data());
  }

 private:
  double beta_;
  std::vector<LocalIndex> nodes_;
};

}  // namespace tenon

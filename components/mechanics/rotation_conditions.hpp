// SPDX-License-Identifier: BSD-3-Clause
// What holds or turns the rotations of nodes: clamped edges, symmetry, prescribed rotations.
#pragma once

#include <span>
#include <vector>

#include "components/mechanics/mechanics_options.hpp"
#include "components/mechanics/nodal_state.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon {

/// Spins along given directions are replaced after the kick, as NodalConditions replaces velocities. A fixed motion
/// holds the components in its `rotations`; a plane of symmetry the two in it; a prescribed rotation all three, at the
/// spin that over a step turns by just its angle: 2 tan(angle/2)/dt, as the turn of the positions is seen half way
/// [HW80].
class RotationConditions {
 public:
  /// Local.
  RotationConditions(const Mesh& mesh, const std::vector<PrescribedMotion>& motions);

  bool empty() const { return entries_.empty(); }
  void add_nodes(std::vector<LocalIndex>& nodes) const {
    for (const Entry& entry : entries_) nodes.push_back(entry.node);
  }
  /// Makes the spins at the start compatible with what is held.
  void start(std::span<Vec3> spin) const;
  /// Local. After the kick over `kick` seconds, for the step of length dt from `time`; adds the work of the moments
  /// that this takes, J per node.
  void apply(NodalState& nodes, double time, double kick, double dt, std::vector<double>& work);
  std::int64_t memory() const { return static_cast<std::int64_t>(entries_.size() * sizeof(Entry)); }

 private:
  struct Entry {
    LocalIndex node;
    int rows = 0;
    Vec3 direction[3]{};  // orthonormal
    std::int32_t motion[3]{};
  };
  void hold(Entry& entry, const Vec3& direction, std::int32_t motion) const;

  std::vector<PrescribedMotion> motions_;
  std::vector<Vec3> target_;  // of each motion, rad/s
  std::vector<Entry> entries_;
};

}  // namespace tenon

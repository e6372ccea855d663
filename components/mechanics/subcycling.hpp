// SPDX-License-Identifier: BSD-3-Clause
// Elements with steps of their own, in powers of two: the nodes between.
#pragma once

#include <vector>

#include "components/mechanics/element_levels.hpp"
#include "components/mechanics/nodal_state.hpp"

namespace tenon {

/// Asynchronous variational integration [LMOW03] in levels: an element of level k gives its nodes the impulse
/// 2^k h f each 2^k short steps h, and nothing between; a node moves on with the shortest step of the elements around
/// it. Each force acts on all nodes of its element at once, so momentum is kept to the last bit of the sums, and the
/// work of each impulse is exactly the change of kinetic energy, between elements of different steps too.
///
/// In `NodalState::force` forces stand with the weight 2^k, so that the kick of the shortest step does for all. Loads,
/// walls, prescribed motions and the like act in every short step: the nodes that they touch have level 0.
class Subcycling {
 public:
  /// Collective. `levels` of the elements; `groups` in which all elements have one level, `group_levels`; `busy`: 1 for
  /// owned nodes that something else than elements acts on.
  Subcycling(const Mesh& mesh, const ElementLevels& levels, std::vector<int> group_levels, std::span<const int> busy,
             NodalState& nodes);

  int greatest() const { return static_cast<int>(levels_.size()) - 1; }
  /// Short steps in one of the longest.
  int steps() const { return 1 << greatest(); }
  int level_of_group(std::size_t group) const { return group_levels_[group]; }
  const std::vector<int>& group_levels() const { return group_levels_; }
  /// Whether a level begins and ends a step at the given short step.
  static bool is_due(int level, int step) { return step % (1 << level) == 0; }

  /// Local. Kicks the nodes that are due over `kick` seconds and books their work.
  void kick(NodalState& nodes, int step, double kick) const;
  /// Local. Moves them on, each by its own step; `h` is the short one.
  void drift(NodalState& nodes, int step, double h);
  /// Local. No force on the nodes that are due.
  void clear_forces(NodalState& nodes, int step) const;

  /// Local. Arrays for the elements of a level, whose step of length dt ends now (0: none): mean velocities over it,
  /// and forces that start from zero.
  NodeArrays begin(int level, NodalState& nodes, double dt);
  /// Local. Adds the forces that came to those arrays to the nodes, as impulses.
  void end(int level, NodalState& nodes);

  /// Mean velocity and spin of the last step of a level at a node where they are not the node's own, for checkpoints:
  /// visit(node, value), ascending.
  template <typename Visit>
  void visit_means(int level, Visit visit) {
    Level& l = levels_[static_cast<std::size_t>(level)];
    for (std::size_t i = 0; i < l.shared.size(); ++i) visit(l.shared[i], l.velocity[i]);
  }
  template <typename Visit>
  void visit_mean_spins(int level, Visit visit) {
    Level& l = levels_[static_cast<std::size_t>(level)];
    for (std::size_t i = 0; i < l.spin.size(); ++i) visit(l.shared[i], l.spin[i]);
  }
  /// Local. After a restart: the step before ended at the present positions.
  void restart(const NodalState& nodes);

  std::int64_t memory() const;

 private:
  struct Level {
    std::vector<LocalIndex> own;      // nodes that move with the step of this level
    std::vector<LocalIndex> touched;  // nodes of its elements
    std::vector<LocalIndex> shared;   // of these, those that move with a shorter step
    std::vector<Vec3> last;           // positions of shared nodes at the end of the last step, m
    std::vector<Vec3> velocity;       // their mean over it, m/s
    std::vector<Vec3> turn, spin;     // likewise: sum of dt spin since, rad, and mean, rad/s; empty without rotations
  };
  std::vector<Level> levels_;
  std::vector<int> group_levels_;
  std::vector<std::int32_t> node_level_;
  std::vector<Vec3> velocity_, spin_;     // as NodalState has them, for elements above level 0
  std::vector<ForceRow> force_, moment_;  // likewise
};

}  // namespace tenon

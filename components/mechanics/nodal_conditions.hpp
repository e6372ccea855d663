// SPDX-License-Identifier: BSD-3-Clause
// Prescribed motions and rigid walls: what forces some velocity components at each step.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "components/mechanics/mechanics_options.hpp"
#include "components/mechanics/nodal_state.hpp"
#include "components/mechanics/rotation_conditions.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon {

/// Velocities along given directions are replaced after the kick, so that prescribed places are reached exactly at the
/// end of the step. The impulse that this takes is the reaction; its work m (v+ - v*) (v- + v+)/2 is booked per node.
/// Directions of several conditions on one node are made orthonormal, so any two or three of them combine.
class NodalConditions {
 public:
  /// Collective. Throws Error(usage) where conditions contradict each other, a set is unknown, or a node starts behind
  /// or (bonded) off a wall.
  NodalConditions(const Mesh& mesh, const std::vector<PrescribedMotion>& motions, const std::vector<RigidWall>& walls);

  /// Collective. Some local nodes have no velocity of their own (rigid bodies, ties): walls over every node leave them
  /// out. Returns how many, of all ranks. Throws Error(usage) where a wall's node sets name one, or a wall is left with
  /// no node.
  std::int64_t leave_out_of_walls(const std::vector<bool>& bound);

  /// Makes velocities at the start time compatible with what stands still or has a prescribed velocity.
  void start(std::span<Vec3> velocity, double time);
  void start_spins(std::span<Vec3> spin) const { rotations_.start(spin); }

  /// Local. After the kick over `kick` seconds: velocities for the step of length dt from `time`.
  void apply(NodalState& nodes, double time, double kick, double dt);

  bool has_motions() const { return !motions_.empty(); }
  bool has_walls() const { return has_bonded_walls_ || !walls_.empty(); }
  /// J since the start, of all local nodes (zero on ghosts); empty where the scene has no motions or walls.
  std::vector<double>& boundary_work() { return boundary_work_; }
  std::vector<double>& wall_work() { return wall_work_; }

  /// Orthonormal directions along which a node has no velocity of its own in this step; `wall`: whose reaction it is.
  struct Holds {
    int count = 0;
    Vec3 direction[3];
    bool wall[3];
  };
  /// Local. From now on `apply` remembers which walls have stopped a node. For `size` local nodes.
  void remember_holds(std::size_t size);
  /// Local, after `remember_holds`; of owned nodes.
  Holds holds(LocalIndex node) const;
  /// Local. The change of velocity that the next wall asks of a node which impulses have turned against it since
  /// `apply`; it then counts among those that hold the node. False if no wall does.
  bool stop(LocalIndex node, const NodalState& nodes, double dt, Vec3& change);
  /// Local. Books the work of a wall's reaction, J.
  void add_wall_work(LocalIndex node, double work) { wall_work_[static_cast<std::size_t>(node)] += work; }
  /// Local. An impulse p (N s) has come to a node whose velocity, on the mean of before and after the kick, is `mean`
  /// (m/s): books the work of the reactions that take up its share along held directions.
  void react(LocalIndex node, const Vec3& p, const Vec3& mean);

  /// Local nodes that any of them acts on, some more than once.
  std::vector<LocalIndex> nodes() const;
  std::int64_t memory() const;

 private:
  /// The component along `direction` follows from that along `normal` and those of the rows before.
  struct Row {
    Vec3 direction, normal;
    double along[2], inverse;
    std::int32_t motion;
  };
  struct Constrained {
    LocalIndex node;
    int rows = 0;
    Row row[3];
  };
  struct Standing {
    LocalIndex node;
    std::int32_t constrained;        // or -1
    std::int32_t first_wall, walls;  // in standing_walls_
  };
  /// Directions along which walls have stopped a node in this step.
  struct Stop {
    int count = 0;
    Vec3 direction[3];
  };
  /// A motion at one time: u = b + a (X - c), a velocity b, or an acceleration b.
  struct Prepared {
    enum class Form { place, velocity, acceleration } form;
    Vec3 b, c;
    std::array<double, 9> a;
  };

  void constrain(std::int32_t motion, Constrained& entry, std::optional<Error>& error) const;
  void add_row(const Vec3& normal, std::int32_t motion, Constrained& entry, std::optional<Error>& error) const;
  void find_walls(const Mesh& mesh, const std::vector<RigidWall>& walls);
  Prepared prepare(const PrescribedMotion& motion, double time, double dt) const;
  double target(const Row& row, const NodalState& nodes, std::size_t n, double kick, double dt) const;
  void enforce(Constrained& entry, NodalState& nodes, double kick, double dt);
  void enforce(const Standing& entry, NodalState& nodes, double kick, double dt, Stop* stop);

  const Mesh& mesh_;
  std::vector<PrescribedMotion> motions_;
  std::vector<RigidWall> walls_;
  bool has_bonded_walls_ = false;
  std::vector<Prepared> prepared_;
  RotationConditions rotations_;
  std::vector<double> wall_distance_;  // of the plane from the origin along its normal, at the step's end
  std::vector<Constrained> constrained_;
  std::vector<Standing> standing_;
  std::vector<std::int32_t> standing_walls_;
  std::vector<double> boundary_work_, wall_work_;
  // Only where contact asks for them.
  std::vector<std::int32_t> constrained_of_, standing_of_;  // of each local node, or -1
  std::vector<Stop> stops_;                                 // as standing_: by walls in this step
};

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Blocks that move as rigid bodies: what the nodes do to them, and they to the nodes.
#pragma once

#include "components/mechanics/load.hpp"
#include "components/mechanics/load_options.hpp"
#include "components/mechanics/rigid_motion.hpp"
#include "framework/io/checkpoint.hpp"
#include "framework/simulation/contact_party.hpp"

namespace tenon {

/// Every rank keeps the motion of all bodies; one exact sum of forces and moments per step makes it the same bits
/// everywhere. Nodes that deformable elements share with a body add their mass to it and hand it their forces.
///
/// A step: velocity and angular momentum are kicked at the present position, so that the change of kinetic energy is
/// exactly the work dt F . (v- + v+)/2 of the nodal forces; then the body moves freely, at constant energy. The
/// velocities that nodes show between steps are the chords (x(n+1) - x(n))/dt, so that they arrive exactly.
///
/// Mass-proportional damping, -alpha dm v on every part of a body, is -alpha M V and -alpha L: implicit, with the means
/// of before and after the kick, as on nodes; what it takes is booked per body.
class RigidBodies {
 public:
  /// Collective. Takes the mass of its nodes out of the state. Throws Error(usage) for unknown blocks and nodes in two
  /// bodies. `damping`: alpha, 1/s.
  RigidBodies(const Mesh& mesh, const std::vector<RigidBody>& bodies, const ElementGroups& groups, NodalState& nodes,
              double damping);

  bool empty() const { return bodies_.empty(); }
  /// Nodes of rigid blocks.
  bool holds(LocalIndex node) const { return body_of_[static_cast<std::size_t>(node)] >= 0; }
  /// Bound on what a force on each node accelerates there, 1/kg.
  void bound_inverse_mass(std::span<double> inverse_mass) const;
  /// Local. Greatest step that the spin allows, s.
  double stable_step() const;

  /// Collective. Velocities at the start: those of the options, else the rigid motion with the momenta that the nodal
  /// velocities have.
  void start(NodalState& nodes, double time);
  /// Local. Gives the nodes the rigid velocities of before the kick, or after it.
  void set_rates(NodalState& nodes) const;
  /// Collective. New velocities by the nodal forces, which are taken out of the state.
  void kick(NodalState& nodes, double time, double kick, double dt);
  /// Local. Books the work of these forces, once velocities are final.
  void book(NodalState& nodes, double kick) const;
  /// Local. Moves the bodies by dt and gives the nodes the velocities that bring them along.
  void move(NodalState& nodes, double dt);

  std::int32_t body_of(LocalIndex node) const { return body_of_[static_cast<std::size_t>(node)]; }
  /// Local, between `kick` and `move`.
  std::vector<ContactRigidBody> contact_bodies() const;
  /// Local. Impulses of others, one per body, the same on every rank; changes velocities and spins at once. Returns
  /// their work, J.
  double push(std::span<const BodyImpulse> impulses);

  /// J, the same on every rank.
  double kinetic_energy() const;
  double work() const;    ///< supplied by what prescribes motions
  double damped() const;  ///< taken by damping
  bool has_prescribed() const;

  std::size_t size() const { return bodies_.size(); }
  const RigidInertia& inertia(std::size_t body) const { return bodies_[body].inertia; }
  const RigidState& state(std::size_t body) const { return bodies_[body].state; }
  /// Angular velocity in space, rad/s.
  Vec3 spin(std::size_t body) const { return spin(bodies_[body]); }

  void save(CheckpointWriter& file, const std::string& prefix) const;
  void load(const CheckpointReader& file, const std::string& prefix);

 private:
  struct Body {
    RigidBody options;
    RigidInertia inertia;
    RigidState state;
    Vec3 reference_pivot{};
    double axial_inertia = 0;  ///< about the axis, kg m^2
    double rate = 0;           ///< about the axis, rad/s
    double work = 0;           ///< of prescribed motion, J
    double damped = 0;         ///< by damping, J
    // In a step.
    Vec3 velocity_before{}, spin_before{};  ///< before the kick, m/s, rad/s
    Vec3 lost{}, lost_spin{};               ///< momenta taken by damping: N s, N m s
    BodyImpulse pushed;                     ///< by others, so far
  };
  struct Held {
    LocalIndex node;
    std::int32_t body;
  };

  void find_nodes(const ElementGroups& groups);
  void find_inertia(const ElementGroups& groups, NodalState& nodes);
  template <typename Visit>
  void for_points(const ElementGroups& groups, const NodalState& nodes, Visit visit) const;
  Vec3 spin(const Body& body) const;
  Vec3 velocity_at(const Body& body, const Vec3& place) const;
  void kick_body(Body& body, const Vec3& force, const Vec3& moment, double time, double kick, double dt) const;
  void push(Body& body, const Vec3& force, double time, double kick, double dt) const;
  void turn(Body& body, const Vec3& moment, double time, double kick, double dt) const;
  static std::vector<double*> numbers(Body& body);

  const Mesh& mesh_;
  double damping_;  // 1/s
  std::vector<Body> bodies_;
  std::vector<std::int32_t> body_of_;  // of each local node, or -1
  std::vector<Held> held_;             // owned nodes, ascending
  std::vector<ExactSum> sums_;         // six per body
  std::vector<double> totals_;
  // As held_: velocities before the kick, and the forces of it.
  std::vector<Vec3> rates_before_;
  std::vector<ForceRow> force_, moment_;
};

}  // namespace tenon

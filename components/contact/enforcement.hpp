// SPDX-License-Identifier: BSD-3-Clause
// Impulses that keep surfaces apart at the end of a step: explicit Lagrange multipliers, found by iteration.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "components/contact/working_set.hpp"
#include "framework/comm/agreed_exchange.hpp"
#include "framework/simulation/contact_party.hpp"

namespace tenon::contact {

/// A node in a step.
struct NodeState {
  Vec3 place{};       ///< m, at the start
  Vec3 velocity{};    ///< m/s, by all other forces
  Vec3 former{};      ///< m/s, before the kick
  Mobility mobility;  ///< body: index in the bodies of all parties
};

/// Something rigid that several nodes, or a rigid surface, share.
struct Body {
  ContactRigidBody state;
  BodyImpulse impulse;
};

/// One unilateral constraint of a step: normal . sum(c v) >= target, with Coulomb's law across it. The impulse p on the
/// first side moves node i by w_i (c_i p + (turn p) x arm_i): the second term keeps the moment of all the impulses at
/// the places of the start zero, for any normal and any offset.
struct Constraint {
  std::int32_t pair = -1;
  std::int32_t nodes = 0;
  std::array<LocalIndex, 5> node{};
  std::array<double, 5> c{};
  Vec3 normal{};
  double gap = 0;         ///< m, at the start
  double target = 0;      ///< m/s
  Vec3 tangent_target{};  ///< m/s
  double static_coefficient = 0, kinetic_coefficient = 0;
  double softness = 0;  ///< gives way by this times its impulse over `inverse`
  bool tied = false;    ///< holds both ways, and along the surface
  bool couple = false;
  std::array<double, 9> turn{};  ///< rows
  std::array<Vec3, 5> arm{};     ///< m
  std::int32_t body = -1;        ///< on the second side, of a free rigid surface
  Vec3 body_arm{};
  Vec3 surface_velocity{}, former_surface_velocity{};  ///< of a rigid surface that moves as told

  Vec3 impulse{};  ///< N s, on the first side
  Vec3 extrapolated{};
  double inverse = 0;  ///< kg: 1 / (bound on what an impulse changes)
  bool sticks = false;
};

/// Share of node i in an impulse on the first side.
Vec3 share(const Constraint& constraint, std::size_t i, const Vec3& impulse);
/// Relative velocity that is conjugate to the impulse: power = impulse . it.
Vec3 relative_velocity(const Constraint& constraint, std::span<const Vec3> velocity, std::span<const Body> bodies,
                       const Vec3& surface_velocity);
/// Fills turn and arm so that the moment of the impulses about any point is zero. `support`: first node that takes
/// part of the couple.
void balance_moments(Constraint& constraint, std::span<const NodeState> nodes, std::size_t support);

/// Minimises the kinetic energy of the change under the constraints by projected gradients with preconditioner and
/// Nesterov's extrapolation [Nes83, MHNT15]. The preconditioner, k_q = sum_i |c_qi| s_i w_i with s_i = sum_q |c_qi|,
/// bounds what all impulses together do (an l1-Jacobi bound), so the iteration converges for any masses and any number
/// of constraints on a node. Sums of a node run over constraints in ascending order of their pairs: the same bits on
/// any number of ranks.
class Enforcement {
 public:
  /// Collective.
  Enforcement(const Communicator& comm, WorkingSet& set)
      : comm_(comm), set_(set), iteration_(comm, "contact iteration") {}

  struct Report {
    int iterations = 0;
    double residual = 0;  ///< m/s, left
  };
  /// Collective. Fills impulses (which may start from a guess); velocities() are then those after them.
  Report solve(std::span<Constraint> constraints, std::span<const NodeState> nodes, std::vector<Body>& bodies);
  /// What is to be given back to a constraint that lets go.
  struct Release {
    double energy = 0;  ///< J; 0: none
    double former = 0;  ///< m/s, relative velocity along the normal before the kick
    double free = 0;    ///< m/s, likewise after the kick, without contact
  };
  /// Collective. Adds impulses p to the chosen constraints. Their work, p (u- + u+)/2 with the velocity u- of before
  /// the kick, and what they add to the work of the impulses found so far, is the energy that each has stored; less
  /// where they share nodes.
  void release(std::span<Constraint> constraints, std::span<const NodeState> nodes, std::vector<Body>& bodies,
               std::span<const Release> releases);

  /// Local. visit(constraint, slot) for the constraints of a node that this rank sums for, ascending.
  template <typename Visit>
  void for_constraints_of(std::size_t node, Visit visit) const {
    for (std::int32_t k = first_[node]; k < first_[node + 1]; ++k) {
      const Use use = uses_[static_cast<std::size_t>(k)];
      visit(static_cast<std::size_t>(use.constraint), static_cast<std::size_t>(use.slot));
    }
  }
  /// Of all nodes of the set, after the last call: m/s.
  std::span<const Vec3> velocities() const { return velocity_; }
  /// Of the nodes that this rank sums for: N s.
  std::span<const Vec3> impulses() const { return sum_; }

 private:
  void connect(std::span<const Constraint> constraints);
  void agree(std::span<const Constraint> constraints);
  void precondition(std::span<Constraint> constraints, std::span<const NodeState> nodes, std::span<const Body> bodies,
                    std::span<const double> guess);
  template <typename Impulse>
  void move(std::span<const Constraint> constraints, std::span<const NodeState> nodes, std::vector<Body>& bodies,
            Impulse impulse);
  /// Of one step of the iteration: the greatest change of an impulse, and the greatest impulse, as velocities, m/s.
  struct Change {
    double change = 0, size = 0;
  };
  Change iterate(std::span<Constraint> constraints, std::span<const Body> bodies, double beta);
  double weight(const NodeState& node, std::span<const Body> bodies) const;

  Communicator comm_;
  WorkingSet& set_;
  AgreedExchange iteration_;  // of nodes in constraints
  std::vector<AgreedExchange::Item> send_, receive_;
  std::vector<std::size_t> used_;    // nodes that this rank sums for and that are in some constraint
  std::vector<std::int32_t> first_;  // of each node of the set: its uses begin here
  struct Use {
    std::int32_t constraint, slot;
  };
  std::vector<Use> uses_;
  std::vector<Vec3> velocity_, sum_;
  std::vector<double> crowd_;  // sum of |c| over the constraints of a node
  std::vector<double> guess_;  // of impulses that give energy back, N s; 0: none
  std::vector<double> pace_;   // m/s, twice the mean velocity that these impulses work on, but for themselves
  bool has_bodies_ = false;
};

}  // namespace tenon::contact

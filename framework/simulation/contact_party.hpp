// SPDX-License-Identifier: BSD-3-Clause
// What contact sees of a component, and what it does to it: faces and particles, places and velocities in; impulses
// out. Contact knows no component, and no component knows contact.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "framework/comm/exact_sum.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon {

/// A face that others may touch: one side of a solid's skin, or a shell.
struct ContactFace {
  GlobalId id;                      ///< unique within the party and the same on any number of ranks
  std::array<LocalIndex, 4> nodes;  ///< local nodes, outward by the right-hand rule; [3] is no_index for a triangle
  std::array<LocalIndex, 4> behind{no_index, no_index, no_index, no_index};  ///< the other nodes of a solid's element
  double thickness = 0;      ///< m, of shells; both sides touch at half of it
  double depth = 0;          ///< m, of solids: how far the element reaches behind the face
  std::int32_t surface = 0;  ///< which of surface_names() it belongs to
  bool two_sided = false;    ///< of shells
};

/// A node that touches as a ball: an SPH particle, or what is left of eroded elements.
struct ContactParticle {
  LocalIndex node;
  double radius;  ///< m
  std::int32_t surface = 0;
};

/// What an impulse p (N s) on a node changes: dv = w p with w symmetric (xx yy zz xy yz zx), 1/kg; zero where the
/// node is held. Of a node of a rigid body the body's own numbers count instead.
struct Mobility {
  std::array<double, 6> w{};
  std::int32_t body = -1;  ///< index in rigid_bodies(), or -1
};

/// dv (m/s) of a node by an impulse (N s); not of rigid bodies.
inline Vec3 moved(const Mobility& m, const Vec3& p) {
  const std::array<double, 6>& w = m.w;
  return {w[0] * p[0] + w[3] * p[1] + w[5] * p[2], w[3] * p[0] + w[1] * p[1] + w[4] * p[2],
          w[5] * p[0] + w[4] * p[1] + w[2] * p[2]};
}

/// A rigid body of a party; the same on every rank. Rows of held components and axes are zero.
struct ContactRigidBody {
  Vec3 inverse_mass{};                      ///< along x, y, z: 1/kg
  std::array<double, 9> inverse_inertia{};  ///< about the pivot, in space, 1/(kg m^2)
  Vec3 pivot{};                             ///< m, at the present positions
  Vec3 velocity{}, spin{};                  ///< after the kick: m/s, rad/s
  Vec3 former_velocity{}, former_spin{};    ///< before it
};

/// Impulses on a rigid body: N s, and N m s about its pivot.
struct BodyImpulse {
  Vec3 linear{}, angular{};
};

/// Fields of the nodes that contact fills and the party shows; of owned nodes, zero where nothing touches.
struct ContactFields {
  std::vector<Vec3> force;            ///< N, of the last step
  std::vector<Vec3> slip;             ///< m, tangential way since the start of each contact
  std::vector<double> gap;            ///< m; infinite where nothing is near
  std::vector<double> status;         ///< 0 free, 1 near, 2 slipping, 3 sticking (or without friction: touching)
  std::vector<double> pressure;       ///< Pa, of the last step
  std::vector<double> friction_heat;  ///< J, waiting to be taken by another component
};

/// A component that takes part in contact. A step has two halves: begin_step of every party, contact, end_step.
class ContactParty {
 public:
  virtual ~ContactParty() = default;

  virtual const Mesh& contact_mesh() const = 0;
  /// Local; the same on every rank. Names that pairs are given by: blocks.
  virtual std::vector<std::string> surface_names() const = 0;
  /// Local. Each face on one rank, which has all of its nodes, ascending by id; after erosion those that are left and
  /// exposed.
  virtual void contact_faces(std::vector<ContactFace>& faces) const = 0;
  virtual void contact_particles(std::vector<ContactParticle>&) const {}
  /// Local; the same on every rank. sqrt(conductivity density specific heat) of a surface's material, by which heat of
  /// friction is shared with what it rubs on, W s^0.5/(m^2 K); 0 where it is not known.
  virtual double effusivity(std::int32_t) const { return 0; }
  /// Changes, on every rank alike, when faces or particles do.
  virtual std::int64_t surface_version() const = 0;

  /// Local. Owned nodes, ascending, whose velocities before the kick are to be remembered from the next begin_step on.
  virtual void watch(std::span<const LocalIndex> nodes) = 0;
  /// Local, between the halves. Of all nodes, owned ones right: present places x(n), m, and velocities after the
  /// kick, m/s.
  virtual std::span<const Vec3> contact_positions() const = 0;
  virtual std::span<const Vec3> contact_velocities() const = 0;
  /// Length of the present kick, s: force times it is impulse.
  virtual double contact_kick() const = 0;
  /// Of the watched nodes, in their order: velocities before the kick, m/s.
  virtual std::span<const Vec3> former_velocities() const = 0;
  /// Of owned nodes, between the halves.
  virtual void mobilities(std::span<const LocalIndex> nodes, std::span<Mobility> mobility) const = 0;
  virtual std::vector<ContactRigidBody> contact_rigid_bodies() const { return {}; }

  /// Collective, between the halves. Impulses on owned nodes (N s; none of rigid bodies) and, the same on every rank,
  /// on all rigid bodies (empty: none). Velocities change at once; the work, p . (v- + v+)/2, is booked as
  /// `contact_work`.
  virtual void push(std::span<const LocalIndex> nodes, std::span<const Vec3> impulses,
                    std::span<const BodyImpulse> bodies) = 0;
  /// Collective, before the first step. Moves owned nodes (m) without stress or strain.
  virtual void shift(std::span<const LocalIndex> nodes, std::span<const Vec3> by) = 0;
  /// This rank's share of the work of all pushes since the start, J; row `contact_work` of the party.
  virtual ExactSum contact_work() const = 0;

  /// Made, of the size of the mesh, when contact first asks for it.
  virtual ContactFields& contact_fields() = 0;
};

}  // namespace tenon

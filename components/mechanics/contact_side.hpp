// SPDX-License-Identifier: BSD-3-Clause
// What contact sees of a mechanical body, and what it does to it.
#pragma once

#include "components/mechanics/contact_faces.hpp"
#include "components/mechanics/erosion.hpp"
#include "components/mechanics/loads.hpp"
#include "components/mechanics/nodal_conditions.hpp"
#include "components/mechanics/rigid_bodies.hpp"
#include "components/mechanics/ties.hpp"

namespace tenon {

/// Impulses come after the kick and all conditions of a step, and leave the velocities along held directions as they
/// are; what they bring there, the reactions take up. With dv the change by an impulse p, f the resisting force and k
/// the length of the kick, the books of the step stay exact:
///   contact_work   += p . (v- + v+)/2
///   internal_work  += k f . dv/2
///   reactions      -= (p . d) d . (v- + v+)/2 for each held direction d.
class ContactSide final : public ContactParty {
 public:
  /// Of the component, which outlives this.
  struct Parts {
    const Mesh& mesh;
    const MechanicsOptions& options;
    const ElementGroups& groups;
    NodalState& nodes;
    NodalConditions& conditions;
    RigidBodies& rigid;
    const Ties& ties;
    const LooseNodes* loose;  // null where no element can die
    Loads& loads;
  };
  /// Collective.
  explicit ContactSide(const Parts& parts);

  const Mesh& contact_mesh() const override { return parts_.mesh; }
  std::vector<std::string> surface_names() const override;
  void contact_faces(std::vector<ContactFace>& faces) const override { faces_.list(parts_.groups, faces); }
  double effusivity(std::int32_t surface) const override;
  void contact_particles(std::vector<ContactParticle>& particles) const override {
    particles.clear();
    if (parts_.loose) parts_.loose->particles(parts_.groups, parts_.nodes, particles);
  }
  std::int64_t surface_version() const override { return version_; }
  void watch(std::span<const LocalIndex> nodes) override;
  std::span<const Vec3> contact_positions() const override { return parts_.nodes.position(); }
  std::span<const Vec3> contact_velocities() const override { return parts_.nodes.velocity(); }
  double contact_kick() const override { return kick_; }
  std::span<const Vec3> former_velocities() const override { return {former_.data(), chosen_}; }
  void mobilities(std::span<const LocalIndex> nodes, std::span<Mobility> mobility) const override;
  std::vector<ContactRigidBody> contact_rigid_bodies() const override { return parts_.rigid.contact_bodies(); }
  void push(std::span<const LocalIndex> nodes, std::span<const Vec3> impulses,
            std::span<const BodyImpulse> bodies) override;
  void shift(std::span<const LocalIndex> nodes, std::span<const Vec3> by) override;
  ExactSum contact_work() const override;
  ContactFields& contact_fields() override;

  /// Local. Remembers the velocities before the kick, which takes `kick` seconds.
  void begin(double kick);
  /// Collective. Before the drift over dt: walls stop what impulses have sent through them, and ties follow.
  void end(double dt);
  /// Elements have died, on some rank.
  void change_surface() { ++version_; }
  /// Null until contact has asked for them.
  ContactFields* fields() { return fields_.get(); }

  /// J, by impulses on nodes, and on rigid bodies (the same on every rank): what a restart needs.
  std::vector<double>& node_work() { return work_; }
  double& body_work() { return body_work_; }
  /// Faces that ties cover, of all ranks.
  std::int64_t left_out() const { return left_out_; }
  std::int64_t memory() const;

 private:
  static std::vector<char> tied(const Parts& parts);
  Mobility undamped(LocalIndex node) const;
  Mobility mobility(LocalIndex node) const;
  void push_node(LocalIndex node, const Vec3& impulse);
  void change_velocity(LocalIndex node, const Vec3& dv);
  void push_through_ties();

  Parts parts_;
  ContactFaces faces_;
  std::int64_t version_ = 0;
  double kick_ = 0;
  std::vector<LocalIndex> watched_;  // those that contact has chosen, then others that ties push
  std::size_t chosen_ = 0;
  std::vector<std::int32_t> place_;  // of each local node in watched_, or -1
  std::vector<Vec3> former_;         // as watched_: velocities before the kick
  std::vector<Vec3> impulse_;        // as watched_: of this step so far, N s
  std::vector<double> work_;         // of each local node, J
  double body_work_ = 0;
  std::vector<double> tied_compliance_;  // as ties.nodes(), 1/kg
  std::vector<Vec3> tied_impulse_;       // of each local node, N s; only with ties
  // Of rigid bodies, only with ties: six sums each.
  std::vector<ExactSum> shared_;
  std::vector<double> shared_total_;
  std::vector<BodyImpulse> shared_impulse_;
  std::int64_t left_out_ = 0;
  std::unique_ptr<ContactFields> fields_;
};

}  // namespace tenon

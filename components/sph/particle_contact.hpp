// SPDX-License-Identifier: BSD-3-Clause
// Particles as contact sees them: balls at the nodes of their mesh.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "components/sph/home_exchange.hpp"
#include "components/sph/particle_data.hpp"
#include "components/sph/particle_decomposition.hpp"
#include "components/sph/sph_options.hpp"
#include "framework/simulation/contact_party.hpp"
#include "framework/simulation/distant_party.hpp"

namespace tenon {

/// Places and velocities come home after each kick; contact meets them there, and changed velocities go back. Nothing
/// travels while no particle is near anything.
class ParticleContact final : public ContactParty, public DistantParty {
 public:
  struct Parts {
    const Mesh& mesh;
    const SphOptions& options;
    ParticleData& particles;
    ParticleDecomposition& decomposition;
    HomeExchange& home;
    std::function<void()> moved;  ///< collective: after places changed without a step
  };
  /// Collective.
  explicit ParticleContact(const Parts& parts);

  const Mesh& contact_mesh() const override { return parts_.mesh; }
  std::vector<std::string> surface_names() const override;
  void contact_faces(std::vector<ContactFace>& faces) const override { faces.clear(); }
  void contact_particles(std::vector<ContactParticle>& particles) const override;
  double effusivity(std::int32_t surface) const override;
  std::int64_t surface_version() const override { return version_; }
  void watch(std::span<const LocalIndex> nodes) override;
  std::span<const Vec3> contact_positions() const override { return position_; }
  std::span<const Vec3> contact_velocities() const override { return velocity_; }
  double contact_kick() const override { return kick_; }
  std::span<const Vec3> former_velocities() const override { return watched_former_; }
  void mobilities(std::span<const LocalIndex> nodes, std::span<Mobility> mobility) const override;
  void push(std::span<const LocalIndex> nodes, std::span<const Vec3> impulses,
            std::span<const BodyImpulse> bodies) override;
  void shift(std::span<const LocalIndex> nodes, std::span<const Vec3> by) override;
  ExactSum contact_work() const override;
  ContactFields& contact_fields() override;
  void rest(std::span<const double> inverse_square) override;
  bool resting() const override { return resting_; }
  double used_squared(const Vec3& before, const Vec3& step, double dt) const override;
  void show() override;

  /// Collective. Masses, radii and places at the start of a run.
  void initialize();
  /// Collective. After particles came in.
  void renew() {
    initialize();
    ++version_;
  }
  /// Collective, after the kick.
  void begin(double kick);
  /// Collective, before the drift.
  void end();
  ContactFields* fields() { return fields_.get(); }
  std::vector<double>& node_work() { return work_; }
  std::int64_t memory() const;
  /// How often since the start places and velocities came home, and velocities went back.
  std::int64_t times_home() const { return times_home_; }
  std::int64_t times_back() const { return times_back_; }

 private:
  void find_surfaces();
  Vec3 within(const Vec3& a) const;
  void bring(const Column& column, std::vector<Vec3>& nodes);
  void bring_all();

  Parts parts_;
  std::vector<std::int32_t> surface_;  // of nodes; -1: what does not touch
  std::vector<double> inverse_mass_, radius_, work_;
  std::vector<Vec3> position_, velocity_, former_, impulse_;
  std::vector<double> leaving_, arrived_;
  std::vector<LocalIndex> watched_;
  std::vector<Vec3> watched_former_;
  std::unique_ptr<ContactFields> fields_;
  Column& sought_;  // where a particle was when sought, m, and 1/m^2 of its skin
  double kick_ = 0;
  std::int64_t version_ = 0;
  std::int64_t times_home_ = 0, times_back_ = 0;
  bool pushed_ = false, resting_ = false;
};

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Smoothed particle hydrodynamics: fluids, gases and solids of particles, with a dynamic decomposition of their own.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/sph/formulation.hpp"
#include "components/sph/home_exchange.hpp"
#include "components/sph/particle_contact.hpp"
#include "components/sph/particle_data.hpp"
#include "components/sph/particle_decomposition.hpp"
#include "components/sph/particle_heat.hpp"
#include "components/sph/sph_options.hpp"
#include "framework/comm/directory.hpp"
#include "framework/simulation/component.hpp"
#include "framework/simulation/debris.hpp"

namespace tenon {

/// Particles are the nodes of a mesh of particle elements, one each. The mesh stays where it was distributed ("home"):
/// there, fields are shown and contact is met. The work is done on copies that follow the particles through space
/// (ParticleDecomposition); what is needed at home returns by a plan (HomeExchange).
///
/// Velocities live half a step behind places, as in Mechanics, so both can meet in contact. The work of each force at
/// the kicks, m a . (v- + v+)/2, is exactly the change of the kinetic energy of the half-step velocities.
class Sph final : public Component, public DebrisTarget {
 public:
  /// Collective. Throws Error(usage) where options and mesh do not fit.
  Sph(std::string name, std::shared_ptr<const Mesh> mesh, SphOptions options);
  ~Sph() override;

  std::string_view type() const override { return "sph"; }
  const Mesh& mesh() const override { return *mesh_; }

  void initialize() override;
  double time_step() override { return stable_step_; }
  StepLimiter limiter() override;
  void advance(double dt) override;
  void begin_step(double dt) override;
  void end_step(double dt) override;
  ContactParty* contact_party() override;

  std::vector<ExportPort> exports() override;
  std::vector<ImportPort> imports() override;
  std::span<const Vec3> current_coordinates() const override;

  void energies(std::vector<EnergyTerm>& terms) override;
  std::vector<HistoryValue> history_values() override;
  std::vector<SkipCount> skips() const override;
  std::vector<std::string> warnings() const override { return warnings_; }

  GlobalId waiting(const std::string& block) const override;
  void wake(const std::string& block, std::span<const Debris> debris) override;

  void save(CheckpointWriter& file) override;
  void load(const CheckpointReader& file) override;

  std::int64_t work_done() const override { return work_done_; }
  std::int64_t memory() const override;

  /// For tests and programs.
  const ParticleData& particles() const { return particles_; }
  ParticleDecomposition& decomposition() { return *decomposition_; }
  const Formulation& formulation() const { return *formulation_; }
  /// How often since the start contact had places and velocities brought home, and sent velocities back.
  std::int64_t times_home() const { return contact_ ? contact_->times_home() : 0; }
  std::int64_t times_back() const { return contact_ ? contact_->times_back() : 0; }

 private:
  void place_particles();
  void refuse_misfits() const;
  bool bring_in();
  void find_waiting();
  void place(std::size_t particle, LocalIndex node);
  std::int32_t body_of_block(const std::string& block) const;
  void show_nothing_of_waiting(std::span<double> nodes, int components) const;
  void save_waiting(CheckpointWriter& file);
  void load_waiting(const CheckpointReader& file);
  void set_velocities();
  void kick(double dt);
  void settle();
  void drift(double dt);
  void compute(double dt);
  Formulation::Limit stable_limit() const;
  void choose_step();
  [[noreturn]] void fail(const std::string& what, std::size_t particle);
  std::string describe(std::size_t particle) const;
  bool is_wall(std::size_t particle) const {
    return options_.bodies[static_cast<std::size_t>(particles_.body[particle])].wall;
  }

  std::shared_ptr<const Mesh> mesh_;
  SphOptions options_;
  ParticleData particles_;
  std::unique_ptr<ParticleDecomposition> decomposition_;
  std::unique_ptr<ParticleHeat> heat_;  // of solids, and where heat is conducted
  std::unique_ptr<Formulation> formulation_;
  std::unique_ptr<HomeExchange> home_;
  std::unique_ptr<ParticleContact> contact_;  // if asked for
  std::vector<ForcePart> forces_;
  Column* gravity_work_ = nullptr;   // kept, J
  Column* boundary_work_ = nullptr;  // of walls, J
  Column* inflow_energy_ = nullptr;  // of particles when they became free, J
  Column* debris_heat_ = nullptr;    // of what elements became, beyond its motion, J
  Column* debris_work_ = nullptr;    // what they brought in all, J
  bool has_gravity_ = false, has_walls_ = false;
  std::vector<std::int32_t> node_body_;  // of all nodes of the mesh
  std::vector<Vec3> told_;               // velocities of walls in this step, m/s
  std::vector<char> waits_;              // of all nodes: 1 while the particle is not there; empty if none ever waits
  std::unique_ptr<Directory> homes_;     // of nodes, if some may wait
  mutable std::vector<Vec3> shown_places_;
  mutable std::int64_t shown_steps_ = -1;

  double previous_dt_ = 0, stable_step_ = 0, kick_ = 0;
  std::string limited_by_;
  bool loaded_ = false;
  std::int64_t steps_ = 0, work_done_ = 0, renewals_ = 0;
  std::vector<std::string> warnings_;

  struct Phases {
    PhaseTimer *forces, *update, *order, *halo;
  } phases_{};
};

}  // namespace tenon

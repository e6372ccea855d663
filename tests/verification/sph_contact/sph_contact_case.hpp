// SPDX-License-Identifier: BSD-3-Clause
// What cases of particles in contact with elements have in common: a run of both, their momenta, ledgers, and bits.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "contact_case.hpp"
#include "framework/mesh/particle_bodies.hpp"
#include "sph_case.hpp"

namespace tenon::testing {

/// A mesh of elements and one of particles, and contact between them.
struct ParticlesOnMesh {
  MeshData mesh, particles;
  MechanicsOptions mechanics;
  SphOptions sph;
  ContactOptions contact;
  double end = 1;  ///< s
};

class ParticlesOnMeshRun {
 public:
  using Extend = std::function<void(Simulation&, Component& body, Component& particles)>;
  /// Collective. `checkpoint` continues an earlier run; `extend` adds what else there is.
  explicit ParticlesOnMeshRun(const ParticlesOnMesh& scene, const Communicator& comm = communicator(),
                              const std::string& checkpoint = "", const Extend& extend = {})
      : comm_(comm), simulation_(comm, log_, 0, scene.end) {
    MeshData mesh = scene.mesh, particles = scene.particles;
    DistributeOptions by_place;
    by_place.method = PartitionMethod::rcb;
    body_ = static_cast<Mechanics*>(
        &simulation_.add(std::make_unique<Mechanics>("body", distribute(comm, std::move(mesh), {}), scene.mechanics)));
    sph_ = static_cast<Sph*>(&simulation_.add(
        std::make_unique<Sph>("particles", distribute(comm, std::move(particles), by_place), scene.sph)));
    contact_ = static_cast<Contact*>(&simulation_.add(
        std::make_unique<Contact>("contact", comm, std::vector<Component*>{body_, sph_}, scene.contact)));
    if (extend) extend(simulation_, *body_, *sph_);
    if (checkpoint.empty()) {
      simulation_.initialize();
    } else {
      const CheckpointReader reader(comm, checkpoint);
      simulation_.initialize(&reader);
    }
    start_ = momentum();
  }

  Simulation& simulation() { return simulation_; }
  Sph& sph() { return *sph_; }
  Mechanics& body() { return *body_; }
  Contact& contact() { return *contact_; }
  double time() const { return simulation_.time(); }

  void step() {
    simulation_.step();
    const auto [linear, angular] = contact_->momentum_errors();
    linear_ = std::max(linear_, linear), angular_ = std::max(angular_, angular);
  }
  void steps(
      int count, const std::function<void()>& look = [] {}) {
    for (int s = 0; s < count && !simulation_.done(); ++s) step(), look();
  }
  void run(const std::function<void()>& look = [] {}) {
    while (!simulation_.done()) step(), look();
  }

  Vec3 momentum() const {
    std::array<ExactSum, 3> sums;
    const std::span<const Vec3> v = body_->contact_party()->contact_velocities();
    for (const LocalIndex n : body_->mesh().owned_nodes)
      for (std::size_t c = 0; c < 3; ++c)
        sums[c].add(body_->nodal_mass()[static_cast<std::size_t>(n)] * v[static_cast<std::size_t>(n)][c]);
    const ParticleData& p = sph_->particles();
    for (std::size_t i = 0; i < p.owned(); ++i)
      for (std::size_t c = 0; c < 3; ++c) sums[c].add(p.mass[i] * p.velocity[3 * i + c]);
    return {comm_.sum(sums[0]), comm_.sum(sums[1]), comm_.sum(sums[2])};
  }
  Vec3 momentum_of_particles() const {
    Vec3 total{};
    for (std::size_t c = 0; c < 3; ++c) {
      ExactSum sum;
      const ParticleData& p = sph_->particles();
      for (std::size_t i = 0; i < p.owned(); ++i) sum.add(p.mass[i] * p.velocity[3 * i + c]);
      total[c] = comm_.sum(sum);
    }
    return total;
  }
  const Vec3& start() const { return start_; }
  double ledger_error() { return simulation_.ledger().take().error; }
  /// Greatest residuals of momentum in any step of contact.
  double momentum_residual() const { return std::max(linear_, angular_); }
  /// Least coordinate of any particle along an axis, m.
  double lowest(std::size_t axis) const {
    double least = 1e300;
    const ParticleData& p = sph_->particles();
    for (std::size_t i = 0; i < p.owned(); ++i) least = std::min(least, p.position[3 * i + axis]);
    return comm_.min(least);
  }
  void save(const std::string& file) {
    CheckpointWriter writer(comm_, file);
    simulation_.save(writer);
    writer.finish();
  }
  /// Collective. Velocities of all nodes and places and velocities of all particles by id, on rank 0.
  std::vector<double> state() const {
    std::vector<double> all;
    gather_nodes(body_->mesh(), body_->contact_party()->contact_velocities(), all);
    const ParticleData& p = sph_->particles();
    for (const Column* column : {&p.position, &p.velocity}) {
      const std::vector<GlobalId> ids = comm_.gather(std::span<const GlobalId>(p.ids).first(p.owned()));
      const std::vector<double> values = comm_.gather(std::span<const double>(column->values).first(3 * p.owned()));
      std::vector<double> ordered(3 * static_cast<std::size_t>(sph_->mesh().global_nodes));
      for (std::size_t k = 0; k < ids.size(); ++k)
        std::copy_n(&values[3 * k], 3, &ordered[3 * static_cast<std::size_t>(ids[k])]);
      all.insert(all.end(), ordered.begin(), ordered.end());
    }
    return all;
  }

 private:
  void gather_nodes(const Mesh& mesh, std::span<const Vec3> values, std::vector<double>& all) const {
    std::vector<GlobalId> ids;
    std::vector<double> mine;
    for (const LocalIndex n : mesh.owned_nodes) {
      ids.push_back(mesh.node_ids[static_cast<std::size_t>(n)]);
      for (const double v : values[static_cast<std::size_t>(n)]) mine.push_back(v);
    }
    const std::vector<GlobalId> every = comm_.gather(std::span<const GlobalId>(ids));
    const std::vector<double> flat = comm_.gather(std::span<const double>(mine));
    std::vector<double> ordered(flat.size());
    for (std::size_t k = 0; k < every.size(); ++k)
      std::copy_n(&flat[3 * k], 3, &ordered[3 * static_cast<std::size_t>(every[k])]);
    all.insert(all.end(), ordered.begin(), ordered.end());
  }

  Log log_{false};
  Communicator comm_;
  Simulation simulation_;
  Mechanics* body_ = nullptr;
  Sph* sph_ = nullptr;
  Contact* contact_ = nullptr;
  Vec3 start_{};
  double linear_ = 0, angular_ = 0;
};

}  // namespace tenon::testing

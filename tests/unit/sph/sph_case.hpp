// SPDX-License-Identifier: BSD-3-Clause
// What tests of particles have in common: boxes of particles side by side, runs, momenta, and what is at home.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "components/sph/sph.hpp"
#include "framework/mesh/generators.hpp"
#include "framework/mesh/mesh.hpp"
#include "framework/simulation/simulation.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon::testing {

/// Blocks of particles in one mesh, each with the name given.
inline MeshData particle_bodies(std::vector<std::pair<std::string, MeshData>> bodies) {
  MeshData all;
  all.source = "bodies of particles";
  for (auto& [name, body] : bodies) {
    const auto first = static_cast<GlobalId>(all.coordinates.size());
    BlockData block = std::move(body.blocks.front());
    block.name = name, block.label = static_cast<std::int64_t>(all.blocks.size()) + 1;
    for (GlobalId& n : block.connectivity) n += first;
    for (std::int64_t& label : block.labels) label += first;
    all.blocks.push_back(std::move(block));
    all.coordinates.insert(all.coordinates.end(), body.coordinates.begin(), body.coordinates.end());
    all.volumes.insert(all.volumes.end(), body.volumes.begin(), body.volumes.end());
  }
  for (std::size_t n = 0; n < all.coordinates.size(); ++n) all.node_labels.push_back(static_cast<std::int64_t>(n) + 1);
  return all;
}

/// A flat box of particles with `across` of them along x.
inline MeshData flat_box(const Vec3& low, const Vec3& high, int across) {
  const double spacing = (high[0] - low[0]) / across;
  ParticleBox box;
  box.low = low, box.high = high, box.dimension = 2;
  box.particles = {across, std::max(1, static_cast<int>(std::lround((high[1] - low[1]) / spacing))), 1};
  return generate(box);
}

struct SphScene {
  MeshData mesh;
  SphOptions options;
  double end = 1;  ///< s
};

class SphRun {
 public:
  /// Collective. `checkpoint` continues an earlier run.
  explicit SphRun(const SphScene& scene, const Communicator& comm = communicator(), const std::string& checkpoint = "")
      : comm_(comm), simulation_(comm, log_, 0, scene.end) {
    MeshData data = scene.mesh;
    DistributeOptions options;
    options.method = PartitionMethod::rcb, options.name = "particles";
    body_ = static_cast<Sph*>(&simulation_.add(
        std::make_unique<Sph>("particles", distribute(comm, std::move(data), options), scene.options)));
    if (checkpoint.empty()) {
      simulation_.initialize();
    } else {
      const CheckpointReader reader(comm, checkpoint);
      simulation_.initialize(&reader);
    }
  }

  Sph& body() { return *body_; }
  const ParticleData& particles() const { return body_->particles(); }
  const NeighbourLists& lists() const { return body_->decomposition().lists(); }
  const Communicator& comm() const { return comm_; }
  Simulation& simulation() { return simulation_; }
  double time() const { return simulation_.time(); }
  void step() { simulation_.step(); }
  void run(
      double end, const std::function<void()>& look = [] {}) {
    while (!simulation_.done() && simulation_.time() < end) step(), look();
  }
  void steps(
      int count, const std::function<void()>& look = [] {}) {
    for (int s = 0; s < count && !simulation_.done(); ++s) step(), look();
  }

  /// Collective. Sums over all owned particles, exact.
  template <typename Value>
  double sum(Value&& value) const {
    ExactSum local;
    const ParticleData& p = body_->particles();
    for (std::size_t i = 0; i < p.owned(); ++i) local.add(value(p, i));
    return comm_.sum(local);
  }
  Vec3 momentum() const {
    Vec3 total{};
    for (std::size_t c = 0; c < 3; ++c)
      total[c] = sum([c](const ParticleData& p, std::size_t i) { return p.mass[i] * p.velocity[3 * i + c]; });
    return total;
  }
  double size_of_momentum() const {
    return sum([](const ParticleData& p, std::size_t i) { return p.mass[i] * norm(p.velocity.vec(i)); });
  }
  /// x(n) x m v(n-1/2) about the origin; of the places at either end of the step, as v x v = 0.
  Vec3 angular_momentum() const {
    Vec3 total{};
    for (std::size_t c = 0; c < 3; ++c)
      total[c] = sum([c](const ParticleData& p, std::size_t i) {
        return p.mass[i] * cross(p.position.vec(i), p.velocity.vec(i))[c];
      });
    return total;
  }
  /// Rows of the ledger and its error.
  double row(const std::string& name) {
    for (const LedgerRow& r : simulation_.ledger().take().rows)
      if (r.row == name) return r.value;
    return 0;
  }
  double ledger_error() { return simulation_.ledger().take().error; }

  /// Collective. A column of all particles by id, on rank 0.
  std::vector<double> gathered(const std::string& column) const {
    const ParticleData& p = body_->particles();
    const Column& values = *p.find(column);
    const auto n = static_cast<std::size_t>(values.components);
    const std::vector<GlobalId> ids = comm_.gather(std::span<const GlobalId>(p.ids).first(p.owned()));
    const std::vector<double> all = comm_.gather(std::span<const double>(values.values).first(n * p.owned()));
    std::vector<double> ordered(all.size());
    for (std::size_t k = 0; k < ids.size(); ++k)
      std::copy_n(&all[n * k], n, &ordered[n * static_cast<std::size_t>(ids[k])]);
    return ordered;
  }

 private:
  Log log_{false};
  Communicator comm_;
  Simulation simulation_;
  Sph* body_ = nullptr;
};

/// A material of a linear or polynomial equation of state with this speed of sound.
inline MaterialDescription liquid(double density, double sound) {
  MaterialDescription material;
  material.name = "liquid", material.density = density;
  PolynomialState state;
  state.C[1] = density * sound * sound;
  EquationOfState equation;
  equation.law = state;
  material.equation_of_state = equation;
  return material;
}

inline SphBody body_of(const std::string& name, const MaterialDescription& material) {
  SphBody body;
  body.name = name, body.material = material;
  return body;
}

}  // namespace tenon::testing

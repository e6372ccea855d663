// SPDX-License-Identifier: BSD-3-Clause
// The way between the nodes of the mesh, which stay where they are, and the particles, which go from rank to rank.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "components/sph/particle_data.hpp"
#include "framework/comm/exchange_plan.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon {

/// Values per node of the mesh (its owned ones, at their local index) and per owned particle. The plan is made when
/// something is first asked for after particles changed ranks or places.
class HomeExchange {
 public:
  HomeExchange(const Mesh& mesh, const ParticleData& particles, std::string name);

  /// Collective. Of particles, to their nodes. `version` is that of the decomposition.
  void to_nodes(std::int64_t version, std::span<const double> particles, std::span<double> nodes, int components);
  /// Collective. Of nodes, to their particles.
  void to_particles(std::int64_t version, std::span<const double> nodes, std::span<double> particles, int components);

 private:
  void follow(std::int64_t version);

  const Mesh& mesh_;
  const ParticleData& particles_;
  std::string name_;
  ExchangePlan plan_;
  std::vector<LocalIndex> node_;  // of each arriving particle
  std::vector<double> room_;
  std::int64_t version_ = -1;
};

}  // namespace tenon

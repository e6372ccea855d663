// SPDX-License-Identifier: BSD-3-Clause
// Loads on nodes: given forces, and acceleration fields on their mass.
#pragma once

#include "components/mechanics/load.hpp"
#include "components/mechanics/load_options.hpp"

namespace tenon {

/// factor(n) * value(t, X_n) on each of some nodes.
class NodalLoad final : public Load {
 public:
  /// Collective. A force on node sets.
  NodalLoad(const Mesh& mesh, const NodalForce& force);
  /// Collective. An acceleration field on the mass of blocks. The mass that counts is that of the elements as
  /// described, without what mass scaling adds; in rigid blocks
  /// shares keep the centre of mass.
  NodalLoad(const Mesh& mesh, const BodyForce& force, const ElementGroups& groups);

  std::vector<LocalIndex> nodes() const override { return nodes_; }
  void add_forces(const LoadState& state, std::span<ForceRow> force) const override;

 private:
  std::span<const Vec3> reference_;
  std::array<SpaceTimeFunction, 3> value_;
  std::vector<LocalIndex> nodes_;
  std::vector<double> factor_;  // as nodes_
};

}  // namespace tenon

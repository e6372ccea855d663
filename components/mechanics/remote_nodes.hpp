// SPDX-License-Identifier: BSD-3-Clause
// Values of nodes that may live on any rank.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "framework/mesh/mesh.hpp"

namespace tenon {

/// Brings vectors of chosen nodes, by global id, from their owners: one message per neighbour.
class RemoteNodes {
 public:
  RemoteNodes() = default;
  /// Collective. Each rank chooses its own; an id may come more than once.
  RemoteNodes(const Mesh& mesh, std::span<const GlobalId> wanted, std::string name);
  /// Collective. Values (of all local nodes; owned ones count) into one place per wanted node.
  void pull(std::span<const Vec3> local, std::span<Vec3> wanted) const;
  std::size_t size() const { return size_; }

 private:
  ExchangePlan plan_;
  std::size_t size_ = 0;
};

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Values of nodes that may live on any rank.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "framework/mesh/mesh.hpp"

namespace tenon {

/// Brings values of chosen nodes, by global id, from their owners: one message per neighbour.
class RemoteNodes {
 public:
  RemoteNodes() = default;
  /// Collective. Each rank chooses its own; an id may come more than once.
  RemoteNodes(const Mesh& mesh, std::span<const GlobalId> wanted, std::string name);
  /// Collective. Values (of all local nodes; owned ones count) into one place per wanted node.
  template <typename T>
  void pull(std::span<const T> local, std::span<T> wanted) const {
    plan_.forward<T>(local, wanted);
  }

 private:
  ExchangePlan plan_;
};

}  // namespace tenon

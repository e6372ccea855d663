// SPDX-License-Identifier: BSD-3-Clause
// Between whole arrays on rank 0, as files hold them, and the items of a distributed mesh.
#pragma once

#include <span>
#include <vector>

#include "framework/fields/field.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon {

/// Nodes or elements in the order of their global ids on rank 0, and local items (ghosts too) everywhere.
class RootOrder {
 public:
  /// Collective. `location` is node or element.
  RootOrder(const Mesh& mesh, Location location);
  /// Collective. `whole`: all items x components on rank 0, nothing elsewhere.
  std::vector<double> to_local(std::span<const double> whole, int components) const;
  /// Collective. The other way; empty but on rank 0. Copies of an item must have the same value.
  std::vector<double> to_root(std::span<const double> local, int components) const;

 private:
  ExchangePlan plan_;
  std::size_t local_ = 0, whole_ = 0;
};

}  // namespace tenon

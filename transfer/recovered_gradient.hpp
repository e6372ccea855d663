// SPDX-License-Identifier: BSD-3-Clause
// Gradients of nodal or element values, recovered from the elements around, at some items of a mesh.
#pragma once

#include <string>
#include <vector>

#include "transfer/rows.hpp"
#include "transfer/sparse_rows.hpp"

namespace tenon::transfer {

/// At a node, the mean of the gradients at the centres of the elements around, weighted by volume. In an element, the
/// gradient that fits the differences from its own value of the means at its nodes best, each being the mean over the
/// elements around at the mean of their centres: exact for linear fields, also at boundaries. Made once, it costs a
/// few dozen products for each item and application.
class RecoveredGradient {
 public:
  /// Collective. At the items `wanted` of the side's location, which this rank owns, ascending.
  RecoveredGradient(const Side& side, std::span<const LocalIndex> wanted, const std::string& name);

  /// Collective. `values` of all local items, of one component; sets the gradients (1/m) of the wanted items, by local
  /// index.
  void apply(std::span<const double> values, std::span<Vec3> gradients) const;

 private:
  void at_nodes(const Side& side, std::span<const LocalIndex> wanted);
  void in_elements(const Side& side, std::span<const LocalIndex> wanted, const std::string& name);

  std::vector<LocalIndex> wanted_;
  bool by_node_;
  /// By node: three rows (x, y, z) for each wanted node. By element: a row for each node whose mean is asked for.
  SparseRows<double> rows_;
  ExchangePlan means_;  ///< of nodes, from their owners
  /// By element: what the mean at a node, less the element's value, adds to the gradient.
  struct Part {
    LocalIndex mean;
    Vec3 weight;
  };
  std::vector<std::size_t> first_part_{0};
  std::vector<Part> parts_;
  mutable std::vector<double> product_, arrived_;
};

}  // namespace tenon::transfer

// SPDX-License-Identifier: BSD-3-Clause
// The stable step of the assembled mesh, which can be well above that of its elements one by one.
#pragma once

#include <memory>
#include <vector>

#include "components/mechanics/element_groups.hpp"

namespace tenon {

/// Finds the greatest eigenvalue of M^-1 (dt^2/4 K + dt/2 C) by the Lanczos process ([Par98], ch. 13) on products of
/// the elements with vectors; no matrix is formed. The largest Ritz value plus its residual is taken, so the step comes
/// out below the limit. Sums are exact and the start vector belongs to the places of the nodes: the same bits on any
/// number of ranks, and steps that differ by round-off only when nodes are numbered otherwise.
class AssembledStep {
 public:
  AssembledStep(const Mesh& mesh, const NodalState& nodes);

  /// Collective. The greatest stable step of free nodes, s, at the present geometry, moduli and rates; `bound` is a
  /// step that is stable for certain. All groups must have products.
  double find(NodalState& nodes, const ElementGroups& groups, double bound);
  /// Products of the last search.
  int products() const { return products_; }

 private:
  void start(const NodalState& nodes);
  void multiply(NodalState& nodes, const ElementGroups& groups, double stiffness, double damping);
  double product(const std::vector<Vec3>& a, const std::vector<Vec3>& b) const;

  const Mesh& mesh_;
  std::vector<Vec3> before_, now_, scaled_, next_;  // of all local nodes; scaled_ has padding
  std::vector<ForceRow> force_;
  int products_ = 0;
};

/// Greatest eigenvalue of the symmetric tridiagonal matrix, and the last component of its unit eigenvector.
struct RitzValue {
  double value, last;
};
RitzValue greatest_ritz_value(const std::vector<double>& diagonal, const std::vector<double>& beside);

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// What becomes of nodes whose elements have all been taken out.
#pragma once

#include "components/mechanics/element_groups.hpp"
#include "framework/simulation/contact_party.hpp"

namespace tenon {

/// A loose node has had elements, and none is left. It keeps its share of their mass and flies on, or is removed: mass,
/// momentum and kinetic energy then leave the body, and are booked here.
class LooseNodes {
 public:
  /// Nodes that are never loose: `bound` is 1 for those of rigid bodies and ties; empty: none.
  LooseNodes(const Mesh& mesh, std::vector<char> bound);

  /// Local. Balls of the volume that the elements around each loose node have left it, ascending; of owned nodes.
  void particles(const ElementGroups& groups, const NodalState& nodes, std::vector<ContactParticle>& particles) const;
  /// Local. Takes loose nodes out of the state. Called after the step in which an element has died.
  void remove(const ElementGroups& groups, NodalState& nodes);

  /// Of a removed node: kg, kg m/s, J; zero where nothing was.
  struct Removed {
    double mass = 0;
    Vec3 momentum{};
    double energy = 0;
  };
  /// Of all local nodes (those of other ranks zero); empty until the first is removed, or a restart brings some.
  std::vector<Removed>& removed() { return removed_; }
  const std::vector<Removed>& removed() const { return removed_; }
  /// Local. After a restart: takes those that are gone out of the state again.
  void restore(NodalState& nodes) const;

 private:
  const Mesh& mesh_;
  std::vector<char> bound_;
  std::vector<Removed> removed_;
};

}  // namespace tenon

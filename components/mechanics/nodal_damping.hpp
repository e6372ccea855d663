// SPDX-License-Identifier: BSD-3-Clause
// Forces that resist the velocity of single nodes, implicit, so that they never limit the time step.
#pragma once

#include <span>
#include <vector>

#include "components/mechanics/nodal_state.hpp"
#include "components/mechanics/small_tensor.hpp"

namespace tenon {

/// -C_n (v- + v+)/2 on each node, C_n the mass-proportional damping, dashpots to the ground and non-reflecting
/// boundaries of the node together. From v+ = v- + dt/m (F - C (v- + v+)/2) follows (1 + dt/(2m) C) v = v- + dt/(2m) F
/// for the mean v, three equations a node: stable for any C, and the power taken, v.C v, is never negative.
class NodalDamping {
 public:
  /// kg/s on one node, by row of the ledger.
  struct Entry {
    LocalIndex node;
    SymmetricTensor<double> dashpot, absorbing;
  };

  NodalDamping() = default;
  /// `mass_proportional` (1/s) acts on every node; entries ascend by node.
  NodalDamping(double mass_proportional, std::vector<Entry> entries, const NodalState& nodes);

  bool empty() const { return entries_.empty(); }
  const std::vector<Entry>& entries() const { return entries_; }
  /// N.
  struct Forces {
    Vec3 damping, absorbing;
  };
  /// Forces for a kick (s) of a node whose resisting force, without these, is in the state.
  Forces forces(const Entry& entry, const NodalState& nodes, double kick) const;
  /// The entry of a node; null if nothing damps it.
  const Entry* find(LocalIndex node) const;
  /// C of an entry without its absorbing part, kg/s.
  SymmetricTensor<double> damper(const Entry& entry, const NodalState& nodes) const;
  /// Moment -C (w- + w+)/2, N m, by the mass-proportional part on a node that turns.
  Vec3 moment(const NodalState& nodes, std::size_t node, double kick) const;
  bool damps_spin() const { return mass_proportional_ > 0; }

 private:
  double mass_proportional_ = 0;
  std::vector<Entry> entries_;  // without the mass-proportional part
};

/// C = impedance_p n n + impedance_s (1 - n n), n of unit length.
inline SymmetricTensor<double> transverse_isotropic(double along, double across, const Vec3& n) {
  const double d = along - across;
  return {across + d * n[0] * n[0], across + d * n[1] * n[1], across + d * n[2] * n[2],
          d * n[0] * n[1],          d * n[1] * n[2],          d * n[2] * n[0]};
}
inline SymmetricTensor<double> operator+(const SymmetricTensor<double>& a, const SymmetricTensor<double>& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.yz + b.yz, a.zx + b.zx};
}
inline Vec3 times(const SymmetricTensor<double>& s, const Vec3& x) {
  return {s.xx * x[0] + s.xy * x[1] + s.zx * x[2], s.xy * x[0] + s.yy * x[1] + s.yz * x[2],
          s.zx * x[0] + s.yz * x[1] + s.zz * x[2]};
}

}  // namespace tenon

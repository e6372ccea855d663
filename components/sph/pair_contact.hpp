// SPDX-License-Identifier: BSD-3-Clause
// What keeps bodies of total Lagrangian particles apart: pairs that were not neighbours at the start repel each other.
#pragma once

#include <cstdint>
#include <vector>

#include "components/sph/formulation.hpp"

namespace tenon {

/// Pairs of different bodies, of places of one body that were far apart, and of failed particles repel along their line
/// when nearer than their spacing (and than at the start):
///   f = k (r0 - r),   k = stiffness (M_i + M_j)/2 s^(d-2)
/// with the moduli M of the fastest waves and the mean spacing s. Linear and angular momentum are kept.
class PairContact {
 public:
  /// `origin`: kept, place at the start, m.
  PairContact(const SphContext& context, const Column& origin);

  /// Local. Whether two bodies hold together.
  bool bonded(std::int32_t a, std::int32_t b) const {
    return bond_[static_cast<std::size_t>(a)] == bond_[static_cast<std::size_t>(b)];
  }

  /// Collective. Accelerations of owned particles at the present places, whose ghosts are up to date. `failed` (kept;
  /// null: nothing fails) marks particles that hold on to nothing any more.
  void compute(Column* failed, bool any_failed);

  Column& acceleration() { return acceleration_; }
  Column& energy() { return energy_; }
  std::int64_t touching() const { return touching_; }

 private:
  void find_candidates(const Column* failed);

  SphContext c_;
  ParticleData& p_;
  const Column& origin_;
  Column &acceleration_, &energy_;
  std::vector<std::int32_t> bond_;  // of bodies
  std::vector<double> modulus_;     // of bodies, Pa
  std::vector<std::size_t> begin_;  // of owned particles that have candidates
  std::vector<LocalIndex> who_, candidates_;
  std::int64_t version_ = -1, touching_ = 0;
};

}  // namespace tenon

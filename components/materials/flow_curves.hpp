// SPDX-License-Identifier: BSD-3-Clause
// Flow stress over equivalent plastic strain: linear, Voce, tabulated; and its rise with the rate.
#pragma once

#include <limits>

#include "components/materials/lane_root.hpp"
#include "components/materials/piecewise_linear.hpp"

namespace tenon {

/// sigma_y = yield_stress + hardening_modulus eqps.
struct LinearFlow {
  double yield_stress = 0;       ///< Pa, positive
  double hardening_modulus = 0;  ///< Pa, not negative

  void evaluate(const LaneValues& eqps, LaneValues& stress, LaneValues& slope) const;
  /// Increment d > 0 with trial - 3 G d = sigma_y(eqps + d) in the lanes that yield; 0 in the others.
  void find_increment(double three_g, const LaneValues& trial, const LaneValues& eqps, const LaneValues& yields,
                      LaneValues& increment) const;
};

/// sigma_y = yield_stress + saturation (1 - exp(-rate eqps)) + hardening_modulus eqps: [Voc55] with a linear rest.
struct VoceFlow {
  double yield_stress = 0;       ///< Pa, positive
  double saturation = 0;         ///< Pa, not negative
  double rate = 0;               ///< 1, positive
  double hardening_modulus = 0;  ///< Pa, not negative

  void evaluate(const LaneValues& eqps, LaneValues& stress, LaneValues& slope) const;
  /// The equation is concave upwards in d: Newton climbs to the root from d = 0 without overshoot.
  void find_increment(double three_g, const LaneValues& trial, const LaneValues& eqps, const LaneValues& yields,
                      LaneValues& increment) const;
};

/// Straight between the points of a table that starts at eqps = 0; beyond its end the flow stress is held. May soften,
/// by less than 3 G.
struct TableFlow {
  PiecewiseLinear table;

  void evaluate(const LaneValues& eqps, LaneValues& stress, LaneValues& slope) const;
  /// Exact: each stretch of the table takes what it can of the excess of the trial stress.
  void find_increment(double three_g, const LaneValues& trial, const LaneValues& eqps, const LaneValues& yields,
                      LaneValues& increment) const;
};

/// The flow stress times 1 + (rate / D)^(1/p), the rate being d_eqps/dt: [CS57]. None with an infinite D.
struct CowperSymonds {
  double D = std::numeric_limits<double>::infinity();  ///< 1/s, positive
  double p = 1;                                        ///< 1, at least 1
  bool active() const { return D < std::numeric_limits<double>::infinity(); }
};

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/flow_curves.hpp"

#include <limits>

namespace tenon {

void LinearFlow::evaluate(const LaneValues& eqps, LaneValues& stress, LaneValues& slope) const {
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) stress[l] = yield_stress + hardening_modulus * eqps[l], slope[l] = hardening_modulus;
}

void LinearFlow::find_increment(double three_g, const LaneValues& trial, const LaneValues& eqps,
                                const LaneValues& yields, LaneValues& increment) const {
  const double stiffness = three_g + hardening_modulus;
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double d = (trial[l] - yield_stress - hardening_modulus * eqps[l]) / stiffness;
    increment[l] = yields[l] > 0 ? d : 0.0;
  }
}

void VoceFlow::evaluate(const LaneValues& eqps, LaneValues& stress, LaneValues& slope) const {
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double left = saturation * exp_of(-rate * eqps[l]);
    stress[l] = yield_stress + (saturation - left) + hardening_modulus * eqps[l];
    slope[l] = rate * left + hardening_modulus;
  }
}

void VoceFlow::find_increment(double three_g, const LaneValues& trial, const LaneValues& eqps, const LaneValues& yields,
                              LaneValues& increment) const {
  LaneValues stress, slope, searching, low, high;
  evaluate(eqps, stress, slope);
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    const double excess = trial[l] - stress[l];
    searching[l] = yields[l];
    low[l] = 0;
    high[l] = yields[l] > 0 ? excess / three_g : 0.0;
    increment[l] = yields[l] > 0 ? excess / (three_g + slope[l]) : 0.0;  // Newton's first step
  }
  falling_root(
      [&](const LaneValues& d, LaneValues& value, LaneValues& fall) {
        LaneValues e;
#pragma GCC ivdep
        for (int l = 0; l < lanes; ++l) e[l] = eqps[l] + d[l];
        evaluate(e, value, fall);
#pragma GCC ivdep
        for (int l = 0; l < lanes; ++l) {
          value[l] = trial[l] - three_g * d[l] - value[l];
          fall[l] = -three_g - fall[l];
        }
      },
      searching, low, high, increment);
}

void TableFlow::evaluate(const LaneValues& eqps, LaneValues& stress, LaneValues& slope) const {
  table.evaluate(eqps, stress, slope);
}

void TableFlow::find_increment(double three_g, const LaneValues& trial, const LaneValues& eqps,
                               const LaneValues& yields, LaneValues& increment) const {
  LaneValues excess, slope;
  table.evaluate(eqps, excess, slope);
#pragma GCC ivdep
  for (int l = 0; l < lanes; ++l) {
    excess[l] = yields[l] > 0 ? trial[l] - excess[l] : 0.0;
    increment[l] = 0;
  }
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool last = i + 1 == table.size();
    const double start = table.x(i), end = last ? std::numeric_limits<double>::max() : table.x(i + 1);
    const double stiffness = three_g + table.slope(i);
#pragma GCC ivdep
    for (int l = 0; l < lanes; ++l) {
      const double from = eqps[l] > start ? eqps[l] : start;
      const double width = end > from ? end - from : 0.0;
      const double wanted = excess[l] / stiffness;
      const double taken = wanted < width ? wanted : width;
      increment[l] += taken;
      excess[l] = wanted < width ? 0.0 : excess[l] - taken * stiffness;
    }
  }
}

}  // namespace tenon

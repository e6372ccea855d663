// SPDX-License-Identifier: BSD-3-Clause
// Eight scalar equations at once: a safeguarded Newton iteration in which no lane looks at another.
#pragma once

#include <cmath>

#include "components/materials/batch.hpp"
#include "components/materials/lane_math.hpp"

namespace tenon {

/// One value per lane. A truth per lane is 0 or 1 in a double, so that g++ can vectorise what follows from it.
using LaneValues = double[lanes];

/// Whether a flag is set; flags are 0 or 1. Added up in pairs, which takes three additions one after the other.
[[gnu::always_inline]] inline bool any_lane(const LaneValues& flags) {
  static_assert(lanes == 8);
  double sum[4];
  for (int l = 0; l < 4; ++l) sum[l] = flags[l] + flags[l + 4];
  return (sum[0] + sum[2]) + (sum[1] + sum[3]) > 0;
}

/// x^y for x >= 0, y > 0.
[[gnu::always_inline]] inline double power_of(double x, double y) {
  constexpr double tiny = 1e-290;  // still normal after division by anything that occurs here
  const double value = exp_of(y * log_of(x > tiny ? x : tiny));
  return x > tiny ? value : 0.0;
}

/// Root of a falling function in each lane where `searching`: positive at `low`, not positive at `high`; `x` is the
/// first guess and then the root. `function(x, value, slope)` evaluates all lanes. Newton steps, halving where they
/// would leave the bracket; a lane that is done stands still. The last step is no more than 1e-9 of the root, so that
/// what is left after it is of the order of its square.
template <typename Function>
void falling_root(Function function, LaneValues& searching, LaneValues& low, LaneValues& high, LaneValues& x) {
  constexpr int budget = 300;
  constexpr double last_step = 1e-9, narrowest = 4e-16;
  for (int i = 0; i < budget && any_lane(searching); ++i) {
    LaneValues value, slope;
    function(x, value, slope);
#pragma GCC ivdep
    for (int l = 0; l < lanes; ++l) {
      const double go = searching[l], at = x[l];
      const double below = go * (value[l] > 0 ? 1.0 : 0.0), above = go - below;
      const double least = low[l], most = high[l];
      const double lower = below > 0 ? at : least, upper = above > 0 ? at : most;
      low[l] = lower, high[l] = upper;
      const double newton = at - value[l] / slope[l], middle = 0.5 * (lower + upper);
      const double close = std::abs(newton - at) <= last_step * at ? 1.0 : 0.0;
      const double right_of_low = newton > lower ? 1.0 : 0.0, left_of_high = newton < upper ? 1.0 : 0.0;
      const double inside = right_of_low * left_of_high;
      const double halved = close > 0 ? at : middle;
      const double next = inside > 0 ? newton : halved;
      const double narrow = upper - lower <= narrowest * upper ? 1.0 : 0.0;
      x[l] = go > 0 ? next : at;
      searching[l] = go * (1 - close) * (1 - narrow);
    }
  }
}

}  // namespace tenon

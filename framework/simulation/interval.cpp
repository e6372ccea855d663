// SPDX-License-Identifier: BSD-3-Clause
#include "framework/simulation/interval.hpp"

#include <cmath>

namespace tenon {

std::int64_t IntervalClock::index(double time, std::int64_t step) const {
  if (interval_.steps > 0) return step / interval_.steps;
  if (interval_.time > 0) return static_cast<std::int64_t>(std::floor((time - start_) / interval_.time + 1e-9));
  return 0;
}

void IntervalClock::reset(double time, std::int64_t step) {
  last_ = index(time, step);
}

bool IntervalClock::due(double time, std::int64_t step) {
  const std::int64_t now = index(time, step);
  if (now == last_) return false;
  last_ = now;
  return true;
}

}  // namespace tenon

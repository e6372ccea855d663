// SPDX-License-Identifier: BSD-3-Clause
#include "framework/fields/result_data.hpp"

#include <cmath>

namespace tenon {

std::size_t chosen_state(std::span<const double> times, const StateChoice& choice) {
  if (!choice.time) return times.size() - 1;
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < times.size(); ++i)
    if (std::abs(times[i] - *choice.time) < std::abs(times[nearest] - *choice.time)) nearest = i;
  return nearest;
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
#include "framework/base/timers.hpp"

#include <algorithm>

namespace tenon {

PhaseTimer& PhaseTimers::phase(std::string_view name) {
  const auto found = std::find_if(phases_.begin(), phases_.end(), [&](const PhaseTimer& p) { return p.name == name; });
  if (found != phases_.end()) return *found;
  return phases_.emplace_back(PhaseTimer{std::string(name)});
}

}  // namespace tenon

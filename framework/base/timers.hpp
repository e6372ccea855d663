// SPDX-License-Identifier: BSD-3-Clause
// Seconds and calls per phase of the step; read by the last table of a run.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

namespace tenon {

/// Wall time of one phase on this rank.
struct PhaseTimer {
  std::string name;
  double seconds = 0;
  std::int64_t calls = 0;
};

/// All phases of a run, in order of first use. References stay valid.
class PhaseTimers {
 public:
  PhaseTimer& phase(std::string_view name);
  const std::deque<PhaseTimer>& phases() const { return phases_; }

 private:
  std::deque<PhaseTimer> phases_;
};

/// Adds the life time of this object to a phase.
class ScopedTimer {
 public:
  explicit ScopedTimer(PhaseTimer& phase) : phase_(phase), start_(Clock::now()) {}
  ~ScopedTimer() {
    phase_.seconds += std::chrono::duration<double>(Clock::now() - start_).count();
    ++phase_.calls;
  }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  PhaseTimer& phase_;
  Clock::time_point start_;
};

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// "Every 2 us" or "every 100 steps": when output is due.
#pragma once

#include <cstdint>

namespace tenon {

/// Due at the first step at or past each multiple of `time` (s) from the start, or at each multiple of `steps`.
/// Neither: never. Depends on nothing but time and step, so a restarted run writes at the same steps.
struct Interval {
  double time = 0;
  std::int64_t steps = 0;
  bool never() const { return time <= 0 && steps <= 0; }
};

/// Follows an interval through a run.
class IntervalClock {
 public:
  IntervalClock() = default;
  IntervalClock(Interval interval, double start_time) : interval_(interval), start_(start_time) {}
  /// Takes (time, step) as done.
  void reset(double time, std::int64_t step);
  /// True if a multiple has been reached since the last reset or true answer.
  bool due(double time, std::int64_t step);

 private:
  std::int64_t index(double time, std::int64_t step) const;
  Interval interval_;
  double start_ = 0;
  std::int64_t last_ = 0;
};

}  // namespace tenon

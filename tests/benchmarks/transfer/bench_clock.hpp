// SPDX-License-Identifier: BSD-3-Clause
// Processor time and wall time of work that is repeated.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <utility>
#include <vector>

#include "framework/comm/communicator.hpp"

namespace tenon::bench {

/// Repeated times in seconds, each the greatest over the ranks.
struct Times {
  std::vector<double> processor, wall;

  static double median(std::vector<double> values) {
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
  }
  double median() const { return median(processor); }
  double best() const { return *std::ranges::min_element(processor); }
  double median_wall() const { return median(wall); }

  /// Collective. Does the work, adds its time, and returns what the work returned.
  template <typename Work>
  auto take(const Communicator& comm, Work&& work) {
    comm.barrier();
    const auto wall_start = std::chrono::steady_clock::now();
    const double start = processor_seconds();
    auto result = std::forward<Work>(work)();
    const double spent = processor_seconds() - start;
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - wall_start;
    processor.push_back(comm.max(spent));
    wall.push_back(comm.max(passed.count()));
    return result;
  }

 private:
  /// Of this process, which other work on the machine disturbs least.
  static double processor_seconds() {
    std::timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }
};

}  // namespace tenon::bench

// SPDX-License-Identifier: BSD-3-Clause
// A polite end: SIGTERM asks the run to write a checkpoint and stop with exit code 6.
#pragma once

#include <cstdint>

#include "framework/comm/communicator.hpp"

namespace tenon {

/// While it lives, SIGTERM and SIGUSR1 only set a flag, which all ranks compare every few steps and so see together.
class StopRequest {
 public:
  StopRequest();
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// Collective. True on all ranks if any was asked to stop.
  bool asked(const Communicator& comm, std::int64_t step) const;

 private:
  static constexpr std::int64_t steps_between_votes = 8;
};

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
#include "framework/simulation/stop_request.hpp"

#include <csignal>

namespace tenon {

namespace {
volatile std::sig_atomic_t signalled = 0;  // the one thing that a signal handler may write

extern "C" void note_signal(int) {
  signalled = 1;
}
}  // namespace

StopRequest::StopRequest() {
  signalled = 0;
  std::signal(SIGTERM, note_signal);
  std::signal(SIGUSR1, note_signal);
}

StopRequest::~StopRequest() {
  std::signal(SIGTERM, SIG_DFL);
  std::signal(SIGUSR1, SIG_DFL);
}

bool StopRequest::asked(const Communicator& comm, std::int64_t step) const {
  if (comm.size() == 1) return signalled != 0;
  return step % steps_between_votes == 0 && comm.any(signalled != 0);
}

}  // namespace tenon

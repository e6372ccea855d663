// SPDX-License-Identifier: BSD-3-Clause
// How fast Taylor-Green vortices decay, and how wrong they are.
#pragma once

#include "taylor_green_case.hpp"

namespace tenon::testing {

struct Decay {
  double rate, error, ledger;
};

/// Rate from the greatest speeds at t = 0.5 and 2, error of velocities at t = 1.
inline Decay decay(int across, FluidOptions::Shifting shifting) {
  SphRun run(TaylorGreen::scene(across, shifting));
  run.run(0.5);
  const double first = TaylorGreen::greatest_speed(run), begin = run.time();
  run.run(1);
  Decay found{};
  found.error = TaylorGreen::error(run);
  run.run(2);
  found.rate = std::log(first / TaylorGreen::greatest_speed(run)) / (run.time() - begin);
  found.ledger = run.ledger_error();
  if (communicator().rank() == 0)
    std::printf("%d across: rate %.5f (exact %.5f, %+.1f %%), error of velocity %.2f %%, ledger %.1e\n", across,
                found.rate, TaylorGreen::rate, 100 * (found.rate / TaylorGreen::rate - 1), 100 * found.error,
                found.ledger);
  return found;
}

}  // namespace tenon::testing

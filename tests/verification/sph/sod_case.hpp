// SPDX-License-Identifier: BSD-3-Clause
// What is asked of Sod's shock tube.
#pragma once

#include <gtest/gtest.h>

#include "shock_case.hpp"

namespace tenon::testing {

inline TubeEnd run_tube(const SphScene& scene, const char* name) {
  SphRun run(scene);
  run.run(scene.end);
  TubeEnd end;
  const double ledger = run.ledger_error();
  end = end_of_tube(run);
  EXPECT_LE(ledger, 1e-11);
  if (communicator().rank() == 0)
    std::printf("%s: p* %.5f u* %.5f rho %.5f %.5f shock %.5f h %.4f L1 %.3e blip %.3f; %lld steps, energy %.1e\n",
                name, end.pressure, end.velocity, end.left, end.right, end.shock, end.spacing_behind, end.density_error,
                end.blip, static_cast<long long>(run.simulation().steps()), ledger);
  return end;
}

inline void expect_sod(const TubeEnd& end, double blip) {
  if (communicator().rank() != 0) return;
  EXPECT_NEAR(end.pressure, SodSolution::p_star, 0.01 * SodSolution::p_star);
  EXPECT_NEAR(end.velocity, SodSolution::u_star, 0.01 * SodSolution::u_star);
  EXPECT_NEAR(end.left, SodSolution::left_star, 0.01 * SodSolution::left_star);
  EXPECT_NEAR(end.right, SodSolution::right_star, 0.01 * SodSolution::right_star);
  EXPECT_NEAR(end.shock, 0.2 * SodSolution::shock_speed, 2 * end.spacing_behind);
  EXPECT_LE(end.density_error, 0.01);
  EXPECT_LE(end.blip, blip);
}

}  // namespace tenon::testing

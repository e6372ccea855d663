// SPDX-License-Identifier: BSD-3-Clause
// A dam that breaks has the same bits on any number of ranks, with parts that are cut anew whenever the order is
// chosen: compiled for some steps, and for nightly runs of thousands.
#include <gtest/gtest.h>

#include <cstdio>

#include "dam_break_case.hpp"

namespace tenon::testing {
namespace {

std::vector<std::vector<double>> end_of_dam(const Communicator& comm) {
  SphScene scene = water({1, 1, 0}, {2.5, 1.5, 0}, 1.0 / DAM_ACROSS, 0.05);
  scene.options.always_rebalance = true;
  SphRun run(scene, comm);
  run.steps(DAM_STEPS);
  const std::vector<std::vector<double>> end{run.gathered("position"), run.gathered("velocity"),
                                             run.gathered("pressure")};
  const DecompositionCounts& counts = run.body().decomposition().counts();
  EXPECT_GE(counts.renewals, DAM_STEPS / 100);
  EXPECT_TRUE(comm.size() == 1 || counts.rebalances >= counts.renewals);
  if (comm.rank() == 0)
    std::printf("%d ranks, %zu particles: %d steps to %.3g s, %d orders, %d cuts\n", comm.size(), end[2].size(),
                DAM_STEPS, run.time(), static_cast<int>(counts.renewals), static_cast<int>(counts.rebalances));
  return end;
}

TEST(DamRanks, SameBits) {
  const std::vector<std::vector<double>> all = end_of_dam(communicator());
  if (communicator().rank() != 0) return;
  EXPECT_EQ(all, end_of_dam(Communicator::self()));
}

}  // namespace
}  // namespace tenon::testing

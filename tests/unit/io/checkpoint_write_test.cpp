// SPDX-License-Identifier: BSD-3-Clause
// Leaves one checkpoint per rank count for the tests that compare them.
#include <gtest/gtest.h>

#include "sample_state.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {

TEST(Checkpoint, WritesForOtherRankCounts) {
  const Communicator& comm = testing::communicator();
  const std::string path = "io_checkpoint_np" + std::to_string(comm.size()) + ".h5";
  testing::write_sample(comm, path);
  EXPECT_TRUE(std::filesystem::exists(path));
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// The checkpoints of a run: order, pruning, the newest that is whole.
#include <gtest/gtest.h>

#include <fstream>

#include "sample_state.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {

namespace {

void touch(const std::string& path) {
  std::ofstream(path) << "x";
}

void write_step(const Communicator& comm, const std::string& folder, std::int64_t step) {
  CheckpointWriter file(comm, CheckpointFiles::name(folder, step));
  file.integer("step", step);
  file.finish();
}

}  // namespace

TEST(CheckpointFiles, NewestFirstByNumber) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_list");
  comm.vote_on_root([&] {
    for (const char* file :
         {"/checkpoint-900.h5", "/checkpoint-1000.h5", "/checkpoint-0.h5", "/checkpoint-1000.h5.part",
          "/checkpoint-.h5", "/checkpoint-1e3.h5", "/checkpoint--5.h5", "/checkpoint-007.h5", "/final.h5"})
      touch(folder + file);
  });
  comm.barrier();
  const std::vector<std::string> expected{folder + "/checkpoint-1000.h5", folder + "/checkpoint-900.h5",
                                          folder + "/checkpoint-0.h5"};
  EXPECT_EQ(CheckpointFiles::list(folder), expected);
  EXPECT_TRUE(CheckpointFiles::list("no-such-folder").empty());
}

TEST(CheckpointFiles, PruneKeepsTheNewestTwo) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_prune");
  comm.vote_on_root([&] {
    CheckpointFiles::prune(folder);
    for (const std::int64_t step : {5, 70, 600, 8}) touch(CheckpointFiles::name(folder, step));
    CheckpointFiles::prune(folder);
    EXPECT_EQ(CheckpointFiles::list(folder),
              (std::vector<std::string>{folder + "/checkpoint-600.h5", folder + "/checkpoint-70.h5"}));
    CheckpointFiles::remove_later_than(folder, 70);
    EXPECT_EQ(CheckpointFiles::list(folder), std::vector<std::string>{folder + "/checkpoint-70.h5"});
  });
}

TEST(CheckpointFiles, NewestValidPassesOverDamagedOnes) {
  const Communicator& comm = testing::communicator();
  const std::string folder = testing::fresh_folder(comm, "io_newest");
  EXPECT_EQ(CheckpointFiles::newest_valid(comm, folder), "");
  for (const std::int64_t step : {10, 20, 30}) write_step(comm, folder, step);
  EXPECT_EQ(CheckpointFiles::newest_valid(comm, folder), CheckpointFiles::name(folder, 30));
  comm.vote_on_root([&] {
    std::filesystem::resize_file(CheckpointFiles::name(folder, 30), 1000);
    std::fstream file(CheckpointFiles::name(folder, 20), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(700);
    file << "xyz";
  });
  std::vector<std::string> damaged;
  EXPECT_EQ(CheckpointFiles::newest_valid(comm, folder, &damaged), CheckpointFiles::name(folder, 10));
  ASSERT_EQ(damaged.size(), 2u);
  EXPECT_NE(damaged[0].find("checkpoint-30.h5: truncated"), std::string::npos);
  EXPECT_NE(damaged[1].find("checkpoint-20.h5: damaged"), std::string::npos);
}

}  // namespace tenon

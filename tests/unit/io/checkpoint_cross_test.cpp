// SPDX-License-Identifier: BSD-3-Clause
// What any number of ranks wrote is read, bit for bit, by any other.
#include <gtest/gtest.h>

#include "framework/io/posix_file.hpp"
#include "sample_state.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {

class CheckpointFrom : public ::testing::TestWithParam<int> {};

TEST_P(CheckpointFrom, ReadsBitForBit) {
  const Communicator& comm = testing::communicator();
  const CheckpointReader file(comm, "io_checkpoint_np" + std::to_string(GetParam()) + ".h5");
  EXPECT_EQ(file.scalar("time"), 1.0 / 3.0);
  EXPECT_EQ(file.integer("step"), (std::int64_t{1} << 53) + 1);
  EXPECT_EQ(file.text("scene"), "end_time: 80 us\n\xc2\xb5\n");
  EXPECT_EQ(file.text("empty"), "");

  // Owned ids and, as ghosts, some of everyone's, with repeats.
  std::vector<GlobalId> nodes = testing::scattered_ids(comm, testing::sample_nodes);
  for (GlobalId id = 3; id < testing::sample_nodes; id += 50) nodes.insert(nodes.end(), {id, id / 2});
  const GlobalOrder node_order(comm, nodes, testing::sample_nodes);
  std::vector<double> displacement(nodes.size() * 3), temperature(nodes.size());
  file.array("mechanics/displacement", node_order, displacement, 3);
  file.array("thermal/temperature", node_order, temperature, 1);
  EXPECT_TRUE(testing::same_bits(displacement, testing::samples(nodes, 3, 1)));
  EXPECT_TRUE(testing::same_bits(temperature, testing::samples(nodes, 1, 3)));

  const std::vector<GlobalId> elements = testing::scattered_ids(comm, testing::sample_elements);
  const GlobalOrder element_order(comm, elements, testing::sample_elements);
  std::vector<double> stress(elements.size() * 6);
  file.array("mechanics/stress", element_order, stress, 6);
  EXPECT_TRUE(testing::same_bits(stress, testing::samples(elements, 6, 2)));
  file.array("thermal/nothing", GlobalOrder(comm, {}, 0), {}, 2);
}

TEST_P(CheckpointFrom, IsTheSameFileByteForByte) {
  const Communicator& comm = testing::communicator();
  if (comm.rank() != 0) return;
  EXPECT_EQ(read_text("io_checkpoint_np1.h5"), read_text("io_checkpoint_np" + std::to_string(GetParam()) + ".h5"));
}

INSTANTIATE_TEST_SUITE_P(Ranks, CheckpointFrom, ::testing::Values(1, 2, 3, 7));

}  // namespace tenon

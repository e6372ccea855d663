// SPDX-License-Identifier: BSD-3-Clause
// The plan for other numbers of ranks: parts that are planned in one process are those that a run has, and the model of
// a machine does its sums right.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "apps/tenon/scaling_machine.hpp"
#include "apps/tenon/scaling_parts.hpp"
#include "framework/mesh/generators.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

MeshData block() {
  BoxShape shape;
  shape.elements = {9, 7, 6};
  shape.distortion = 0.2;
  return generate(shape);
}

TEST(ScalingParts, AreThoseOfARunOnAsManyRanks) {
  const Communicator& comm = testing::communicator();
  const BuiltScene::Division division{[](const std::string&, ElementKind) { return 1.3; }, PartitionMethod::rcb};
  const auto whole = distribute(Communicator::self(), block(), {});
  const MeshParts planned = divide_mesh(*whole, division, comm.size());

  DistributeOptions options;
  options.cost = division.cost, options.method = division.method;
  const auto mine = distribute(comm, comm.rank() == 0 ? block() : MeshData{}, options);
  const auto rank = static_cast<std::size_t>(comm.rank());
  EXPECT_NEAR(planned.local_cost[rank], 1.3 * static_cast<double>(mine->elements()), 1e-9);
  EXPECT_EQ(planned.local_nodes[rank], static_cast<double>(mine->nodes()));

  PhaseLoad load;
  planned.ghosts.book(load, 1, 24);
  std::vector<Vec3> values(static_cast<std::size_t>(mine->nodes()));
  const ExchangeCount before = comm.count("mesh halo");
  mine->node_halo.forward<Vec3>(values, values);
  const ExchangeCount& after = comm.count("mesh halo");
  EXPECT_LE(static_cast<double>(after.messages - before.messages), load.messages[rank]);
  EXPECT_EQ(comm.max(static_cast<double>(after.messages - before.messages)), std::ranges::max(load.messages));
  EXPECT_LE(static_cast<double>(after.bytes - before.bytes), load.bytes[rank]);
}

TEST(ScalingParts, GrowByGhostsAsTheirSurfaceDoes) {
  BoxShape shape;
  shape.elements = {24, 24, 24};
  const auto mesh = distribute(Communicator::self(), generate(shape), {});
  double previous = 1;
  for (const int parts : {1, 8, 64}) {
    const MeshParts planned = divide_mesh(*mesh, {{}, PartitionMethod::rcb}, parts);
    const double copies =
        std::accumulate(planned.local_cost.begin(), planned.local_cost.end(), 0.0) / (24.0 * 24.0 * 24.0);
    // Cubes of n elements along an edge with half a layer on each side.
    const double n = 24.0 / std::cbrt(parts), layers = parts == 1 ? 0 : parts == 8 ? 0.5 : 1;
    EXPECT_LE(copies, 1.05 * std::pow((n + layers) / n, 3)) << parts;
    EXPECT_GE(copies, previous);
    EXPECT_LE(std::ranges::max(planned.local_cost), 1.25 * copies * 24 * 24 * 24 / parts) << parts;
    previous = copies;
  }
}

TEST(Traffic, CountsMessagesOfPairsOfRanksAndBytesOfItems) {
  Traffic traffic(3);
  traffic.add(0, 1, 10), traffic.add(0, 1, 5), traffic.add(0, 2, 1), traffic.add(1, 1, 99), traffic.add(2, 0, 7);
  PhaseLoad load;
  traffic.book(load, 2, 4);
  EXPECT_EQ(load.messages, (std::vector<double>{4, 2, 2}));  // sent or received, whichever is more, twice a step
  EXPECT_EQ(load.bytes, (std::vector<double>{128, 120, 56}));
}

TEST(Machine, TakesTheSlowestRankAndAddsReductions) {
  PhaseLoad load;
  load.seconds = 4, load.whole = 8;  // half a second for a unit
  load.work = {2, 3, 1}, load.messages = {0, 0, 5}, load.bytes = {0, 0, 300};
  load.reductions = 2;
  const Machine machine{"test", "", 0.1, 100, 2};
  const PhaseTime time = predict(load, machine);
  EXPECT_EQ(time.work_max, 3);
  EXPECT_EQ(time.work_mean, 2);
  EXPECT_DOUBLE_EQ(time.computing, 3);
  EXPECT_DOUBLE_EQ(time.seconds, 1 + 0.5 + 3 + 2 * 0.1 * 2);  // rank 2 waits for its messages; two doublings
  EXPECT_THROW(find_machine("abacus"), Error);
  EXPECT_LT(find_machine("cluster").latency, find_machine("tflops").latency);
}

}  // namespace
}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Small collectives, votes and the directory.
#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "framework/comm/communicator.hpp"
#include "framework/comm/directory.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

const Communicator& comm() {
  return testing::communicator();
}

TEST(Communicator, ReducesOverAllRanks) {
  const int n = comm().size(), r = comm().rank();
  EXPECT_EQ(comm().max(r), n - 1);
  EXPECT_EQ(comm().sum(std::int64_t{r} << 40), (std::int64_t{n} * (n - 1) / 2) << 40);
  EXPECT_EQ(comm().min(-1.5 * r), -1.5 * (n - 1));
  EXPECT_EQ(comm().max(-1.5 * (r + 1)), -1.5);
  EXPECT_TRUE(comm().any(r == n - 1));
  EXPECT_FALSE(comm().any(false));
  EXPECT_EQ(comm().exclusive_scan(r + 1), std::int64_t{r} * (r + 1) / 2);
}

TEST(Communicator, NanWinsInBothDirectionsWhicheverRankBringsIt) {
  for (int who = 0; who < comm().size(); ++who)
    for (const double sign : {1.0, -1.0}) {
      const double nan = std::copysign(std::numeric_limits<double>::quiet_NaN(), sign);
      EXPECT_TRUE(std::isnan(comm().max(comm().rank() == who ? nan : 1.0)));
      EXPECT_TRUE(std::isnan(comm().min(comm().rank() == who ? nan : 1.0)));
    }
}

TEST(Communicator, VoteThrowsTheErrorOfTheLowestFailingRankEverywhere) {
  const int lowest = comm().size() / 2;
  try {
    comm().vote([&] {
      if (comm().rank() >= lowest) throw Error(ExitCode::geometry, "rank " + std::to_string(comm().rank()));
    });
    FAIL() << "nothing thrown";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::geometry);
    EXPECT_EQ(std::string(e.what()), "rank " + std::to_string(lowest));
  }
  comm().vote([] {});
}

TEST(Directory, FindsRankAndIndexAndMissesWhatNobodyEntered) {
  const int n = comm().size(), r = comm().rank();
  std::vector<GlobalId> ids;
  std::vector<LocalIndex> index;
  for (GlobalId id = r; id < 100; id += n) {
    if (id % 10 == 3) continue;
    ids.push_back(id);
    index.push_back(static_cast<LocalIndex>(1000 + id));
  }
  const Directory directory(comm(), ids, index);
  std::vector<GlobalId> asked(103);
  std::iota(asked.begin(), asked.end(), -1);
  const auto entries = directory.find(asked);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const GlobalId id = asked[i];
    const bool entered = id >= 0 && id < 100 && id % 10 != 3;
    EXPECT_EQ(entries[i].rank, entered ? static_cast<int>(id % n) : -1) << id;
    EXPECT_EQ(entries[i].index, entered ? 1000 + id : no_index) << id;
  }
}

}  // namespace
}  // namespace tenon

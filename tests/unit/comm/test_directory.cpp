// SPDX-License-Identifier: BSD-3-Clause
// The directory against what every rank can work out for itself.
#include <gtest/gtest.h>

#include <numeric>

#include "framework/comm/directory.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

const Communicator& comm() {
  return testing::communicator();
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
  asked.push_back(GlobalId{1} << 60);
  asked.push_back(17);  // twice
  const auto entries = directory.find(asked);
  ASSERT_EQ(entries.size(), asked.size());
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const GlobalId id = asked[i];
    const bool entered = id >= 0 && id < 100 && id % 10 != 3;
    EXPECT_EQ(entries[i].rank, entered ? static_cast<int>(id % n) : -1) << id;
    EXPECT_EQ(entries[i].index, entered ? 1000 + id : no_index) << id;
  }
}

TEST(Directory, LowestRankKeepsAnIdEnteredByMany) {
  // Rank r enters the ids r .. r+4, and each of them twice.
  std::vector<GlobalId> ids;
  std::vector<LocalIndex> index;
  for (int repeat = 0; repeat < 2; ++repeat)
    for (GlobalId id = comm().rank(); id < comm().rank() + 5; ++id) {
      ids.push_back(id);
      index.push_back(static_cast<LocalIndex>(100 * repeat + id));
    }
  const Directory directory(comm(), ids, index);
  std::vector<GlobalId> asked(static_cast<std::size_t>(comm().size()) + 4);
  std::iota(asked.begin(), asked.end(), 0);
  const auto entries = directory.find(asked);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    EXPECT_EQ(entries[i].rank, std::max<int>(0, static_cast<int>(i) - 4));
    EXPECT_EQ(entries[i].index, static_cast<LocalIndex>(i));
  }
}

TEST(Directory, EmptyAndLargeIds) {
  const Directory nothing(comm(), {}, {});
  EXPECT_EQ(nothing.find(std::vector<GlobalId>{0, 5}).at(1).rank, -1);
  EXPECT_TRUE(nothing.find({}).empty());

  const bool last = comm().rank() == comm().size() - 1;  // all ids on one rank
  const GlobalId large = (GlobalId{1} << 62) + 3;
  std::vector<GlobalId> ids;
  if (last) ids = {large, 0, large - 1};
  std::vector<LocalIndex> index(ids.size());
  std::iota(index.begin(), index.end(), 7);
  const Directory directory(comm(), ids, index);
  const auto entries = directory.find(std::vector<GlobalId>{large - 1, large - 2, large, 0});
  EXPECT_EQ(entries[0].index, 9);
  EXPECT_EQ(entries[1].rank, -1);
  EXPECT_EQ(entries[2].index, 7);
  EXPECT_EQ(entries[3].index, 8);
  EXPECT_EQ(entries[3].rank, comm().size() - 1);
}

}  // namespace
}  // namespace tenon

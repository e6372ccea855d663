// SPDX-License-Identifier: BSD-3-Clause
// Plans against what every rank can work out for itself.
#include <gtest/gtest.h>

#include "framework/comm/exchange_plan.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

const Communicator& comm() {
  return testing::communicator();
}

// Item i of rank r goes to this rank; every fourth goes nowhere.
int destination(int r, int i) {
  return i % 4 == 3 ? -1 : (r * 5 + i * i + i / 7) % comm().size();
}

TEST(ExchangePlan, ItemsArriveBySourceRankThenOrderOfSending) {
  constexpr int items = 40;
  std::vector<int> to(items);
  std::vector<double> values(items);
  for (int i = 0; i < items; ++i) {
    to[static_cast<std::size_t>(i)] = destination(comm().rank(), i);
    values[static_cast<std::size_t>(i)] = 1000.0 * comm().rank() + i;
  }
  std::vector<double> expected;
  std::vector<int> expected_from;
  for (int r = 0; r < comm().size(); ++r)
    for (int i = 0; i < items; ++i)
      if (destination(r, i) == comm().rank()) {
        expected.push_back(1000.0 * r + i);
        expected_from.push_back(r);
      }
  const ExchangePlan plan = ExchangePlan::to_ranks(comm(), to, "test");
  ASSERT_EQ(plan.received(), static_cast<LocalIndex>(expected.size()));
  EXPECT_EQ(plan.received_from(), expected_from);
  std::vector<double> arrived(expected.size());
  plan.forward(std::span<const double>(values), std::span(arrived));
  EXPECT_EQ(arrived, expected);

  std::vector<double> back(items, -1);
  plan.reverse(std::span<const double>(arrived), std::span(back));
  for (int i = 0; i < items; ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_EQ(back[k], to[k] < 0 ? -1 : values[k]);
  }
}

}  // namespace
}  // namespace tenon

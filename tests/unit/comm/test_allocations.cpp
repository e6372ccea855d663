// SPDX-License-Identifier: BSD-3-Clause
// What runs in every step must not allocate.
#include <gtest/gtest.h>

#include <vector>

#include "allocation_counter.hpp"
#include "framework/comm/exchange_plan.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

TEST(Allocations, RunsOfPlansAndSumsDoNotAllocate) {
  const Communicator& comm = testing::communicator();
  std::vector<int> to;
  for (int i = 0; i < 100; ++i) to.push_back(i % comm.size());
  const ExchangePlan plan = ExchangePlan::to_ranks(comm, to, "test");
  std::vector<double> values(300, 1.0), arrived(3 * static_cast<std::size_t>(plan.received()));
  std::vector<ExactSum> sums(3);
  std::vector<double> totals(3);
  const auto step = [&] {
    plan.forward(std::span<const double>(values), std::span(arrived), 3);
    plan.reverse(std::span<const double>(arrived), std::span(values), 3);
    plan.forward(std::span<const double>(values).first(100), std::span(arrived));
    for (ExactSum& sum : sums) {
      sum.clear();
      sum.add(values);
      sum.add_product(values[0], values[1]);
    }
    comm.sum(sums, totals);
    comm.max(std::span(totals));
    comm.sum(std::int64_t{1});
  };
  step();
  const std::int64_t before = testing::allocations();
  for (int repeat = 0; repeat < 5; ++repeat) step();
  EXPECT_EQ(testing::allocations(), before);
  EXPECT_GT(before, 0);
}

}  // namespace
}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Plans against what every rank can work out for itself.
#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <random>

#include "framework/comm/communicator_impl.hpp"
#include "framework/comm/exchange_plan.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

const Communicator& comm() {
  return testing::communicator();
}

constexpr int items = 40;

// Item i of rank r goes to this rank; every fourth goes nowhere, and the last rank sends nothing.
int destination(int r, int i) {
  if (i % 4 == 3 || (r == comm().size() - 1 && r > 0)) return -1;
  return (r * 5 + i * i + i / 7) % comm().size();
}

struct Sent {
  std::vector<int> to;
  std::vector<double> values;
  std::vector<double> expected;  // what arrives here
  std::vector<int> expected_from;
};

Sent sent() {
  Sent s;
  for (int i = 0; i < items; ++i) {
    s.to.push_back(destination(comm().rank(), i));
    s.values.push_back(1000.0 * comm().rank() + i);
  }
  for (int r = 0; r < comm().size(); ++r)
    for (int i = 0; i < items; ++i)
      if (destination(r, i) == comm().rank()) {
        s.expected.push_back(1000.0 * r + i);
        s.expected_from.push_back(r);
      }
  return s;
}

TEST(ExchangePlan, ItemsArriveBySourceRankThenOrderOfSending) {
  const Sent s = sent();
  const ExchangePlan plan = ExchangePlan::to_ranks(comm(), s.to, "test");
  ASSERT_EQ(plan.received(), static_cast<LocalIndex>(s.expected.size()));
  EXPECT_EQ(plan.received_from(), s.expected_from);
  EXPECT_LT(plan.neighbours(), comm().size());
  std::vector<double> arrived(s.expected.size());
  for (int repeat = 0; repeat < 3; ++repeat) {
    std::fill(arrived.begin(), arrived.end(), -1);
    plan.forward(std::span<const double>(s.values), std::span(arrived));
    EXPECT_EQ(arrived, s.expected);
  }
}

TEST(ExchangePlan, ReverseReturnsToWhereItCameFrom) {
  const Sent s = sent();
  const ExchangePlan plan = ExchangePlan::to_ranks(comm(), s.to, "test");
  std::vector<double> back(items, -1);
  plan.reverse(std::span<const double>(s.expected), std::span(back));
  for (std::size_t i = 0; i < items; ++i) EXPECT_EQ(back[i], s.to[i] < 0 ? -1 : s.values[i]);
}

TEST(ExchangePlan, SendListsMayRepeatItems) {
  // Each rank sends its item 2 to all ranks, and then item 0 to itself.
  std::vector<int> rank(static_cast<std::size_t>(comm().size()));
  std::iota(rank.begin(), rank.end(), 0);
  std::vector<LocalIndex> send(rank.size(), 2);
  rank.push_back(comm().rank());
  send.push_back(0);
  const ExchangePlan plan = ExchangePlan::to_ranks(comm(), rank, send, "test");
  const std::vector<int> values{100 + comm().rank(), 0, 200 + comm().rank()};
  std::vector<int> arrived(static_cast<std::size_t>(plan.received())), expected;
  plan.forward(std::span<const int>(values), std::span(arrived));
  for (int r = 0; r < comm().size(); ++r) {
    expected.push_back(200 + r);
    if (r == comm().rank()) expected.push_back(100 + r);
  }
  EXPECT_EQ(arrived, expected);
}

// A ring of cells, each rank owning `own` of them with a ghost on either side, in one array: ghost, own, ghost.
TEST(ExchangePlan, PullsGhostsIntoTheSameArray) {
  constexpr int own = 3;
  const int n = comm().size(), r = comm().rank();
  const std::vector<int> owner{(r + n - 1) % n, (r + 1) % n, -1};
  const std::vector<LocalIndex> index{own, 1, 0}, into{0, own + 1, 2};
  const ExchangePlan plan = ExchangePlan::from_owners(comm(), owner, index, into, "test");
  EXPECT_EQ(plan.received(), 2);
  EXPECT_EQ(plan.neighbours(), std::min(2, n - 1));
  std::vector<std::array<double, 3>> x(own + 2, {-1, -1, -1});
  for (int i = 0; i < own; ++i) x[static_cast<std::size_t>(i + 1)] = {1.0 * (r * own + i), 0.5, 1.0 * r};
  plan.forward(std::span<const std::array<double, 3>>(x), std::span(x));
  EXPECT_EQ(x[0][0], (r * own + n * own - 1) % (n * own));
  EXPECT_EQ(x[own + 1][0], (r * own + own) % (n * own));
  EXPECT_EQ(x[2][0], r * own + 1) << "what was not asked for was touched";

  std::vector<double> plain(2 * (own + 2), -1.0), expected;
  for (int i = 1; i <= own; ++i) plain[static_cast<std::size_t>(2 * i)] = x[static_cast<std::size_t>(i)][0];
  plan.forward(std::span<const double>(plain), std::span(plain), 2);
  EXPECT_EQ(plain[0], x[0][0]);
  EXPECT_EQ(plain[2 * (own + 1)], x[own + 1][0]);
}

// Every rank replaces its item by that of its left neighbour: all of them are both read and written.
TEST(ExchangePlan, ChainsInOneArrayReadBeforeTheyWrite) {
  constexpr int own = 4;
  const int n = comm().size(), r = comm().rank();
  std::vector<int> owner, values;
  std::vector<LocalIndex> index, into;
  for (int i = 0; i < own; ++i) {
    const int left = (r * own + i + n * own - 1) % (n * own);
    owner.push_back(left / own);
    index.push_back(left % own);
    into.push_back(i);
    values.push_back(r * own + i);
  }
  const ExchangePlan plan = ExchangePlan::from_owners(comm(), owner, index, into, "test");
  plan.forward(std::span<const int>(values), std::span(values));
  for (int i = 0; i < own; ++i) EXPECT_EQ(values[static_cast<std::size_t>(i)], (r * own + i + n * own - 1) % (n * own));
  plan.reverse(std::span<const int>(values), std::span(values));
  for (int i = 0; i < own; ++i) EXPECT_EQ(values[static_cast<std::size_t>(i)], r * own + i);
}

TEST(ExchangePlan, InReverseTheLastRankWins) {
  const std::vector<int> owner{0};
  const std::vector<LocalIndex> zero{0};
  const ExchangePlan plan = ExchangePlan::from_owners(comm(), owner, zero, zero, "test");
  const std::vector<int> mine{comm().rank()};
  std::vector<int> result{-1};
  plan.reverse(std::span<const int>(mine), std::span(result));
  EXPECT_EQ(result[0], comm().rank() == 0 ? comm().size() - 1 : -1);
}

TEST(ExchangePlan, ManyArraysTravelInOneMessage) {
  const Sent s = sent();
  const Communicator other = comm().duplicate();
  const ExchangePlan plan = ExchangePlan::to_ranks(other, s.to, "many arrays");
  struct Odd {
    char text[5];
  };
  std::vector<Odd> odd(items);
  std::vector<int> whole(items);
  std::vector<std::array<double, 6>> tensor(items);
  for (int i = 0; i < items; ++i) {
    const auto k = static_cast<std::size_t>(i);
    odd[k].text[4] = static_cast<char>(i);
    whole[k] = 7 * i;
    tensor[k][5] = s.values[k];
  }
  std::vector<Odd> odd_here(s.expected.size());
  std::vector<int> whole_here(s.expected.size());
  std::vector<std::array<double, 6>> tensor_here(s.expected.size());
  const auto item = [](const auto& from, auto& to) {
    return ExchangeItem{reinterpret_cast<const std::byte*>(from.data()), reinterpret_cast<std::byte*>(to.data()),
                        sizeof(from[0])};
  };
  const ExchangeItem arrays[] = {item(odd, odd_here), item(whole, whole_here), item(tensor, tensor_here)};
  const ExchangeCount before = other.count("many arrays");
  plan.forward(arrays);
  for (std::size_t k = 0; k < s.expected.size(); ++k) {
    const int i = static_cast<int>(s.expected[k]) % 1000;
    EXPECT_EQ(odd_here[k].text[4], i);
    EXPECT_EQ(whole_here[k], 7 * i);
    EXPECT_EQ(tensor_here[k][5], s.expected[k]);
  }
  const ExchangeCount& after = other.count("many arrays");
  EXPECT_EQ(after.calls - before.calls, 1);
  EXPECT_LE(after.messages - before.messages, plan.neighbours());
  const auto elsewhere = std::count_if(s.to.begin(), s.to.end(), [](int to) { return to >= 0 && to != comm().rank(); });
  EXPECT_EQ(after.bytes - before.bytes, elsewhere * static_cast<std::int64_t>(5 + 4 + 48));
  if (comm().size() == 1) {
    EXPECT_EQ(after.messages, 0);
  }
}

TEST(ExchangePlan, LongMessagesAreSplit) {
  const Sent s = sent();
  const ExchangePlan plan = ExchangePlan::to_ranks(comm(), s.to, "split");
  const std::size_t usual = std::exchange(comm().impl().largest_message, 20);
  std::vector<double> arrived(s.expected.size());
  plan.forward(std::span<const double>(s.values), std::span(arrived));
  std::vector<double> back(items, -1);
  plan.reverse(std::span<const double>(arrived), std::span(back));
  comm().impl().largest_message = usual;
  EXPECT_EQ(arrived, s.expected);
  for (std::size_t i = 0; i < items; ++i) EXPECT_EQ(back[i], s.to[i] < 0 ? -1 : s.values[i]);
}

TEST(ExchangePlan, TwoPlansMayBeUnderWayAtOnce) {
  const Sent s = sent();
  const ExchangePlan first = ExchangePlan::to_ranks(comm(), s.to, "first");
  const ExchangePlan second = ExchangePlan::to_ranks(comm(), s.to, "second");
  std::vector<double> doubled, here(s.expected.size()), doubled_here(s.expected.size());
  for (const double v : s.values) doubled.push_back(2 * v);
  std::vector<double> values = s.values;
  first.begin_forward(std::span<const double>(values), std::span(here));
  second.begin_forward(std::span<const double>(doubled), std::span(doubled_here));
  std::fill(values.begin(), values.end(), -7);  // have left already
  second.end_forward();
  first.end_forward();
  EXPECT_EQ(here, s.expected);
  for (std::size_t i = 0; i < here.size(); ++i) EXPECT_EQ(doubled_here[i], 2 * here[i]);
}

TEST(ExchangePlan, NothingToDo) {
  ExchangePlan none;
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(none.received(), 0);
  EXPECT_EQ(none.neighbours(), 0);
  EXPECT_TRUE(none.received_from().empty());
  std::vector<double> values(3, 1.5);
  const std::vector<int> nowhere(3, -1);
  const ExchangePlan idle = ExchangePlan::to_ranks(comm(), nowhere, "idle");
  const ExchangePlan idle_pull = ExchangePlan::from_owners(comm(), {}, {}, {}, "idle");
  for (const ExchangePlan& plan : {none, idle, idle_pull}) {
    if (comm().rank() != 0) continue;  // needs no communication: the others need not come
    plan.forward(std::span<const double>(values), std::span(values));
    plan.reverse(std::span<const double>(values), std::span(values));
  }
  EXPECT_EQ(values, std::vector<double>(3, 1.5));
  const std::vector<LocalIndex> counts{1, 1, 1};
  EXPECT_TRUE(
      idle.forward_varying(std::span<const LocalIndex>(counts), std::span<const double>(values)).values.empty());
}

TEST(ExchangePlan, ItemsOfVaryingLength) {
  const Sent s = sent();
  const ExchangePlan plan = ExchangePlan::to_ranks(comm(), s.to, "test");
  const auto length = [](int r, int i) { return (r + i) % 3 == 0 ? 0 : (r * 3 + i) % 6; };
  std::vector<LocalIndex> counts;
  std::vector<std::int64_t> values;
  for (int i = 0; i < items; ++i) {
    counts.push_back(length(comm().rank(), i));
    for (int k = 0; k < counts.back(); ++k) values.push_back(comm().rank() * 10000 + i * 100 + k);
  }
  std::vector<LocalIndex> expected_counts;
  std::vector<std::int64_t> expected;
  for (int r = 0; r < comm().size(); ++r)
    for (int i = 0; i < items; ++i)
      if (destination(r, i) == comm().rank()) {
        expected_counts.push_back(length(r, i));
        for (int k = 0; k < length(r, i); ++k) expected.push_back(r * 10000 + i * 100 + k);
      }
  const auto arrived = plan.forward_varying(std::span<const LocalIndex>(counts), std::span<const std::int64_t>(values));
  EXPECT_EQ(arrived.counts, expected_counts);
  EXPECT_EQ(arrived.values, expected);
}

TEST(ExchangePlan, RandomPlansInQuickSuccession) {
  std::mt19937 all_ranks(99), this_rank(7 * static_cast<unsigned>(comm().rank()) + 1);
  for (int repeat = 0; repeat < 30; ++repeat) {
    const auto count = all_ranks() % 50;
    std::vector<int> to;
    for (unsigned i = 0; i < (comm().rank() % 2 ? count : count / 2); ++i)
      to.push_back(static_cast<int>(this_rank() % static_cast<unsigned>(comm().size())));
    const ExchangePlan plan = ExchangePlan::to_ranks(comm(), to, "test");
    std::vector<int> arrived(static_cast<std::size_t>(plan.received()), -1), back(to.size(), -1);
    plan.forward(std::span<const int>(to), std::span(arrived));
    for (const int rank : arrived) ASSERT_EQ(rank, comm().rank());
    EXPECT_EQ(comm().sum(std::int64_t{plan.received()}), comm().sum(static_cast<std::int64_t>(to.size())));
    plan.reverse(std::span<const int>(arrived), std::span(back));
    ASSERT_EQ(back, to);
  }
}

}  // namespace
}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Small collectives and votes.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>

#include "framework/comm/communicator.hpp"
#include "framework/comm/communicator_impl.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

const Communicator& comm() {
  return testing::communicator();
}

TEST(Communicator, ReducesOverAllRanks) {
  const int n = comm().size(), r = comm().rank();
  EXPECT_EQ(comm().max(r), n - 1);
  EXPECT_EQ(comm().max(-r), 0);
  EXPECT_EQ(comm().max(std::int64_t{r} << 40), std::int64_t{n - 1} << 40);
  EXPECT_EQ(comm().min(-std::int64_t{r}), -(n - 1));
  EXPECT_EQ(comm().sum(std::int64_t{r} << 40), (std::int64_t{n} * (n - 1) / 2) << 40);
  EXPECT_EQ(comm().min(-1.5 * r), -1.5 * (n - 1));
  EXPECT_EQ(comm().max(-1.5 * (r + 1)), -1.5);
  EXPECT_TRUE(comm().any(r == n - 1));
  EXPECT_FALSE(comm().any(false));
  EXPECT_EQ(comm().exclusive_scan(r + 1), std::int64_t{r} * (r + 1) / 2);
  std::vector<double> values{1.0 * r, -1.0 * r, 1e-320};
  comm().max(std::span(values));
  EXPECT_EQ(values, (std::vector<double>{n - 1.0, 0, 1e-320}));
  values = {1.0 * r, -1.0 * r, -std::numeric_limits<double>::infinity()};
  comm().min(std::span(values));
  EXPECT_EQ(values, (std::vector<double>{0, 1.0 - n, -std::numeric_limits<double>::infinity()}));
  std::vector<std::int64_t> counts{1, r};
  comm().sum(std::span(counts));
  EXPECT_EQ(counts, (std::vector<std::int64_t>{n, n * (n - 1) / 2}));
  comm().max(std::span(counts).first(0));
}

TEST(Communicator, NotANumberWinsInBothDirectionsWhicheverRankBringsIt) {
  for (int who = 0; who < comm().size(); ++who)
    for (const double sign : {1.0, -1.0}) {
      const double nan = std::copysign(std::numeric_limits<double>::quiet_NaN(), sign);
      EXPECT_TRUE(std::isnan(comm().max(comm().rank() == who ? nan : 1.0)));
      EXPECT_TRUE(std::isnan(comm().min(comm().rank() == who ? nan : 1.0)));
    }
}

TEST(Communicator, SignOfZeroDoesNotDependOnTheOrderOfRanks) {
  if (comm().size() == 1) return;
  for (int who = 0; who < comm().size(); ++who) {
    const double zero = comm().rank() == who ? -0.0 : 0.0;
    EXPECT_TRUE(std::signbit(comm().min(zero)));
    EXPECT_FALSE(std::signbit(comm().max(zero)));
  }
}

TEST(Communicator, GathersAndBroadcasts) {
  const int n = comm().size(), r = comm().rank();
  const std::vector<std::array<double, 2>> all = comm().all_gather(std::array{1.0 * r, 0.5 * r});
  ASSERT_EQ(static_cast<int>(all.size()), n);
  for (int q = 0; q < n; ++q) EXPECT_EQ(all[static_cast<std::size_t>(q)], (std::array{1.0 * q, 0.5 * q}));

  for (const std::size_t largest : {std::size_t{1} << 30, std::size_t{16}}) {  // whole, and in pieces
    const std::size_t usual = std::exchange(comm().impl().largest_message, largest);
    std::vector<int> expected;
    for (int q = 0; q < n; ++q) expected.insert(expected.end(), static_cast<std::size_t>(7 * (q % 3)), q);
    const std::vector<int> mine(static_cast<std::size_t>(7 * (r % 3)), r);
    EXPECT_EQ(comm().gather(std::span<const int>(mine)), r == 0 ? expected : std::vector<int>{});

    const int root = n - 1;
    std::vector<double> values(static_cast<std::size_t>(r == root ? 9 : r), r);
    comm().broadcast(values, root);
    EXPECT_EQ(values, std::vector<double>(9, root));
    std::string text = r == 0 ? "a text longer than sixteen bytes" : "";
    comm().broadcast(text);
    EXPECT_EQ(text, "a text longer than sixteen bytes");
    std::vector<std::int64_t> sums(11, r);
    comm().max(std::span(sums));
    EXPECT_EQ(sums, std::vector<std::int64_t>(11, n - 1));
    comm().impl().largest_message = usual;
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
  int done = 0;
  comm().vote([&] { ++done; });
  comm().vote_on_root([&] { ++done; });
  comm().throw_if_any(std::nullopt);
  EXPECT_EQ(done, comm().rank() == 0 ? 2 : 1);
}

TEST(Communicator, VoteTurnsForeignExceptionsIntoFileErrors) {
  const auto message_of = [](const std::function<void()>& work) {
    try {
      comm().vote_on_root(work);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::file);
      return std::string(e.what());
    }
    return std::string("nothing thrown");
  };
  EXPECT_EQ(message_of([] { throw std::runtime_error("from a library"); }), "from a library");
  EXPECT_NE(message_of([] { throw std::bad_alloc(); }).find("memory"), std::string::npos);
  EXPECT_NE(message_of([] { throw 5; }).find("unknown"), std::string::npos);
}

TEST(Communicator, DuplicatesAreSeparateAndShareTheCounters) {
  const Communicator other = comm().duplicate();
  EXPECT_EQ(other.rank(), comm().rank());
  EXPECT_EQ(other.size(), comm().size());
  ++other.count("of the duplicate").calls;
  EXPECT_EQ(comm().count("of the duplicate").calls, 1);
  EXPECT_EQ(comm().counts().back().name, "of the duplicate");
  const Communicator alone = Communicator::self();
  EXPECT_EQ(alone.size(), 1);
  EXPECT_EQ(alone.max(comm().rank()), comm().rank());
  EXPECT_FALSE(MpiEnvironment::library_version().empty());
}

}  // namespace
}  // namespace tenon

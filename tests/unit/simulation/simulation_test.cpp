// SPDX-License-Identifier: BSD-3-Clause
#include "framework/simulation/simulation.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/unit/simulation/counting_component.hpp"

namespace tenon {
namespace {

using testing::communicator;
using testing::CountingComponent;
using testing::CountingCoupling;

struct Pair {
  Log log{false};
  Simulation simulation{communicator(), log, 0.0, 1.0};
  CountingComponent& fast;
  CountingComponent& slow;
  Pair(double fast_limit, double slow_limit) : fast(add("fast", fast_limit)), slow(add("slow", slow_limit)) {}
  CountingComponent& add(const char* name, double limit) {
    return static_cast<CountingComponent&>(simulation.add(std::make_unique<CountingComponent>(name, limit)));
  }
  CountingCoupling& couple(Component& from, Component& to, CouplingSchedule schedule) {
    return static_cast<CountingCoupling&>(
        simulation.add(std::make_unique<CountingCoupling>("link", from, to, schedule)));
  }
};

TEST(Simulation, AloneReachesTheEndExactly) {
  Log log(false);
  Simulation simulation(communicator(), log, 0.0, 1.0);
  auto& only = static_cast<CountingComponent&>(simulation.add(std::make_unique<CountingComponent>("only", 0.3)));
  simulation.initialize();
  simulation.run();
  EXPECT_TRUE(simulation.done());
  EXPECT_EQ(only.steps.size(), 4u);
  EXPECT_NEAR(only.time(), 1.0, 1e-15);
}

TEST(Simulation, FollowerNeverExceedsItsLimitAndAllEndTogether) {
  for (const double slow_limit : {0.011, 0.05, 0.0999, 0.1, 0.37, std::numeric_limits<double>::infinity()}) {
    Pair pair(0.01, slow_limit);
    pair.simulation.initialize();
    pair.simulation.run();
    EXPECT_EQ(pair.fast.time(), pair.slow.time());
    EXPECT_NEAR(pair.slow.time(), 1.0, 1e-12);
    EXPECT_NEAR(std::accumulate(pair.slow.steps.begin(), pair.slow.steps.end(), 0.0), 1.0, 1e-12);
    for (const double dt : pair.slow.steps) EXPECT_LE(dt, slow_limit * (1 + 1e-12));
    EXPECT_GE(pair.slow.steps.size(), slow_limit > 1 ? 1u : static_cast<std::size_t>(1.0 / slow_limit));
    EXPECT_LE(static_cast<double>(pair.slow.steps.size()), slow_limit > 1 ? 1.0 : 1.0 / (slow_limit - 0.0099) + 2);
  }
}

TEST(Simulation, AFollowerMayEndItsStepBeforeItsLimit) {
  Pair pair(0.01, 0.3);
  pair.slow.hurry = 0.505;
  pair.simulation.initialize();
  pair.simulation.run();
  ASSERT_GT(pair.slow.steps.size(), 40u);
  EXPECT_NEAR(pair.slow.steps[0], 0.3, 0.0101);  // it may end one step of the leader before its limit
  EXPECT_NEAR(pair.slow.steps[0] + pair.slow.steps[1], 0.51, 1e-12);
  for (std::size_t i = 2; i < pair.slow.steps.size(); ++i) EXPECT_NEAR(pair.slow.steps[i], 0.01, 1e-12);
}

TEST(Simulation, TheSmallerStepLeadsWhicheverWasAddedFirst) {
  Pair pair(0.2, 0.05);  // "slow" has the smaller step here
  pair.simulation.initialize();
  pair.simulation.run();
  EXPECT_EQ(&pair.simulation.leader(), &pair.slow);
  EXPECT_LT(pair.fast.steps.size(), pair.slow.steps.size());
}

TEST(Simulation, CouplingsRunOncePerSlowStepOrAtEveryStepOfTheSource) {
  Pair pair(0.01, 0.1);
  CountingCoupling& down = pair.couple(pair.fast, pair.slow, CouplingSchedule::slower_step);
  CountingCoupling& up = pair.couple(pair.slow, pair.fast, CouplingSchedule::slower_step);
  CountingCoupling& each = pair.couple(pair.fast, pair.slow, CouplingSchedule::source_step);
  pair.simulation.initialize();
  pair.simulation.run();
  const std::size_t slow_steps = pair.slow.steps.size();
  EXPECT_EQ(down.clocks.size(), slow_steps + 1);  // and once at the start
  EXPECT_EQ(up.clocks.size(), slow_steps + 1);
  EXPECT_EQ(each.clocks.size(), pair.fast.steps.size() + 1);
  for (std::size_t i = 1; i < down.clocks.size(); ++i) EXPECT_GT(down.clocks[i].first, down.clocks[i].second);
  for (std::size_t i = 1; i < up.clocks.size(); ++i) EXPECT_EQ(up.clocks[i].first, up.clocks[i].second);
}

TEST(EnergyLedger, ClosesAndShowsALeak) {
  Pair pair(0.01, 0.1);
  pair.simulation.initialize();
  pair.simulation.run();
  EXPECT_LT(pair.simulation.ledger().take().error, 1e-14);
  pair.slow.leak = 0.07;
  const LedgerSnapshot leaking = pair.simulation.ledger().take();
  EXPECT_NEAR(leaking.residual[1], -0.07, 1e-12);
  EXPECT_NEAR(leaking.error, 0.07 / (5 + 5.93 + 1), 1e-3);
}

TEST(EnergyLedger, NamesRowsByComponentOnlyWhereTheyRepeat) {
  Pair pair(0.01, 0.1);
  pair.simulation.initialize();
  const std::vector<std::string> columns = pair.simulation.ledger().columns();
  ASSERT_EQ(columns.size(), 4u);
  EXPECT_EQ(columns[0], "fast.stored_energy");
  Log log(false);
  Simulation alone(communicator(), log, 0.0, 1.0);
  alone.add(std::make_unique<CountingComponent>("only", 0.3));
  alone.initialize();
  EXPECT_EQ(alone.ledger().columns()[0], "stored_energy");
}

struct Throwing : CountingComponent {
  using CountingComponent::CountingComponent;
  void advance(double dt) override {
    CountingComponent::advance(dt);
    if (steps.size() == 3) throw Error(ExitCode::geometry, "inverted");
  }
};

struct Watching : Observer {
  int failures = 0, observed = 0, lasts = 0;
  void start(Simulation&, bool) override {}
  void after_step(Simulation&, bool last) override {
    ++observed;
    lasts += last;
  }
  void after_failure(Simulation&) override { ++failures; }
};

TEST(Simulation, ObserversKeepWhatTheyCanWhenAStepFails) {
  Log log(false);
  Simulation simulation(communicator(), log, 0.0, 1.0);
  simulation.add(std::make_unique<Throwing>("only", 0.1));
  auto& watching = static_cast<Watching&>(simulation.add(std::make_unique<Watching>()));
  simulation.initialize();
  EXPECT_THROW(simulation.run(), Error);
  EXPECT_EQ(watching.failures, 1);
  EXPECT_EQ(watching.observed, 2);
  EXPECT_EQ(watching.lasts, 0);
}

}  // namespace
}  // namespace tenon

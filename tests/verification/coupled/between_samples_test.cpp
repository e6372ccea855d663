// SPDX-License-Identifier: BSD-3-Clause
// What a receiver sees between the samples of a source with another step: order in time, conservation, restart.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "framework/mesh/generators.hpp"
#include "framework/simulation/simulation.hpp"
#include "tests/support/test_communicator.hpp"
#include "transfer/field_link.hpp"
#include "transfer/mesh_items.hpp"

namespace tenon {
namespace {

using testing::communicator;
using transfer::BetweenSamples;

std::shared_ptr<const Mesh> cube(int n, std::uint64_t seed) {
  BoxShape shape;
  shape.elements = {n, n, n};
  shape.distortion = 0.2;
  shape.seed = seed;
  DistributeOptions options;
  options.method = seed % 2 == 0 ? PartitionMethod::rcb : PartitionMethod::graph;
  return distribute(communicator(), generate(shape), options);
}

/// Values at nodes with u' = c v, v what it receives, by the trapezoidal rule; or with u a given function of time.
/// Gives away an amount that gathers at a rate of its own, and counts what it receives of that kind.
class Oscillator : public Component {
 public:
  struct Description {
    double step, start = 1, factor = 0;
    double (*given)(double) = nullptr;  // of time
    double (*rate)(double) = nullptr;   // of the amount, 1/s, at all nodes alike
  };
  Oscillator(std::string name, std::shared_ptr<const Mesh> mesh, const Description& description)
      : Component(std::move(name)), about_(description), mesh_(std::move(mesh)) {
    const auto nodes = static_cast<std::size_t>(mesh_->nodes());
    state.assign(nodes, description.start), received.assign(nodes, 0.0), begun_.assign(nodes, 0.0);
    gathered_.assign(nodes, 0.0), kept.assign(nodes, 0.0);
  }
  std::string_view type() const override { return "oscillator"; }
  const Mesh& mesh() const override { return *mesh_; }
  void initialize() override {
    if (about_.given && time() == 0) show(0);
  }
  double time_step() override { return about_.step; }
  StepLimiter limiter() override { return {about_.step, "a constant"}; }
  void advance(double dt) override {
    const double end = time() + dt;
    // What was received is the other's value at the end of this step; that of its beginning was seen a step ago.
    for (std::size_t n = 0; n < state.size(); ++n) {
      state[n] += about_.factor * dt * 0.5 * ((steps > 0 ? begun_[n] : received[n]) + received[n]);
      if (about_.rate) gathered_[n] += dt * about_.rate(time() + 0.5 * dt);
    }
    begun_ = received;
    ++steps;
    set_time(end);
    if (about_.given) show(end);
    at_end.push_back({end, received.empty() ? 0.0 : received.front()});
  }
  std::vector<ExportPort> exports() override {
    return {{{"state", Location::node, FieldKind::point_value, 1, "1"},
             [this](std::span<double> to) { std::copy(state.begin(), state.end(), to.begin()); }},
            {{"amount", Location::node, FieldKind::total, 1, "J"}, [this](std::span<double> to) {
               std::copy(gathered_.begin(), gathered_.end(), to.begin());
               std::fill(gathered_.begin(), gathered_.end(), 0.0);
             }}};
  }
  std::vector<ImportPort> imports() override {
    return {{{"other", Location::node, FieldKind::point_value, 1, "1"},
             [this](std::span<const double> from) { received.assign(from.begin(), from.end()); }},
            {{"taken", Location::node, FieldKind::total, 1, "J"}, [this](std::span<const double> from) {
               for (std::size_t n = 0; n < kept.size(); ++n) kept[n] += from[n];
               ++portions;
             }}};
  }
  std::span<const Vec3> current_coordinates() const override { return mesh_->coordinates; }
  void energies(std::vector<EnergyTerm>&) override {}
  std::int64_t work_done() const override { return steps; }
  std::int64_t memory() const override { return 0; }
  void save(CheckpointWriter& file) override {
    const GlobalOrder order(mesh_->comm, transfer::owned_items(*mesh_, Location::node).ids, mesh_->global_nodes);
    const auto put = [&](const char* what, const std::vector<double>& values) {
      std::vector<double> owned;
      for (const LocalIndex n : mesh_->owned_nodes) owned.push_back(values[static_cast<std::size_t>(n)]);
      file.array(name() + what, order, owned, 1);
    };
    put(".state", state), put(".received", received), put(".begun", begun_);
    put(".gathered", gathered_), put(".kept", kept);
    file.integer(name() + ".steps", steps);
  }
  void load(const CheckpointReader& file) override {
    const GlobalOrder order(mesh_->comm, mesh_->node_ids, mesh_->global_nodes);
    file.array(name() + ".state", order, state, 1), file.array(name() + ".received", order, received, 1);
    file.array(name() + ".begun", order, begun_, 1), file.array(name() + ".gathered", order, gathered_, 1);
    file.array(name() + ".kept", order, kept, 1);
    steps = file.integer(name() + ".steps");
  }
  double sum(const std::vector<double>& values) const {
    ExactSum exact;
    for (const LocalIndex n : mesh_->owned_nodes) exact.add(values[static_cast<std::size_t>(n)]);
    return communicator().sum(exact);
  }

  std::vector<double> state, received, kept;
  std::vector<std::pair<double, double>> at_end;  // time, value received there (this rank's first node)
  std::int64_t steps = 0, portions = 0;

 private:
  void show(double t) { std::fill(state.begin(), state.end(), about_.given(t)); }

  Description about_;
  std::shared_ptr<const Mesh> mesh_;
  std::vector<double> begun_, gathered_;
};

struct Coupled {
  Log log{false};
  Simulation simulation;
  Oscillator &a, &b;
  Coupled(double end, const Oscillator::Description& first, const Oscillator::Description& second)
      : simulation(communicator(), log, 0.0, end), a(add("a", 2, first)), b(add("b", 3, second)) {}
  Oscillator& add(const char* name, int n, const Oscillator::Description& description) {
    return static_cast<Oscillator&>(
        simulation.add(std::make_unique<Oscillator>(name, cube(n, static_cast<std::uint64_t>(n)), description)));
  }
  transfer::FieldLink& link(const char* name, Oscillator& from, Oscillator& to, bool amount, BetweenSamples between,
                            CouplingSchedule schedule = CouplingSchedule::slower_step) {
    transfer::FieldLinkOptions options;
    options.source_field = amount ? "amount" : "state";
    options.target_field = amount ? "taken" : "other";
    options.schedule = schedule;
    options.between_samples = between;
    return static_cast<transfer::FieldLink&>(
        simulation.add(std::make_unique<transfer::FieldLink>(name, from, to, options)));
  }
  double amount(transfer::FieldLink& link, std::size_t which) {
    return communicator().sum(link.amounts().at(which).second);
  }
};

double line(double t) {
  return 3 - 2 * t;
}
double rate(double t) {
  return 5 + std::sin(7 * t);
}

/// Step of the source, step of the receiver, s.
const std::vector<std::pair<double, double>> step_pairs{
    {0.1, 0.01}, {0.1 * std::sqrt(2.0), 0.03}, {0.0217, 0.02}, {0.05, 0.05}, {0.01, 0.1}, {0.03, 0.1 * std::sqrt(3.0)}};

double greatest_error(BetweenSamples between, double source_step, double target_step) {
  Coupled run(1, {.step = source_step, .given = line}, {.step = target_step});
  run.link("values", run.a, run.b, false, between);
  run.simulation.initialize();
  run.simulation.run();
  double greatest = 0;
  for (const auto& [time, value] : run.b.at_end)
    if (time > source_step + target_step) greatest = std::max(greatest, std::abs(value - line(time)));  // two samples
  EXPECT_FALSE(run.b.at_end.empty());
  return communicator().max(greatest);
}

TEST(BetweenSamples, ALineInTimeIsSeenExactlyWhateverTheSteps) {
  for (const auto& [source, target] : step_pairs) {
    EXPECT_LE(greatest_error(BetweenSamples::linear, source, target), 1e-13) << source << " to " << target;
    if (source > 2 * target) {
      const double held = greatest_error(BetweenSamples::hold, source, target);
      EXPECT_GE(held, 0.7 * 2 * (source - target)) << source << " to " << target;
      EXPECT_LE(held, 1.01 * 2 * (source + target)) << source << " to " << target;
    }
  }
}

/// Greatest error of x' = y, y' = -x with a step for each.
double coupled_error(BetweenSamples between, double x_step, double y_step) {
  Coupled run(1, {.step = x_step, .start = 0, .factor = 1}, {.step = y_step, .start = 1, .factor = -1});
  run.link("x", run.a, run.b, false, between);
  run.link("y", run.b, run.a, false, between);
  run.simulation.initialize();
  run.simulation.run();
  double greatest = 0;
  for (const double x : run.a.state) greatest = std::max(greatest, std::abs(x - std::sin(1.0)));
  for (const double y : run.b.state) greatest = std::max(greatest, std::abs(y - std::cos(1.0)));
  return communicator().max(greatest);
}

TEST(BetweenSamples, CoupledOscillatorsAreFirstOrderHeldAndSecondOrderLinear) {
  for (const auto& [x, y] : {std::pair{0.1, 0.02}, {0.02, 0.1}, {0.1, 0.1 / std::sqrt(30.0)}, {0.1, 0.1}})
    for (const auto& [between, order] : {std::pair{BetweenSamples::hold, 1.0}, {BetweenSamples::linear, 2.0}}) {
      const double coarse = coupled_error(between, x / 2, y / 2), fine = coupled_error(between, x / 8, y / 8);
      const double measured = std::log2(coarse / fine) / 2;
      EXPECT_NEAR(measured, order, 0.3) << x << ", " << y << ": " << coarse << " and " << fine;
    }
}

/// Checks after every step that nothing is lost or counted twice.
struct Bookkeeper : Observer {
  Coupled& run;
  transfer::FieldLink& link;
  double greatest = 0, most_waiting = 0;
  std::int64_t steps = 0;
  Bookkeeper(Coupled& r, transfer::FieldLink& l) : run(r), link(l) {}
  void start(Simulation&, bool) override {}
  void after_step(Simulation&, bool) override {
    ++steps;
    const double sent = run.amount(link, 0), arrived = run.amount(link, 1);
    const double waits = link.amounts().size() > 2 ? run.amount(link, 2) : 0;
    const double kept = run.b.sum(run.b.kept);
    greatest = std::max({greatest, std::abs(sent - arrived - waits), std::abs(arrived - kept)});
    most_waiting = std::max(most_waiting, waits);
  }
};

TEST(BetweenSamples, AmountsAreNeitherLostNorCountedTwiceAtAnyMoment) {
  for (const BetweenSamples between : {BetweenSamples::hold, BetweenSamples::linear})
    for (const CouplingSchedule schedule : {CouplingSchedule::slower_step, CouplingSchedule::source_step})
      for (const auto& [source, target] : step_pairs) {
        Coupled run(1, {.step = source, .rate = rate}, {.step = target});
        transfer::FieldLink& link = run.link("amounts", run.a, run.b, true, between, schedule);
        auto& books = static_cast<Bookkeeper&>(run.simulation.add(std::make_unique<Bookkeeper>(run, link)));
        run.simulation.initialize();
        run.simulation.run();
        EXPECT_GT(books.steps, 5);
        const double sent = run.amount(link, 0);
        EXPECT_LE(books.greatest, 1e-14 * sent * static_cast<double>(books.steps)) << source << " to " << target;
        EXPECT_NEAR(sent, 27 * (5 + (1 - std::cos(7.0)) / 7), 0.5);  // (2 + 1)^3 nodes
        if (between == BetweenSamples::hold) {
          EXPECT_EQ(books.most_waiting, 0);
        } else if (source > 2 * target) {
          EXPECT_GE(books.most_waiting, 27 * 4 * (source - 2 * target));
          EXPECT_LE(books.most_waiting, 27 * 6 * (source + target));
        }
      }
}

TEST(BetweenSamples, AmountsArriveEvenlyOrAtOnce) {
  for (const BetweenSamples between : {BetweenSamples::hold, BetweenSamples::linear}) {
    Coupled run(1, {.step = 0.26, .rate = [](double) { return 4.0; }}, {.step = 0.0625});
    run.link("amounts", run.a, run.b, true, between);
    run.simulation.initialize();
    double before = 0;
    for (int step = 0; !run.simulation.done(); ++step) {
      run.simulation.step();
      const double now = run.b.sum(run.b.kept), taken = now - before;
      before = now;
      // The receiver leads; the source follows after every fourth of its steps.
      const double even = step < 4 ? 0 : 27 * 4 * 0.0625, once = step % 4 == 3 ? 27 * 4 * 0.25 : 0;
      EXPECT_NEAR(taken, between == BetweenSamples::linear ? even : once, 1e-12) << step;
    }
  }
}

TEST(BetweenSamples, AnAdaptiveReceiverRefusesAmountsThatAreKeptBack) {
  struct Impatient : Oscillator {
    using Oscillator::Oscillator;
    std::vector<ImportPort> imports() override {
      std::vector<ImportPort> ports = Oscillator::imports();
      for (ImportPort& port : ports) port.at_source_steps = "it chooses its step by what comes in";
      return ports;
    }
  };
  Oscillator source("a", cube(2, 2), {.step = 1});
  Impatient target("b", cube(2, 2), {.step = 1});
  transfer::FieldLinkOptions options;
  options.source_field = "amount", options.target_field = "taken";
  options.schedule = CouplingSchedule::source_step;
  EXPECT_NO_THROW(transfer::FieldLink("amounts", source, target, options));
  options.between_samples = BetweenSamples::linear;
  EXPECT_THROW(transfer::FieldLink("amounts", source, target, options), Error);
}

struct Links {
  transfer::FieldLink &x, &y, &amounts;
  explicit Links(Coupled& run)
      : x(run.link("x", run.a, run.b, false, BetweenSamples::linear)),
        y(run.link("y", run.b, run.a, false, BetweenSamples::linear)),
        amounts(run.link("amounts", run.a, run.b, true, BetweenSamples::linear)) {}
};

TEST(BetweenSamples, ARestartInTheMiddleChangesNoBit) {
  const Oscillator::Description slow{.step = 0.1 * std::sqrt(2.0), .start = 0, .factor = 1, .rate = rate};
  const Oscillator::Description fast{.step = 0.03, .start = 1, .factor = -1};
  const std::string path = "between_samples." + std::to_string(communicator().size()) + ".h5";
  for (const std::int64_t at : {0, 2, 6, 17}) {  // before, between and after samples
    Coupled whole(1, slow, fast);
    Links links(whole);
    whole.simulation.initialize();
    while (!whole.simulation.done()) {
      if (whole.simulation.steps() == at) {
        CheckpointWriter file(communicator(), path);
        whole.simulation.save(file);
        file.finish();
      }
      whole.simulation.step();
    }
    Coupled rest(1, slow, fast);
    Links again(rest);
    {
      const CheckpointReader file(communicator(), path);
      rest.simulation.initialize(&file);
    }
    rest.simulation.run();
    EXPECT_EQ(rest.a.state, whole.a.state) << at;
    EXPECT_EQ(rest.b.state, whole.b.state) << at;
    EXPECT_EQ(rest.b.received, whole.b.received) << at;
    EXPECT_EQ(rest.b.kept, whole.b.kept) << at;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(rest.amount(again.amounts, i), whole.amount(links.amounts, i)) << at;
    communicator().barrier();
    if (communicator().rank() == 0) std::filesystem::remove(path);
    communicator().barrier();
  }
}

TEST(BetweenSamples, ARunThatHeldCanGoOnLinearly) {
  const std::string path = "between_samples_held." + std::to_string(communicator().size()) + ".h5";
  Coupled held(1, {.step = 0.1, .given = line, .rate = rate}, {.step = 0.03});
  held.link("values", held.a, held.b, false, BetweenSamples::hold);
  held.link("amounts", held.a, held.b, true, BetweenSamples::hold);
  held.simulation.initialize();
  while (held.simulation.time() < 0.5) held.simulation.step();
  {
    CheckpointWriter file(communicator(), path);
    held.simulation.save(file);
    file.finish();
  }
  Coupled rest(1, {.step = 0.1, .given = line, .rate = rate}, {.step = 0.03});
  rest.link("values", rest.a, rest.b, false, BetweenSamples::linear);
  transfer::FieldLink& amounts = rest.link("amounts", rest.a, rest.b, true, BetweenSamples::linear);
  {
    const CheckpointReader file(communicator(), path);
    rest.simulation.initialize(&file);
  }
  rest.simulation.run();
  for (const auto& [time, value] : rest.b.at_end) {
    // Two samples after the restart there is a line again.
    EXPECT_LE(std::abs(value - line(time)), time > 0.75 ? 1e-13 : 2 * 0.14) << time;
  }
  EXPECT_NEAR(rest.amount(amounts, 0), rest.amount(amounts, 1) + rest.amount(amounts, 2), 1e-11);
  EXPECT_GT(rest.amount(amounts, 2), 5);
  EXPECT_NE(amounts.report().front().find("linear between samples"), std::string::npos);
  communicator().barrier();
  if (communicator().rank() == 0) std::filesystem::remove(path);
}

}  // namespace
}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// TR-BDF2 with a step of its own beside another component: it begins with nothing to do, and steps when heat or a load
// comes.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <fstream>

#include "components/thermal/thermal.hpp"
#include "framework/simulation/simulation.hpp"
#include "tests/unit/thermal/thermal_case.hpp"
#include "transfer/field_link.hpp"

namespace tenon::testing {
namespace {

constexpr double density = 7850, specific_heat = 460, start_temperature = 300;
constexpr double end_time = 0.05, step = 1e-4, tolerance = 2;

/// A body that makes heat in short steps, at first and in the end none; in all as much as warms a cube of steel of 1 m
/// by `rise`.
class Source : public Component {
 public:
  explicit Source(double rise)
      : Component("source"), mesh_(distributed(cube(2))), energy_(rise * density * specific_heat) {
    share_.assign(static_cast<std::size_t>(mesh_->nodes()), 0.0);
    const auto corners = static_cast<double>(8 * mesh_->global_elements);
    for (const LocalIndex n : mesh_->blocks.front().connectivity) share_[static_cast<std::size_t>(n)] += 1 / corners;
  }
  std::string_view type() const override { return "source"; }
  const Mesh& mesh() const override { return *mesh_; }
  void initialize() override {}
  double time_step() override { return step; }
  StepLimiter limiter() override { return {step, "a constant"}; }
  void advance(double dt) override {
    const auto made = [](double t) { return TimeFunction::smooth_step(0, 1, 0.2 * end_time, 0.7 * end_time)(t); };
    waiting_ += energy_ * (made(time() + dt) - made(time()));
    set_time(time() + dt);
  }
  std::vector<ExportPort> exports() override {
    return {{{"heat", Location::node, FieldKind::total, 1, "J"}, [this](std::span<double> out) {
               for (std::size_t n = 0; n < out.size(); ++n) out[n] = waiting_ * share_[n];
               waiting_ = 0;
             }}};
  }
  std::vector<ImportPort> imports() override { return {}; }
  std::span<const Vec3> current_coordinates() const override { return mesh_->coordinates; }
  void energies(std::vector<EnergyTerm>&) override {}
  void save(CheckpointWriter& file) override { file.scalar("source.waiting", waiting_); }
  void load(const CheckpointReader& file) override { waiting_ = file.scalar("source.waiting"); }
  std::int64_t work_done() const override { return 0; }
  std::int64_t memory() const override { return 0; }

 private:
  std::shared_ptr<const Mesh> mesh_;
  std::vector<double> share_;  // of the local nodes: a node's volume, as all have the same elements
  double energy_, waiting_ = 0;
};

ThermalOptions adaptive() {
  ThermalOptions options;
  options.blocks = {{"box", density, specific_heat, 50, start_temperature}};
  options.stepper = ThermalStepper::tr_bdf2;
  options.control.tolerance = tolerance;
  return options;
}

transfer::FieldLinkOptions heat_link(CouplingSchedule schedule) {
  return {"heat", "heat", {}, transfer::Configuration::reference, schedule};
}

struct Coupled {
  Log log{false};
  Simulation simulation{communicator(), log, 0.0, end_time};
  Component& source;
  Thermal& heat;

  Coupled(double rise, const ThermalOptions& options, const CheckpointReader* checkpoint = nullptr)
      : source(simulation.add(std::make_unique<Source>(rise))),
        heat(static_cast<Thermal&>(simulation.add(conduction(options)))) {
    simulation.add(
        std::make_unique<transfer::FieldLink>("heat", source, heat, heat_link(CouplingSchedule::source_step)));
    simulation.initialize(checkpoint);
  }
  static std::unique_ptr<Component> conduction(const ThermalOptions& options) {
    return std::make_unique<Thermal>("conduction", distributed(cube(2)), options);
  }
  double row(const std::string& name) {
    for (const LedgerRow& r : simulation.ledger().take().rows)
      if (r.row == name) return r.value;
    return 0;
  }
  /// K, of the mean temperature, if all that has been supplied were shown.
  double supplied_rise() { return (row("transferred_heat") + row("flux_heat")) / (density * specific_heat); }
  double mean_rise() const {
    ExactSum sum;
    for (const LocalIndex n : heat.mesh().owned_nodes) sum.add(heat.temperature()[static_cast<std::size_t>(n)]);
    return communicator().sum(sum) / static_cast<double>(heat.mesh().global_nodes) - start_temperature;
  }
  /// Bits of all temperatures, as rank 0 sees them, ordered by node.
  std::string bits() const {
    struct Item {
      GlobalId id;
      double value;
    };
    std::vector<Item> mine;
    for (const LocalIndex n : heat.mesh().owned_nodes) {
      const auto i = static_cast<std::size_t>(n);
      mine.push_back({heat.mesh().node_ids[i], heat.temperature()[i]});
    }
    std::vector<Item> all = communicator().gather(std::span<const Item>(mine));
    std::ranges::sort(all, {}, &Item::id);
    std::string text = fmt::format("{} steps\n", heat.steps_taken());
    for (const Item& item : all) text += fmt::format("{} {:a}\n", item.id, item.value);
    communicator().broadcast(text);
    return text;
  }
};

TEST(AdaptiveConduction, StepsWhenHeatComes) {
  Coupled run(80, adaptive());
  EXPECT_EQ(run.heat.time_step(), std::numeric_limits<double>::infinity());  // nothing to do yet
  double before = 0, most_at_once = 0, lag = 0;
  while (!run.simulation.done()) {
    run.simulation.step();
    const double supplied = run.supplied_rise();
    most_at_once = std::max(most_at_once, supplied - before);
    before = supplied;
    lag = std::max(lag, supplied - run.mean_rise());
  }
  EXPECT_NEAR(run.supplied_rise(), 80.0, 1e-9);
  EXPECT_LT(lag, tolerance + most_at_once);
  EXPECT_GE(run.heat.steps_taken(), static_cast<std::int64_t>(80.0 / (tolerance + most_at_once)));
  EXPECT_LT(run.simulation.ledger().take().error, 1e-11);

  // The same bits on any number of ranks: the run on one rank (a fixture) leaves what the others compare with.
  const std::string bits = run.bits();
  if (communicator().size() == 1) {
    std::ofstream("adaptive_conduction_np1.txt") << bits;
  } else {
    std::ifstream file("adaptive_conduction_np1.txt");
    EXPECT_EQ(bits, std::string(std::istreambuf_iterator<char>(file), {}));
  }
}

TEST(AdaptiveConduction, RestartsInTheMidst) {
  const std::string path = fmt::format("adaptive_conduction_np{}.h5", communicator().size());
  Coupled first(80, adaptive());
  while (first.simulation.time() < 0.5 * end_time) first.simulation.step();
  EXPECT_LT(first.heat.time(), first.simulation.time());  // conduction lags: heat waits
  {
    CheckpointWriter file(communicator(), path);
    first.simulation.save(file);
    file.finish();
  }
  first.simulation.run();
  const CheckpointReader file(communicator(), path);
  Coupled second(80, adaptive(), &file);
  second.simulation.run();
  const auto temperatures = [](const std::string& bits) { return bits.substr(bits.find('\n')); };
  EXPECT_EQ(temperatures(first.bits()), temperatures(second.bits()));
}

TEST(AdaptiveConduction, StepsWhenALoadSetsIn) {
  ThermalOptions options = adaptive();
  options.fluxes = {{"x_max", TimeFunction::table({{0.5 * end_time, 0.0}, {0.5 * end_time + 1e-6, 5e9}})}};
  Coupled run(0, options);
  EXPECT_EQ(run.heat.time_step(), std::numeric_limits<double>::infinity());
  while (run.simulation.time() < 0.49 * end_time) run.simulation.step();
  EXPECT_EQ(run.heat.steps_taken(), 0);
  // 1 m^2 of the surface, whose nodes hold a quarter of the capacity, warms by the tolerance in 0.4 ms.
  while (run.simulation.time() < 0.51 * end_time) run.simulation.step();
  EXPECT_GE(run.heat.time(), 0.5 * end_time);
  run.simulation.run();
  EXPECT_GE(run.heat.steps_taken(), 5);
  EXPECT_LT(run.simulation.ledger().take().error, 1e-11);
  EXPECT_NEAR(run.row("flux_heat"), 5e9 * (0.5 * end_time - 0.5e-6), 0.03 * 5e9 * 0.5 * end_time);
}

TEST(AdaptiveConduction, MustSeeHeatAtOnceOrHaveALongestStep) {
  const auto link = [](const ThermalOptions& options) {
    Source source(0);
    const auto heat = Coupled::conduction(options);
    const transfer::FieldLink made("heat", source, *heat, heat_link(CouplingSchedule::slower_step));
  };
  try {
    link(adaptive());
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("time_step.maximum"), std::string::npos) << error.what();
  }
  ThermalOptions options = adaptive();
  options.control.maximum = 1e-3;
  EXPECT_NO_THROW(link(options));
}

}  // namespace
}  // namespace tenon::testing

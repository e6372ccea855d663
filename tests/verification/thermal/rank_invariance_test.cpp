// SPDX-License-Identifier: BSD-3-Clause
// The state is the same, bit for bit, on any number of ranks, also after a restart from half-way.
// The run on one rank (a test fixture) leaves the files that the others compare with.
#include <gtest/gtest.h>

#include <cstring>

#include "thermal_case.hpp"

namespace tenon::testing {
namespace {

struct Case {
  std::string name;
  ThermalStepper stepper;
  BoxShape shape;
  bool warm = false, multigrid = false;

  ThermalOptions options() const {
    ThermalOptions o = warm ? all_loads_warm(stepper) : all_loads(stepper);
    if (multigrid) o.preconditioner = ThermalPreconditioner::multigrid;
    return o;
  }
};

std::vector<Case> cases() {
  return {{"explicit_hex", ThermalStepper::explicit_euler, cube(6, false, 0.2)},
          {"explicit_tet", ThermalStepper::explicit_euler, cube(4, true, 0.2)},
          {"backward_hex", ThermalStepper::backward_euler, cube(5, false, 0.2)},
          {"backward_tet", ThermalStepper::backward_euler, cube(6, true, 0.2)},
          {"crank_tet", ThermalStepper::crank_nicolson, cube(4, true, 0.2)},
          {"one_element", ThermalStepper::backward_euler, cube(1)},
          {"one_element_multigrid", ThermalStepper::backward_euler, cube(1), false, true},
          {"multigrid_tet", ThermalStepper::backward_euler, cube(6, true, 0.2), false, true},
          {"tr_bdf2_tet", ThermalStepper::tr_bdf2, cube(5, true, 0.2)},
          {"tr_bdf2_multigrid", ThermalStepper::tr_bdf2, cube(7, false, 0.2), false, true},
          {"tr_bdf2_warm", ThermalStepper::tr_bdf2, cube(4, true, 0.2), true, true},
          {"backward_warm", ThermalStepper::backward_euler, cube(4, false, 0.2), true},
          {"steady_warm", ThermalStepper::steady, cube(4, true, 0.2), true, true}};
}

constexpr int steps = 16;

std::string file_name(const Case& c, const char* when, int ranks) {
  return "thermal_" + c.name + "_" + when + "_np" + std::to_string(ranks) + ".h5";
}

void save(Thermal& thermal, const std::string& path) {
  CheckpointWriter file(communicator(), path);
  file.scalar("time", thermal.time());
  thermal.save(file);
  file.finish();
}

/// Steps `first` to `last`, moved and heated every third.
void run(Thermal& thermal, int first, int last) {
  for (int step = first; step < last; ++step) {
    if (step % 3 == 1) disturb(thermal, 0.002 * step);
    thermal.advance(std::min(thermal.time_step(), 40.0));
  }
}

/// Every value of the file, bit for bit, against that of one rank.
void expect_same_state(const Case& c, const Mesh& mesh, const char* when) {
  const Communicator& comm = communicator();
  const CheckpointReader reference(comm, file_name(c, when, 1)), mine(comm, file_name(c, when, comm.size()));
  EXPECT_EQ(mine.scalar("time"), reference.scalar("time"));
  for (const char* scalar : {"heat.last_dt", "heat.next_step", "heat.multigrid_factor"})
    EXPECT_EQ(mine.scalar(scalar), reference.scalar(scalar)) << c.name << ", " << when << ", " << scalar;
  for (const char* integer : {"heat.multigrid", "heat.multigrid_stale"})
    EXPECT_EQ(mine.integer(integer), reference.integer(integer)) << c.name << ", " << when << ", " << integer;
  const GlobalOrder order(comm, mesh.node_ids, mesh.global_nodes);
  int supplies = 0;
  for (const char* name : {"initial_temperature", "temperature_rise", "waiting_heat", "last_increment", "displacement",
                           "supplied_transferred", "supplied_flux", "supplied_convection", "supplied_source",
                           "supplied_prescribed", "supplied_radiation", "supplied_steady"}) {
    const bool supply = std::string(name).starts_with("supplied_");
    EXPECT_EQ(mine.has(std::string("heat.") + name), reference.has(std::string("heat.") + name)) << name;
    if (supply && !reference.has(std::string("heat.") + name)) continue;
    supplies += supply ? 1 : 0;
    const int components = std::string(name) == "displacement" ? 3 : 1;
    std::vector<double> a(mesh.node_ids.size() * static_cast<std::size_t>(components)), b(a.size());
    reference.array(std::string("heat.") + name, order, a, components);
    mine.array(std::string("heat.") + name, order, b, components);
    EXPECT_TRUE(a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0)
        << c.name << ", " << when << ", " << name;
  }
  EXPECT_EQ(supplies, 5 + (c.warm ? 1 : 0) + (c.stepper == ThermalStepper::steady ? 1 : 0)) << c.name;
}

TEST(ThermalRanks, StateIsTheSame) {
  for (const Case& c : cases()) {
    Thermal thermal("heat", distributed(c.shape), c.options());
    thermal.initialize();
    run(thermal, 0, steps / 2);
    save(thermal, file_name(c, "half", communicator().size()));
    run(thermal, steps / 2, steps);
    save(thermal, file_name(c, "end", communicator().size()));
    expect_same_state(c, thermal.mesh(), "half");
    expect_same_state(c, thermal.mesh(), "end");
  }
}

TEST(ThermalRanks, RestartGoesOnAsIfNothingHadHappened) {
  for (const Case& c : cases()) {
    Thermal thermal("heat", distributed(c.shape), c.options());
    const CheckpointReader file(communicator(), file_name(c, "half", 1));
    thermal.set_clock(file.scalar("time"));
    thermal.load(file);
    thermal.initialize();
    run(thermal, steps / 2, steps);
    save(thermal, file_name(c, "end", communicator().size()));
    expect_same_state(c, thermal.mesh(), "end");
  }
}

}  // namespace
}  // namespace tenon::testing

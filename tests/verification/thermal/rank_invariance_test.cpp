// SPDX-License-Identifier: BSD-3-Clause
// The state is the same, bit for bit, on any number of ranks, also after a restart from half-way.
// The run on one rank (a test fixture) leaves the files that the others compare with.
#include <gtest/gtest.h>

#include <cstring>

#include "thermal_contact_case.hpp"

namespace tenon::testing {
namespace {

void add_contact(ThermalOptions& o, double conductance);

struct Case {
  std::string name;
  ThermalStepper stepper;
  BoxShape shape;
  bool warm = false, multigrid = false, contact = false;
  double conductance = 0;  // of contact, W/(m^2 K); 0: two that vary

  ThermalOptions options() const {
    ThermalOptions o = warm ? all_loads_warm(stepper) : all_loads(stepper);
    if (multigrid) o.preconditioner = ThermalPreconditioner::multigrid;
    if (contact) add_contact(o, conductance);
    return o;
  }
  std::shared_ptr<const Mesh> mesh() const {
    if (!contact) return distributed(shape);
    BoxShape other = shape;  // it lies on the first, beyond its edges, a little apart
    other.low = {0.13, -0.21, 1.001}, other.high = {1.3, 0.9, 1.7};
    other.elements = {4, 6, 3};
    return distributed_pair(shape, other);
  }
};

/// Loads of the case on the first body; the second one lives on what passes, by two conductances over pressure and
/// time.
void add_contact(ThermalOptions& o, double conductance) {
  for (ThermalBlock& block : o.blocks) block.block = "a_box";
  o.blocks.push_back({"b_box", 2700, 900, 200, 310});
  for (auto& entry : o.prescribed) entry.node_set = "a_" + entry.node_set;
  const auto rename = [](auto& loads) {
    for (auto& load : loads) load.side_set = "a_" + load.side_set;
  };
  rename(o.fluxes), rename(o.convection), rename(o.radiation);
  for (auto& source : o.sources) source.block = "a_" + source.block;
  ThermalContact contact;
  contact.first = "a_z_max", contact.second = "b_z_min";
  if (conductance > 0) {
    contact.conductance = TimeFunction::constant(conductance);
    o.contacts = {contact};
    return;
  }
  contact.conductance = TimeFunction::table({{0, 300}, {200, 2000}, {400, 2000}});
  contact.reference_pressure = 1e6;
  o.contacts = {contact};
  contact.reference_pressure.reset();
  contact.conductance = TimeFunction::constant(0);
  contact.touching_gap = 1e-5, contact.gap_conductivity = 0.5, contact.least_gap = 1e-4, contact.greatest_gap = 0.05;
  o.contacts.push_back(contact);
}

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
          {"steady_warm", ThermalStepper::steady, cube(4, true, 0.2), true, true},
          {"contact_explicit", ThermalStepper::explicit_euler, cube(3, false, 0.2), false, false, true},
          {"contact_backward", ThermalStepper::backward_euler, cube(5, true, 0.2), false, false, true},
          {"contact_tr_bdf2", ThermalStepper::tr_bdf2, cube(4, false, 0.2), false, true, true},
          {"contact_steady", ThermalStepper::steady, cube(4, true, 0.2), true, true, true},
          {"contact_tied", ThermalStepper::backward_euler, cube(5, false, 0.2), false, true, true, 1e7},
          {"contact_tied_tr_bdf2", ThermalStepper::tr_bdf2, cube(4, true, 0.2), false, true, true, 1e5}};
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

void press(Thermal& thermal, double pressure) {
  std::vector<double> values;
  for (const Vec3& x : thermal.mesh().coordinates) values.push_back(pressure * (1 + x[0] + x[1]));
  import_port(thermal, "contact_pressure").write(values);
}

/// Steps `first` to `last`, moved and heated every third.
void run(const Case& c, Thermal& thermal, int first, int last) {
  for (int step = first; step < last; ++step) {
    if (step % 3 == 1) disturb(thermal, 0.002 * step);
    if (c.contact && c.conductance == 0 && step % 5 == 2) press(thermal, 1e5 * step);
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
  for (const char* name :
       {"initial_temperature", "temperature_rise", "waiting_heat", "last_increment", "displacement",
        "supplied_transferred", "supplied_flux", "supplied_convection", "supplied_source", "supplied_prescribed",
        "supplied_radiation", "supplied_steady", "contact_pressure", "contact_heat"}) {
    const bool supply = std::string(name).starts_with("supplied_");
    EXPECT_EQ(mine.has(std::string("heat.") + name), reference.has(std::string("heat.") + name)) << name;
    if ((supply || std::string(name).starts_with("contact_")) && !reference.has(std::string("heat.") + name)) continue;
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
    Thermal thermal("heat", c.mesh(), c.options());
    thermal.initialize();
    run(c, thermal, 0, steps / 2);
    save(thermal, file_name(c, "half", communicator().size()));
    run(c, thermal, steps / 2, steps);
    save(thermal, file_name(c, "end", communicator().size()));
    expect_same_state(c, thermal.mesh(), "half");
    expect_same_state(c, thermal.mesh(), "end");
  }
}

TEST(ThermalRanks, RestartGoesOnAsIfNothingHadHappened) {
  for (const Case& c : cases()) {
    Thermal thermal("heat", c.mesh(), c.options());
    const CheckpointReader file(communicator(), file_name(c, "half", 1));
    thermal.set_clock(file.scalar("time"));
    thermal.load(file);
    thermal.initialize();
    run(c, thermal, steps / 2, steps);
    save(thermal, file_name(c, "end", communicator().size()));
    expect_same_state(c, thermal.mesh(), "end");
  }
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Case F04: a block of 1 kg slides at 10 m/s over a plate of 1 kg until friction has stopped it. All of its 50 J become
// heat, half of it in each body of equal material.
#include "components/contact/contact.hpp"
#include "components/thermal/thermal.hpp"
#include "framework/simulation/contact_party.hpp"
#include "framework/simulation/simulation.hpp"
#include "mechanics_case.hpp"
#include "transfer/field_link.hpp"
#include "two_bodies.hpp"

namespace tenon::testing {
namespace {

constexpr double density = 1000, specific_heat = 500, friction = 0.3, speed = 10, pull = 1000;  // m/s^2

/// Block a of 0.1 m on plate b of 0.4 x 0.25 x 0.01 m; each has 1 kg.
MeshData block_on_plate(int fineness) {
  BoxShape block, plate;
  block.low = {-0.15, -0.05, 0}, block.high = {-0.05, 0.05, 0.1};
  block.elements = {2 * fineness, 2 * fineness, 2 * fineness};
  plate.low = {-0.2, -0.125, -0.01}, plate.high = {0.2, 0.125, 0};
  plate.elements = {8 * fineness, 5 * fineness, fineness};
  if (communicator().rank() != 0) return {};
  MeshData a = generate(block), b = generate(plate);
  return together(std::move(a), b);
}

std::unique_ptr<Component> sliding_block() {
  MechanicsOptions options;
  const MaterialDescription rubber = elastic_material(40e6, 0, density);
  options.blocks = {{"a_box", rubber, {}, {}}, {"b_box", rubber, {}, {}}};
  options.motions = {motion(PrescribedMotion::Kind::fixed, {"b_z_min"})};
  InitialVelocity start;
  start.block = "a_box", start.velocity = {speed, 0, 0};
  options.initial_velocities = {start};
  BodyForce down;
  down.blocks = {"a_box"}, down.label = "down";
  down.acceleration = {SpaceTimeFunction::constant(0), SpaceTimeFunction::constant(0),
                       SpaceTimeFunction(TimeFunction::smooth_step(0, -pull, 0, 5e-3))};
  options.loads.body_forces = {down};
  return std::make_unique<Mechanics>("mechanics", shared_mesh(block_on_plate(1)), options);
}

std::unique_ptr<Component> conduction(int fineness) {
  ThermalOptions options;
  options.blocks = {{"a_box", density, specific_heat, 0.2, 0}, {"b_box", density, specific_heat, 0.2, 0}};
  options.stepper = ThermalStepper::backward_euler;
  options.fixed_step = 2e-3;
  return std::make_unique<Thermal>("conduction", shared_mesh(block_on_plate(fineness)), options);
}

/// Mean rise of a block of equal hexahedra, K.
double mean_rise(const Thermal& thermal, const std::string& name) {
  ExactSum sum;
  const ElementBlock& block = *thermal.mesh().find_block(name);
  for (const LocalIndex e : owned_elements(block, communicator().rank()))
    for (const LocalIndex n : block.nodes(e)) sum.add(thermal.temperature()[static_cast<std::size_t>(n)]);
  return communicator().sum(sum) / (8 * static_cast<double>(block.global_count));
}

struct Outcome {
  double block_rise = 0, plate_rise = 0, heat = 0, friction_energy = 0, ledger_error = 0;
};

Outcome outcome(int fineness) {
  Log log(false);
  Simulation simulation(communicator(), log, 0.0, 0.05);
  Component& solid = simulation.add(sliding_block());
  solid.contact_party()->contact_fields();  // made before a transfer asks for them
  Component& heat = simulation.add(conduction(fineness));
  ContactOptions options;
  options.friction = {friction, friction};
  simulation.add(std::make_unique<Contact>("contact", communicator(), std::vector<Component*>{&solid}, options));
  transfer::FieldLinkOptions link;
  link.source_field = "friction_heat", link.target_field = "heat";
  simulation.add(std::make_unique<transfer::FieldLink>("friction", solid, heat, link));
  simulation.initialize();
  simulation.run();
  Outcome o;
  const auto& thermal = dynamic_cast<const Thermal&>(heat);
  o.block_rise = mean_rise(thermal, "a_box"), o.plate_rise = mean_rise(thermal, "b_box");
  const LedgerSnapshot ledger = simulation.ledger().take();
  for (const LedgerRow& row : ledger.rows) {
    if (row.row == "thermal_energy") o.heat = row.value;
    if (row.row == "friction_energy") o.friction_energy = row.value;
  }
  o.ledger_error = ledger.error;
  return o;
}

void expect_half_and_half(const Outcome& o) {
  std::printf("block %.5f K, plate %.5f K, heat %.4f J, friction %.4f J, ledger %.2g\n", o.block_rise, o.plate_rise,
              o.heat, o.friction_energy, o.ledger_error);
  EXPECT_NEAR(o.heat, 50, 0.5);
  EXPECT_NEAR(o.heat, o.friction_energy, 1e-6 * o.heat);
  EXPECT_LT(o.ledger_error, 1e-11);
}

TEST(FrictionHeat, IsSplitEvenlyBetweenEqualBodies) {
  const Outcome o = outcome(1);
  expect_half_and_half(o);
  EXPECT_NEAR(o.block_rise, 0.05, 0.0005);
  EXPECT_NEAR(o.plate_rise, 0.05, 0.0005);
}

}  // namespace
}  // namespace tenon::testing

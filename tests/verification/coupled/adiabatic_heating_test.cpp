// SPDX-License-Identifier: BSD-3-Clause
// One element is pulled to a logarithmic strain of 0.5; its plastic heat goes to a thermal mesh (VERIFICATION F01):
// closed-form temperature, and the heat of the thermal mesh is the Taylor-Quinney share of the plastic work.
#include "components/thermal/thermal.hpp"
#include "framework/simulation/simulation.hpp"
#include "mechanics_case.hpp"
#include "transfer/field_link.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

constexpr double density = 7850, specific_heat = 460, start_temperature = 300, end_time = 0.5;

std::unique_ptr<Component> pulled_cube(double hardening_modulus) {
  MaterialDescription material = elastic_material(200e9, 0.3, density);
  material.plasticity = LinearHardeningParameters{400e6, hardening_modulus};
  material.thermal = ThermalProperties{50, specific_heat, start_temperature, 0.9};
  MechanicsOptions options;
  options.heat = HeatMode::exported;
  options.blocks = {{"box", material, {}, {}}};
  PrescribedMotion pull = motion(Kind::displacement, {"x_max"});
  pull.components = {true, false, false};
  pull.value[0] = TimeFunction::smooth_step(0, std::exp(0.5) - 1, 0, end_time);
  options.motions = {symmetry("x_min", {1, 0, 0}), symmetry("y_min", {0, 1, 0}), symmetry("z_min", {0, 0, 1}), pull};
  return std::make_unique<Mechanics>("mechanics", shared_mesh(on_root(BoxShape{})), options);
}

std::unique_ptr<Component> insulated_cube(const BoxShape& shape) {
  ThermalOptions options;
  options.blocks = {{"box", density, specific_heat, 50, start_temperature}};
  options.stepper = ThermalStepper::crank_nicolson;
  options.fixed_step = 5e-3;
  return std::make_unique<Thermal>("conduction", shared_mesh(on_root(shape)), options);
}

struct Outcome {
  double coldest = 1e300, hottest = 0, plastic_work = 0, heat = 0, ledger_error = 0;
};

Outcome outcome(const BoxShape& thermal_mesh, double hardening_modulus, CouplingSchedule schedule) {
  Log log(false);
  Simulation simulation(communicator(), log, 0.0, end_time);
  Component& solid = simulation.add(pulled_cube(hardening_modulus));
  Component& heat = simulation.add(insulated_cube(thermal_mesh));
  simulation.add(std::make_unique<transfer::FieldLink>(
      "heat", solid, heat,
      transfer::FieldLinkOptions{"plastic_heat", "heat", {}, transfer::Configuration::reference, schedule}));
  transfer::FieldLinkOptions back;
  back.source_field = back.target_field = "temperature";
  simulation.add(std::make_unique<transfer::FieldLink>("temperature", heat, solid, back));
  simulation.initialize();
  simulation.run();
  Outcome result;
  for (const double t : dynamic_cast<Thermal&>(heat).temperature()) {
    result.coldest = std::min(result.coldest, t);
    result.hottest = std::max(result.hottest, t);
  }
  result.coldest = communicator().min(result.coldest);
  result.hottest = communicator().max(result.hottest);
  const LedgerSnapshot ledger = simulation.ledger().take();
  for (const LedgerRow& row : ledger.rows) {
    if (row.row == "plastic_work") result.plastic_work = row.value;
    if (row.row == "thermal_energy") result.heat = row.value;
  }
  result.ledger_error = ledger.error;
  return result;
}

void check(const Outcome& o, double expected_rise) {
  EXPECT_NEAR(o.coldest - start_temperature, expected_rise, 0.002 * expected_rise);
  EXPECT_NEAR(o.hottest - start_temperature, expected_rise, 0.002 * expected_rise);
  EXPECT_NEAR(o.heat, 0.9 * o.plastic_work, 1e-10 * o.heat);
  EXPECT_LT(o.ledger_error, 1e-11);
}

TEST(AdiabaticHeating, OnTheSameMesh) {
  check(outcome(BoxShape{}, 1e9, CouplingSchedule::source_step), 80.0006);
}

TEST(AdiabaticHeating, OnAMeshThatDoesNotMatch) {
  BoxShape tetrahedra;
  tetrahedra.elements = {3, 4, 2};
  tetrahedra.tetrahedra = true;
  tetrahedra.distortion = 0.15;
  check(outcome(tetrahedra, 1e9, CouplingSchedule::source_step), 80.0006);
}

TEST(AdiabaticHeating, PerfectPlasticityWithHeatSentAtTheSlowStep) {
  BoxShape hexahedra;
  hexahedra.elements = {2, 3, 3};
  check(outcome(hexahedra, 0, CouplingSchedule::slower_step), 49.648);
}

}  // namespace
}  // namespace tenon::testing

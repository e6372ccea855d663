// SPDX-License-Identifier: BSD-3-Clause
// The scene block of heat conduction: what it gives, and what it refuses.
#include <gtest/gtest.h>

#include "components/thermal/scene_block.hpp"

namespace tenon {
namespace {

struct Read {
  ThermalOptions options;
  scene::Diagnostics diagnostics;
};

Read read(const std::string& text, ElementKind foot = ElementKind::hex8) {
  MeshSummary mesh;
  mesh.source = "bar.msh";
  mesh.blocks = {{"bar", 1, 10, ElementKind::tet4}, {"foot", 2, 5, foot}};
  mesh.node_sets = {{"top", 1, 3}, {"bottom", 2, 3}};
  mesh.side_sets = {{"skin", 1, 9}, {"nothing", 2, 0}, {"lid", 3, 4}};
  MaterialDescription copper{"copper", 8960, {}, {}, ThermalProperties{386, 383, 300, 0.9}, {}};
  MaterialDescription wood{"wood", 500, {}, {}, {}, {}};
  Read result;
  const scene::Value value = parse_scene(text, "scene.yaml", {}, thermal_schema(), result.diagnostics);
  if (!result.diagnostics.any())
    result.options = read_thermal(value, mesh, {{"copper", copper}, {"wood", wood}}, result.diagnostics);
  return result;
}

TEST(ThermalScene, ReadsEverything) {
  const Read r = read(R"(
mesh: fine
material: copper
stepper: crank_nicolson
time_step: {fixed: 2 us}
solver: {tolerance: 1e-10}
initial_temperature: 20 degC
initial_temperatures:
  - {node_set: top, temperature: 400 K, gradient: [0, 0, 1 K/mm]}
prescribed_temperatures:
  - {node_set: bottom, temperature: {table: [[0 s, 300 K], [1 s, 400 K]]}}
fluxes:
  - {side_set: skin, flux: 1 kW/m^2}
convection:
  - {side_set: skin, coefficient: 25 W/(m^2 K), ambient: 293.15 K}
sources:
  - {block: foot, power: 1 MW/m^3}
)");
  ASSERT_FALSE(r.diagnostics.any()) << r.diagnostics.errors().front();
  const ThermalOptions& o = r.options;
  ASSERT_EQ(o.blocks.size(), 2u);
  EXPECT_EQ(o.blocks[1].block, "foot");
  EXPECT_EQ(o.blocks[1].conductivity, 386);
  EXPECT_EQ(o.blocks[0].density, 8960);
  EXPECT_EQ(o.blocks[0].reference_temperature, 300);
  EXPECT_EQ(o.stepper, ThermalStepper::crank_nicolson);
  EXPECT_NEAR(o.fixed_step.value(), 2e-6, 1e-18);
  EXPECT_EQ(o.tolerance, 1e-10);
  ASSERT_EQ(o.initial.size(), 2u);
  EXPECT_NEAR(o.initial[0].value, 293.15, 1e-9);
  EXPECT_EQ(o.initial[1].node_set, "top");
  EXPECT_NEAR(o.initial[1].gradient[2], 1000, 1e-9);
  EXPECT_EQ(o.prescribed.at(0).temperature(0.5), 350);
  EXPECT_EQ(o.fluxes.at(0).flux(0), 1000);
  EXPECT_EQ(o.convection.at(0).coefficient, 25);
  EXPECT_EQ(o.sources.at(0).power(3), 1e6);
}

TEST(ThermalScene, ReadsContact) {
  const Read r = read(R"(
mesh: fine
material: copper
contact_conductance:
  - {first: skin, second: lid, conductance: {table: [[0 s, 1 kW/(m^2 K)], [1 s, 3 kW/(m^2 K)]]}, reference_pressure: 2 MPa,
     exponent: 0.5, gap_conductivity: 0.03 W/(m K), least_gap: 1 um, greatest_gap: 1 mm, touching_gap: 10 um}
  - {first: lid, second: skin, conductance_over_pressure: [[0 MPa, 100 W/(m^2 K)], [1 MPa, 300 W/(m^2 K)]]}
)");
  ASSERT_FALSE(r.diagnostics.any()) << r.diagnostics.errors().front();
  ASSERT_EQ(r.options.contacts.size(), 2u);
  const ThermalContact& c = r.options.contacts[0];
  EXPECT_EQ(c.first + c.second, "skinlid");
  EXPECT_NEAR(c.conductance(0.5), 2000, 1e-9);
  EXPECT_EQ(c.reference_pressure, 2e6);
  EXPECT_EQ(c.exponent, 0.5);
  EXPECT_EQ(c.gap_conductivity, 0.03);
  EXPECT_NEAR(c.least_gap, 1e-6, 1e-18);
  EXPECT_NEAR(c.greatest_gap, 1e-3, 1e-15);
  EXPECT_NEAR(c.touching_gap.value(), 1e-5, 1e-17);
  EXPECT_NEAR((*r.options.contacts[1].over_pressure)(0.25e6), 150, 1e-9);
}

TEST(ThermalScene, RefusesContactThatMeansNothing) {
  for (const auto& [entry, message] : {std::pair{"{first: skin, second: lid}", "nothing passes"},
                                       {"{first: skin, second: skin, conductance: 5 W/(m^2 K)}", "also 'first'"},
                                       {"{first: skin, second: lid, conductance: -5 W/(m^2 K)}", "0 or more"},
                                       {"{first: skin, second: lid, gap_conductivity: 1 W/(m K)}", "without"},
                                       {"{first: ski, second: lid, conductance: 5 W/(m^2 K)}", "ski"}}) {
    const Read r = read("mesh: fine\nmaterial: copper\ncontact_conductance: [" + std::string(entry) + "]\n");
    ASSERT_TRUE(r.diagnostics.any()) << entry;
    EXPECT_NE(r.diagnostics.errors().front().find(message), std::string::npos) << r.diagnostics.errors().front();
  }
}

TEST(ThermalScene, ReadsTheAdaptiveStepperAndRadiation) {
  const Read r = read(R"(
mesh: fine
material: copper
stepper: tr_bdf2
time_step: {tolerance: 0.5 K, initial: 1 ms, maximum: 10 s}
solver: {preconditioner: multigrid, nonlinear_tolerance: 1e-6}
radiation:
  - {side_set: skin, emissivity: 0.8, ambient: 20 degC}
)");
  ASSERT_FALSE(r.diagnostics.any()) << r.diagnostics.errors().front();
  EXPECT_EQ(r.options.stepper, ThermalStepper::tr_bdf2);
  EXPECT_FALSE(r.options.fixed_step);
  EXPECT_EQ(r.options.control.tolerance, 0.5);
  EXPECT_EQ(r.options.control.initial, 1e-3);
  EXPECT_EQ(r.options.control.maximum, 10.0);
  EXPECT_EQ(r.options.preconditioner, ThermalPreconditioner::multigrid);
  EXPECT_EQ(r.options.nonlinear_tolerance, 1e-6);
  ASSERT_EQ(r.options.radiation.size(), 1u);
  EXPECT_NEAR(r.options.radiation[0].ambient(0), 293.15, 1e-9);
}

TEST(ThermalScene, ExplicitNeedsNoStep) {
  const Read r = read("mesh: fine\nblocks: {bar: {material: copper}, foot: {material: copper}}\n");
  ASSERT_FALSE(r.diagnostics.any()) << r.diagnostics.errors().front();
  EXPECT_EQ(r.options.stepper, ThermalStepper::explicit_euler);
  EXPECT_FALSE(r.options.fixed_step);
}

void expect_refused(const std::string& text, const std::string& words) {
  const Read r = read("mesh: fine\n" + text);
  ASSERT_TRUE(r.diagnostics.any()) << text;
  EXPECT_NE(r.diagnostics.errors().front().find(words), std::string::npos) << r.diagnostics.errors().front();
}

TEST(ThermalScene, RefusesUnknownNamesWithTheNearest) {
  expect_refused("material: coper\n", "'copper'");
  expect_refused("material: wood\n", "no thermal properties");
  expect_refused("blocks: {bar: {material: copper}}\n", "block 'foot' of the mesh has no material");
  expect_refused("material: copper\nblocks: {bra: {material: copper}}\n", "'bar'");
  expect_refused("material: copper\nfluxes: [{side_set: skim, flux: 1}]\n", "'skin'");
  expect_refused("material: copper\nprescribed_temperatures: [{node_set: botom, temperature: 1}]\n", "'bottom'");
  expect_refused("material: copper\nsources: [{block: fot, power: 1}]\n", "'foot'");
}

TEST(ThermalScene, RefusesKeysThatTheStepperDoesNotLookAt) {
  const std::string copper = "material: copper\nprescribed_temperatures: [{node_set: bottom, temperature: 300 K}]\n";
  for (const std::string key : {"tolerance: 1 K", "initial: 1 s", "maximum: 1 s"}) {
    const std::string name = "time_step." + key.substr(0, key.find(':')) + ": ", step = "time_step: {" + key + "}\n";
    expect_refused(copper + step, name + "the stepper is 'explicit'; only tr_bdf2");
    for (const std::string stepper : {"backward_euler", "crank_nicolson", "steady"})
      expect_refused(copper + "stepper: " + stepper + "\ntime_step: {fixed: 1 s, " + key + "}\n",
                     name + "the stepper is '" + stepper);
    expect_refused(copper + "stepper: tr_bdf2\ntime_step: {fixed: 1 s, " + key + "}\n", name + "the step is fixed");
  }
  for (const std::string stepper : {"backward_euler", "crank_nicolson", "tr_bdf2", "steady"})
    expect_refused(copper + "stepper: " + stepper + "\ntime_step: {fixed: 1 s, scale: 0.5}\n", "time_step.scale: ");
  for (const std::string key : {"tolerance: 1e-6", "max_iterations: 7", "preconditioner: jacobi"})
    expect_refused(copper + "solver: {" + key + "}\n", "nothing is solved for");
  EXPECT_FALSE(read("mesh: fine\n" + copper + "time_step: {fixed: 1 s, scale: 0.5}\n").diagnostics.any());
}

TEST(ThermalScene, RefusesAnEmptySet) {
  expect_refused("material: copper\nfluxes: [{side_set: nothing, flux: 1}]\n",
                 "side set 'nothing' of the mesh bar.msh is empty");
}

TEST(ThermalScene, RefusesToRadiateToLessThanNothing) {
  const std::string start = "material: copper\nstepper: tr_bdf2\nradiation: [{side_set: skin, emissivity: 1, ambient: ";
  expect_refused(start + "-500 K}]\n", "ambient: -500 K; expected an absolute temperature");
  expect_refused(start + "{table: [[0 s, -1 K], [1 s, 300 K]]}}]\n", "expected an absolute temperature");
  expect_refused(start + "{expression: '-3 - t'}}]\n", "expected an absolute temperature");
}

TEST(ThermalScene, RefusesWhatMakesNoSense) {
  expect_refused("material: copper\nstepper: backward_euler\n", "needs a step");
  expect_refused("material: copper\nstepper: steady\n", "nothing determines");
  expect_refused("material: copper\nradiation: [{side_set: skin, emissivity: 0.8, ambient: 300 K}]\n", "'explicit'");
  expect_refused("material: copper\nstepper: tr_bdf2\nradiation: [{side_set: skin, emissivity: 2, ambient: 1 K}]\n",
                 "emissivity");
  expect_refused("material: copper\ntime_step: {scale: 1.5}\n", "scale");
  expect_refused("material: copper\nconvection: [{side_set: skin, coefficient: -1, ambient: 1}]\n", "coefficient");
  expect_refused("material: copper\ninitial_temperature: 5 m\n", "initial_temperature");
}

TEST(ThermalScene, RefusesElementsOfSecondOrderByName) {
  for (const ElementKind kind : {ElementKind::hex20, ElementKind::tet10, ElementKind::quad4}) {
    const Read r = read("mesh: fine\nmaterial: copper\n", kind);
    ASSERT_TRUE(r.diagnostics.any());
    const std::string error = r.diagnostics.errors().front();
    EXPECT_NE(error.find("'foot'"), std::string::npos) << error;
    EXPECT_NE(error.find(topology(kind).name), std::string::npos) << error;
    if (kind == ElementKind::quad4) continue;
    EXPECT_NE(error.find("mesh the body with hex8"), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace tenon

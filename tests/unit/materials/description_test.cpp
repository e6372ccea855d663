// SPDX-License-Identifier: BSD-3-Clause
// From a scene block to a material, and what is refused.
#include <gtest/gtest.h>

#include "components/materials/material_model.hpp"
#include "components/materials/read_material.hpp"
#include "framework/base/error.hpp"

namespace tenon {
namespace {

struct Read {
  MaterialDescription material;
  scene::Diagnostics diagnostics;
};

Read read(const std::string& text) {
  Read result;
  const scene::Value value = parse_scene(text, "scene.yaml", {}, material_schema(), result.diagnostics);
  if (!result.diagnostics.any()) result.material = read_material("metal", value, result.diagnostics);
  return result;
}

const std::string copper = R"(
density: 8.96 g/cm^3
elastic: {youngs_modulus: 124 GPa, poissons_ratio: 0.34}
plasticity: {type: johnson_cook, A: 90 MPa, B: 292 MPa, n: 0.31, C: 0.025, m: 1.09, melting_temperature: 1356 K}
thermal: {conductivity: 386 W/(m K), specific_heat: 383 J/(kg K), expansion: 17e-6 1/K, reference_temperature: 20 degC}
)";

TEST(MaterialDescription, ReadsJohnsonCookCopper) {
  const Read r = read(copper);
  ASSERT_FALSE(r.diagnostics.any()) << r.diagnostics.errors().front();
  EXPECT_NEAR(r.material.density, 8960, 1e-9);
  ASSERT_TRUE(r.material.elastic && r.material.thermal);
  EXPECT_NEAR(r.material.elastic->youngs_modulus, 124e9, 1);
  EXPECT_NEAR(r.material.elastic->expansion, 17e-6, 1e-18);
  EXPECT_NEAR(r.material.thermal->reference_temperature, 293.15, 1e-9);
  EXPECT_EQ(r.material.thermal->taylor_quinney, 0.9);
  const auto* jc = std::get_if<JohnsonCookParameters>(&r.material.plasticity);
  ASSERT_NE(jc, nullptr);
  EXPECT_NEAR(jc->B, 292e6, 1e-3);
  EXPECT_EQ(jc->reference_strain_rate, 1);
  EXPECT_EQ(jc->reference_temperature, 293.15);
  const auto model = make_material_model(r.material);
  EXPECT_EQ(model->state_size(), 2);
  EXPECT_EQ(model->state_name(0), "eqps");
  EXPECT_EQ(model->damage(), -1);
}

TEST(MaterialDescription, ReadsTheOtherKinds) {
  const Read linear = read(
      "density: 7850\nelastic: {youngs_modulus: 210 GPa, poissons_ratio: 0.3}\n"
      "plasticity: {type: linear_hardening, yield_stress: 400 MPa}\n");
  ASSERT_FALSE(linear.diagnostics.any()) << linear.diagnostics.errors().front();
  EXPECT_TRUE(make_material_model(linear.material)->plastic());
  EXPECT_FALSE(linear.material.thermal);
  const Read elastic = read("density: 7850\nelastic: {youngs_modulus: 210 GPa, poissons_ratio: 0.3}\n");
  EXPECT_EQ(make_material_model(elastic.material)->state_size(), 0);
}

TEST(MaterialDescription, ThermalAloneIsEnoughForConductionOnly) {
  const Read r = read("density: 1\nthermal: {conductivity: 1, specific_heat: 1}\n");
  ASSERT_FALSE(r.diagnostics.any());
  EXPECT_THROW(make_material_model(r.material), Error);
}

void expect_refused(const std::string& text, const std::string& word) {
  const Read r = read(text);
  ASSERT_TRUE(r.diagnostics.any()) << text;
  EXPECT_NE(r.diagnostics.errors().front().find(word), std::string::npos) << r.diagnostics.errors().front();
}

TEST(MaterialDescription, RefusesWhatIsNotPhysical) {
  expect_refused("density: -1\n", "density");
  expect_refused("density: 1\nelastic: {youngs_modulus: 1, poissons_ratio: 0.5}\n", "poissons_ratio");
  expect_refused("density: 1\nelastic: {youngs_modulus: 1, poissons_ratio: -1}\n", "poissons_ratio");
  expect_refused("density: 1\nelastic: {youngs_modulus: 0, poissons_ratio: 0.3}\n", "youngs_modulus");
  expect_refused("density: 1\nthermal: {conductivity: 1, specific_heat: 1, taylor_quinney: 1.1}\n", "taylor_quinney");
  expect_refused("density: 1\nplasticity: {type: linear_hardening, yield_stress: 1}\n", "elastic");
  expect_refused(
      "density: 1\nelastic: {youngs_modulus: 1, poissons_ratio: 0.3}\n"
      "plasticity: {type: johnson_cook, A: 1, B: 1, n: 1, melting_temperature: 200 K}\n",
      "melting_temperature");
}

const std::string start = "density: 1000\n", elastic = "elastic: {youngs_modulus: 200 GPa, poissons_ratio: 0.3}\n";

/// States of the model of a material block, in one line.
std::string states(const std::string& text) {
  const Read r = read(start + text);
  EXPECT_FALSE(r.diagnostics.any()) << text << r.diagnostics.errors().front();
  if (r.diagnostics.any()) return "";
  const auto model = make_material_model(r.material);
  EXPECT_TRUE(r.material.elastic);
  EXPECT_GT(model->elasticity().p_wave_modulus(), 0);
  std::string names;
  for (int i = 0; i < model->state_size(); ++i) names += model->state_name(i) + " ";
  return names;
}

TEST(MaterialDescription, ReadsEveryLaw) {
  EXPECT_EQ(states(elastic + "plasticity: {type: voce, yield_stress: 300 MPa, saturation: 100 MPa, rate: 12, "
                             "cowper_symonds: {D: 40.4 1/s, p: 5}}\n"),
            "eqps ");
  EXPECT_EQ(states(elastic + "plasticity: {type: table, flow_stress: [[0, 300 MPa], [0.1, 400 MPa]]}\n"), "eqps ");
  EXPECT_EQ(
      states(elastic + "plasticity: {type: linear_hardening, yield_stress: 300 MPa, cowper_symonds: {D: 40, p: 5}}\n"
                       "failure: {plastic_strain: 0.2, spall_pressure: 2 GPa}\n"),
      "eqps damage ");
  EXPECT_EQ(states(elastic + "plasticity: {type: kinematic, yield_stress: 300 MPa, hardening_modulus: 1 GPa}\n")
                .substr(0, 20),
            "eqps back_stress_xx ");
  EXPECT_EQ(states("hyperelastic: {type: neo_hookean, shear_modulus: 1 MPa, bulk_modulus: 50 MPa}\n"),
            "thermal_strain ");
  EXPECT_EQ(states("hyperelastic: {type: mooney_rivlin, C10: 1 MPa, C01: 0.2 MPa, bulk_modulus: 50 MPa}\n"),
            "thermal_strain ");
  EXPECT_EQ(
      states("orthotropic: {E1: 11 GPa, E2: 0.9 GPa, E3: 0.5 GPa, nu12: 0.4, nu23: 0.45, nu31: 0.02, G12: 0.7 GPa, "
             "G23: 0.04 GPa, G31: 0.65 GPa, axis_1: [0, 0, 2], axis_2: [1, 0, 1]}\n")
          .substr(0, 9),
      "axis_1_x ");
  EXPECT_EQ(states(elastic + "foam: {yield_stress: [[0, 2 MPa], [0.7, 2 MPa], [0.71, 52 MPa]]}\n"), "crush ");
  EXPECT_EQ(states(elastic + "soil: {pressure: [[0, 0], [0.1, 5 MPa]], a0: 1e8, a1: 1e4 Pa, a2: 0.3}\n"),
            "eqps compaction ");
  EXPECT_EQ(states(elastic + "equation_of_state: {type: gruneisen, c: 4600 m/s, S1: 1.3, gamma0: 1.7}\n"),
            "internal_energy volume_ratio ");
  EXPECT_EQ(states(elastic + "plasticity: {type: linear_hardening, yield_stress: 300 MPa}\n"
                             "equation_of_state: {type: polynomial, C1: 80 GPa, C4: 1.7, least_pressure: -1 GPa}\n"),
            "eqps internal_energy volume_ratio ");
}

TEST(MaterialDescription, ReadsEveryEquationOfState) {
  const auto bulk = [](const std::string& text) {
    const Read r = read(start + "equation_of_state: {" + text + "}\n");
    EXPECT_FALSE(r.diagnostics.any()) << r.diagnostics.errors().front();
    EXPECT_THROW(make_material_model(r.material), Error) << "mechanics needs a shear modulus";
    return r.material.equation_of_state ? r.material.equation_of_state->bulk_modulus() : 0;
  };
  const double density = read(start + elastic).material.density;
  EXPECT_NEAR(bulk("type: gruneisen, c: 4600 m/s, S1: 1.3, gamma0: 1.7"), density * 4600 * 4600, 1);
  EXPECT_NEAR(bulk("type: linear, c: 1500 m/s, background: 1 bar"), density * 1500 * 1500, 1);
  EXPECT_NEAR(bulk("type: tait, c: 1500 m/s, gamma: 7, background: 1 bar"), density * 1500 * 1500, 1);
  EXPECT_NEAR(bulk("type: ideal_gas, gamma: 1.4, initial_energy: 0.25 MJ/m^3"), 1.4e5, 1e-6);
  EXPECT_GT(bulk("type: jwl, A: 371.2 GPa, B: 3.231 GPa, R1: 4.15, R2: 0.95, omega: 0.3, initial_energy: 7000 MJ/m^3"),
            1e9);
  EXPECT_NEAR(bulk("type: tillotson, a: 0.5, b: 1.5, A: 75 GPa, B: 65 GPa, E0: 5 MJ/kg, alpha: 5, beta: 5, "
                   "incipient_vaporization: 3 MJ/kg, complete_vaporization: 15 MJ/kg"),
              75e9, 1);
  EXPECT_EQ(bulk("type: ideal_gas, gamma: 1.4"), 0);
  EXPECT_THROW(
      make_material_model(read(start + elastic + "equation_of_state: {type: ideal_gas, gamma: 1.4}\n").material),
      Error);
}

TEST(MaterialDescription, SaysWhatShellsCanUse) {
  const auto plane = [](const std::string& text) {
    return make_material_model(read(start + text).material)->supports_plane_stress();
  };
  EXPECT_TRUE(plane(elastic));
  EXPECT_TRUE(plane(elastic + "plasticity: {type: kinematic, yield_stress: 300 MPa, hardening_modulus: 1 GPa}\n"));
  EXPECT_FALSE(plane("hyperelastic: {type: neo_hookean, shear_modulus: 1 MPa, bulk_modulus: 50 MPa}\n"));
  EXPECT_FALSE(plane(elastic + "foam: {yield_stress: [[0, 2 MPa]]}\n"));
}

TEST(MaterialDescription, RefusesWhatMakesNoSense) {
  const auto refused = [](const std::string& text, const std::string& word) { expect_refused(start + text, word); };
  refused(elastic + "plasticity: {type: table, flow_stress: [[0.1, 300 MPa], [0.2, 400 MPa]]}\n", "starts at");
  refused(elastic + "plasticity: {type: table, flow_stress: [[0, 9 GPa], [0.001, 1 MPa]]}\n", "falls");
  refused(elastic + "hyperelastic: {type: neo_hookean, shear_modulus: 1 MPa, bulk_modulus: 50 MPa}\n", "hyperelastic");
  refused("hyperelastic: {type: neo_hookean, shear_modulus: 1 MPa, bulk_modulus: 0.5 MPa}\n", "bulk_modulus");
  refused("foam: {yield_stress: [[0, 2 MPa]]}\n", "elastic");
  refused(elastic + "foam: {yield_stress: [[0, 2 MPa], [0.5, 1 MPa]]}\n", "falls");
  refused(elastic + "soil: {pressure: [[0, 0], [0.001, 5 GPa]]}\n", "bulk modulus");
  refused(elastic + "soil: {pressure: [[0, 0], [0.1, 5 MPa]]}\nplasticity: {type: linear_hardening, yield_stress: 1}\n",
          "soil");
  refused(elastic + "equation_of_state: {type: polynomial, C2: 80 GPa}\n", "bulk modulus");
  refused("equation_of_state: {type: ideal_gas, gamma: 1}\n", "gamma");
  refused(
      "equation_of_state: {type: tillotson, a: 0.5, b: 1.5, A: 75 GPa, B: 65 GPa, E0: 5e6, alpha: 5, beta: 5, "
      "incipient_vaporization: 3e6, complete_vaporization: 3e6}\n",
      "complete_vaporization");
  refused(elastic +
              "equation_of_state: {type: gruneisen, c: 4600, S1: 1.3, gamma0: 1.7}\n"
              "thermal: {conductivity: 1, specific_heat: 1, expansion: 1e-5 1/K}\n",
          "expansion");
  refused(elastic + "failure: {plastic_strain: 0.2}\n", "plastic");
  refused(elastic + "failure: {}\n", "limit");
  refused("orthotropic: {E1: 11, E2: 1, E3: 1, nu12: 4, nu23: 0, nu31: 0, G12: 1, G23: 1, G31: 1}\n", "nu12");
  refused("orthotropic: {E1: 1, E2: 1, E3: 1, nu12: 0, nu23: 0, nu31: 0, G12: 1, G23: 1, G31: 1, axis_2: [2, 0, 0]}\n",
          "axis_2");
}

}  // namespace
}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// From a scene block to a material, and what is refused.
#include <gtest/gtest.h>

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
  const AnyMaterial material = make_material(r.material);
  const auto* jc = std::get_if<JohnsonCook>(&material);
  ASSERT_NE(jc, nullptr);
  EXPECT_NEAR(jc->flow.B, 292e6, 1e-3);
  EXPECT_EQ(jc->flow.reference_strain_rate, 1);
  EXPECT_EQ(jc->flow.reference_temperature, 293.15);
  EXPECT_EQ(state_size(material), 2);
  EXPECT_EQ(state_name(material, 0), "eqps");
}

TEST(MaterialDescription, ReadsTheOtherKinds) {
  const Read linear = read(
      "density: 7850\nelastic: {youngs_modulus: 210 GPa, poissons_ratio: 0.3}\n"
      "plasticity: {type: linear_hardening, yield_stress: 400 MPa}\n");
  ASSERT_FALSE(linear.diagnostics.any()) << linear.diagnostics.errors().front();
  EXPECT_TRUE(std::holds_alternative<J2LinearHardening>(make_material(linear.material)));
  EXPECT_FALSE(linear.material.thermal);
  const Read elastic = read("density: 7850\nelastic: {youngs_modulus: 210 GPa, poissons_ratio: 0.3}\n");
  EXPECT_TRUE(std::holds_alternative<LinearElastic>(make_material(elastic.material)));
}

TEST(MaterialDescription, ThermalAloneIsEnoughForConductionOnly) {
  const Read r = read("density: 1\nthermal: {conductivity: 1, specific_heat: 1}\n");
  ASSERT_FALSE(r.diagnostics.any());
  EXPECT_THROW(make_material(r.material), Error);
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

}  // namespace
}  // namespace tenon

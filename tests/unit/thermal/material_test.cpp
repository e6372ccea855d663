// SPDX-License-Identifier: BSD-3-Clause
// Thermal properties in a scene: tables over temperature, axes, change of phase; enthalpy and tables by themselves.
#include <gtest/gtest.h>

#include "components/materials/read_material.hpp"
#include "components/thermal/heat_content.hpp"

namespace tenon {
namespace {

struct Properties {
  ThermalProperties thermal;
  scene::Diagnostics diagnostics;
};

Properties read(const std::string& thermal) {
  Properties result;
  const scene::Value value = parse_scene("density: 1000\nthermal: {" + thermal + "}\n", "scene.yaml", {},
                                         material_schema(), result.diagnostics);
  if (result.diagnostics.any()) return result;
  result.thermal = read_material("metal", value, result.diagnostics).thermal.value();
  return result;
}

TEST(ThermalProperties, TablesOverTemperature) {
  const Properties r = read(
      "conductivity: [[0 degC, 50 W/(m K)], [100 degC, 40]], specific_heat: [[273.15 K, 400], [373.15 K, 500]], "
      "reference_temperature: 50 degC");
  ASSERT_FALSE(r.diagnostics.any()) << r.diagnostics.errors().front();
  EXPECT_NEAR(r.thermal.conductivity, 45, 1e-9);
  EXPECT_NEAR(r.thermal.specific_heat, 450, 1e-9);
  EXPECT_NEAR((*r.thermal.conductivity_over_temperature)(273.15 + 75), 42.5, 1e-9);
  EXPECT_TRUE(r.thermal.specific_heat_over_temperature.has_value());
}

TEST(ThermalProperties, NumbersStayNumbers) {
  const Properties r = read("conductivity: 50, specific_heat: 400");
  ASSERT_FALSE(r.diagnostics.any()) << r.diagnostics.errors().front();
  EXPECT_EQ(r.thermal.conductivity, 50);
  EXPECT_FALSE(r.thermal.conductivity_over_temperature || r.thermal.specific_heat_over_temperature ||
               r.thermal.conductivity_tensor);
  EXPECT_EQ(r.thermal.latent_heat, 0);
}

TEST(ThermalProperties, AxesMakeATensor) {
  const Properties r =
      read("orthotropic_conductivity: [10, 3, 1], first_axis: [0, 2, 0], second_axis: [1, 1, 0], specific_heat: 400");
  ASSERT_FALSE(r.diagnostics.any()) << r.diagnostics.errors().front();
  const auto& k = r.thermal.conductivity_tensor.value();
  EXPECT_NEAR(k[0][0], 3, 1e-12);
  EXPECT_NEAR(k[1][1], 10, 1e-12);
  EXPECT_NEAR(k[2][2], 1, 1e-12);
  EXPECT_NEAR(k[0][1], 0, 1e-12);
}

void expect_refused(const std::string& thermal, const std::string& words) {
  const Properties r = read(thermal);
  ASSERT_TRUE(r.diagnostics.any()) << thermal;
  EXPECT_NE(r.diagnostics.errors().front().find(words), std::string::npos) << r.diagnostics.errors().front();
}

TEST(ThermalProperties, RefusesWhatMakesNoSense) {
  expect_refused("specific_heat: 400", "conductivity");
  expect_refused("conductivity: 5, orthotropic_conductivity: [1, 1, 1], specific_heat: 400", "conductivity");
  expect_refused("orthotropic_conductivity: [1, 0, 1], specific_heat: 400", "greater than 0");
  expect_refused("orthotropic_conductivity: [1, 1, 1], second_axis: [-3, 0, 0], specific_heat: 400", "second_axis");
  expect_refused("conductivity: 5, specific_heat: 400, latent_heat: 2e5", "solidus");
  expect_refused("conductivity: 5, specific_heat: 400, latent_heat: 2e5, solidus: 500 K, liquidus: 500 K", "liquidus");
  expect_refused("conductivity: [[300 K, 5], [400 K, -5]], specific_heat: 400", "conductivity");
}

TEST(TemperatureTable, IntegralIsThatOfTheLines) {
  const TemperatureTable table({{100.0, 2.0}, {200.0, 4.0}, {400.0, 1.0}});
  EXPECT_EQ(table(50), 2);
  EXPECT_EQ(table(150), 3);
  EXPECT_EQ(table(500), 1);
  EXPECT_EQ(table.integral(50), -100);
  EXPECT_EQ(table.integral(150), 125);
  EXPECT_EQ(table.integral(400), 800);
  EXPECT_EQ(table.integral(500), 900);
  EXPECT_EQ(TemperatureTable(7).integral(10), 70);
}

TEST(Enthalpy, SlopeIsItsDerivativeOnEitherSide) {
  thermal::Enthalpy h;
  h.specific_heat = TemperatureTable({{200.0, 300.0}, {600.0, 500.0}});
  h.latent_heat = 1e5, h.solidus = 400, h.liquidus = 410;
  const double step = 1e-4;
  for (const double t : {100.0, 300.0, 400.0, 405.0, 410.0, 500.0, 700.0}) {
    EXPECT_NEAR(h.slope(t, true), (h(t + step) - h(t)) / step, 1) << t;
    EXPECT_NEAR(h.slope(t, false), (h(t) - h(t - step)) / step, 1) << t;
  }
  EXPECT_EQ(h.stop(390, 420), 400);
  EXPECT_EQ(h.stop(400, 420), 410);
  EXPECT_EQ(h.stop(410, 420), 420);
  EXPECT_EQ(h.stop(420, 380), 410);
  EXPECT_EQ(h.stop(410, 380), 400);
  EXPECT_EQ(h.stop(401, 409), 409);
}

}  // namespace
}  // namespace tenon

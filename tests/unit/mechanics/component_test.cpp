// SPDX-License-Identifier: BSD-3-Clause
// The component as the rest sees it: masses, ledger, heat, temperature, fields, awkward meshes.
#include "components/mechanics/element_cost.hpp"
#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

BoxShape bar() {
  BoxShape box;
  box.high = {0.03, 0.01, 0.01};
  box.elements = {6, 2, 2};
  return box;
}

MechanicsOptions impact(double speed) {
  MechanicsOptions options;
  options.initial_velocities.push_back({"", "", {-speed, 0, 0}, {}, {}});
  options.walls.push_back({{0, 0, 0}, {1, 0, 0}, TimeFunction::constant(0), {}, "wall"});
  return options;
}

double total(const Mechanics& m, std::span<const double> values) {
  ExactSum sum;
  for (const LocalIndex n : m.mesh().owned_nodes) sum.add(values[static_cast<std::size_t>(n)]);
  return m.mesh().comm.sum(sum);
}

TEST(Mechanics, MassIsThatOfTheBody) {
  BoxShape box = bar();
  box.distortion = 0.3;
  const auto m = body(shared_mesh(on_root(box)), steel(), {});
  EXPECT_NEAR(total(*m, m->nodal_mass()), 7850 * 3e-6, 1e-14);
}

TEST(Mechanics, UniformMotionIsExactlyFree) {
  MechanicsOptions options;
  options.initial_velocities.push_back({"", "", {123.4, -56.7, 8.9}, {}, {}});
  BoxShape box = bar();
  box.distortion = 0.3;
  const auto m = body(shared_mesh(on_root(box)), steel(), options);
  m->initialize();
  for (int s = 0; s < 50; ++s) m->advance(m->time_step());
  double most = 0;
  for (const double s : field(*m, "stress")) most = std::max(most, std::abs(s));
  EXPECT_LT(communicator().max(most), 1e-3);  // round-off of positions: 1e-16 x E x places
  EXPECT_NEAR(energy_rows(*m)["kinetic_energy"], 0.5 * 7850 * 3e-6 * (123.4 * 123.4 + 56.7 * 56.7 + 8.9 * 8.9), 1e-12);
}

TEST(Mechanics, LedgerClosesOverTenThousandSteps) {
  MechanicsOptions options = impact(50);
  options.heat = HeatMode::adiabatic;
  options.motions = {symmetry("y_min", {0, 1, 0}), symmetry("z_min", {0, 0, 1})};
  const auto m = body(shared_mesh(on_root(bar())), copper(), options);
  m->initialize();
  Ledger ledger(*m);
  double error = 0;
  const int steps = long_run(10000);
  for (int s = 0; s < steps; ++s) {
    m->advance(m->time_step());
    if (s % 100 == 0) error = std::max(error, ledger.error());
  }
  EXPECT_LT(error, 1e-12);
  EXPECT_LT(ledger.error(), 1e-12);
  const auto rows = energy_rows(*m);
  EXPECT_GT(rows.at("plastic_work"), 0);
  EXPECT_GT(rows.at("hourglass_energy"), 0);
  EXPECT_GT(rows.at("viscosity_energy"), 0);
  EXPECT_NEAR(rows.at("heat_generated"), 0.9 * rows.at("plastic_work"), 1e-15);
}

TEST(Mechanics, StiffnessHourglassKeepsTheLedger) {
  MechanicsOptions options = impact(20);
  options.hourglass = {HourglassOptions::Form::stiffness, 0.05};
  const auto m = body(shared_mesh(on_root(bar())), steel(), options);
  m->initialize();
  Ledger ledger(*m);
  for (int s = 0; s < long_run(2000); ++s) m->advance(m->time_step());
  EXPECT_LT(ledger.error(), 1e-12);
}

TEST(Mechanics, ExportedHeatIsTheShareOfPlasticWork) {
  MechanicsOptions options = impact(150);
  options.heat = HeatMode::exported;
  const auto m = body(shared_mesh(on_root(bar())), copper(), options);
  m->initialize();
  ExactSum given;
  for (int s = 0; s < 300; ++s) {
    m->advance(m->time_step());
    const std::vector<double> heat = field(*m, "plastic_heat");
    std::size_t i = 0;
    for (const ElementBlock& block : m->mesh().blocks)
      for (const int owner : block.owners) {
        EXPECT_GE(heat[i], -1e-18);
        if (owner == communicator().rank()) given.add(heat[i]);
        ++i;
      }
  }
  const auto rows = energy_rows(*m);
  EXPECT_GT(rows.at("heat_generated"), 0);
  EXPECT_NEAR(communicator().sum(given), rows.at("heat_generated"), 1e-13 * rows.at("heat_generated"));
}

TEST(Mechanics, AdiabaticHeatWarmsByTheShareOfPlasticWork) {
  MechanicsOptions options = impact(150);
  options.heat = HeatMode::adiabatic;
  const auto m = body(shared_mesh(on_root(bar())), copper(), options);
  m->initialize();
  for (int s = 0; s < 300; ++s) m->advance(m->time_step());
  const std::vector<double> temperature = field(*m, "temperature");
  ExactSum heat;
  std::size_t i = 0;
  for (const ElementBlock& block : m->mesh().blocks)
    for (const int owner : block.owners) {
      if (owner == communicator().rank()) heat.add(8930 * 385 * (3e-6 / 24) * (temperature[i] - 293.15));
      ++i;
    }
  const auto rows = energy_rows(*m);
  EXPECT_GT(rows.at("heat_generated"), 0);
  EXPECT_NEAR(communicator().sum(heat), rows.at("heat_generated"), 1e-9 * rows.at("heat_generated"));
}

// case F02: a bar between stiff walls, warmed by 100 K.
TEST(Mechanics, ImportedTemperatureExpands) {
  for (int held = 1; held <= 3; ++held) {
    MaterialDescription material = steel();
    material.elastic->expansion = 12e-6;
    material.thermal = ThermalProperties{50, 460, 300, 0.9};
    MechanicsOptions options;
    options.initial_temperature = 300;
    const char* const low[] = {"x_min", "y_min", "z_min"};
    const char* const high[] = {"x_max", "y_max", "z_max"};
    for (int c = 0; c < 3; ++c) {
      Vec3 normal{};
      normal[static_cast<std::size_t>(c)] = 1;
      options.motions.push_back(symmetry(low[c], normal));
      if (c < held) options.motions.push_back(symmetry(high[c], normal));
    }
    options.viscosity = {5, 0};  // to rest
    BoxShape cube;
    cube.elements = {1, 1, 1};
    const auto m = body(shared_mesh(on_root(cube)), material, options);
    m->initialize();
    std::vector<double> temperature(static_cast<std::size_t>(m->mesh().elements()));
    for (int s = 1; s <= 4000; ++s) {
      std::fill(temperature.begin(), temperature.end(), 300 + std::min(100.0, 0.05 * s));
      m->imports().front().write(temperature);
      m->advance(m->time_step());
    }
    const double expected[] = {-252e6, -360e6, -630e6};
    for (std::size_t e = 0; e < temperature.size(); ++e)
      EXPECT_NEAR(field(*m, "stress")[6 * e], expected[held - 1], 2e-3 * 630e6) << held;
  }
}

TEST(Mechanics, TheFirstTemperatureThatArrivesIsFreeOfStress) {
  MaterialDescription material = steel();
  material.elastic->expansion = 12e-6;
  MechanicsOptions options;
  options.motions = {motion(Kind::fixed, {"x_min", "x_max"})};
  const auto m = body(shared_mesh(on_root(bar())), material, options);
  m->initialize();
  m->imports().front().write(std::vector<double>(static_cast<std::size_t>(m->mesh().elements()), 700.0));
  m->advance(m->time_step());
  for (const double s : field(*m, "stress")) EXPECT_EQ(s, 0.0);
}

TEST(Mechanics, FieldsBearTheirNames) {
  const auto m = body(shared_mesh(on_root(bar())), copper(), {});
  std::vector<std::string> names;
  for (const ExportPort& port : m->exports()) names.push_back(port.field.name);
  EXPECT_EQ(names, (std::vector<std::string>{"displacement", "velocity", "stress", "von_mises", "pressure", "eqps",
                                             "density", "temperature"}));
  m->initialize();
  for (const double d : field(*m, "density")) EXPECT_NEAR(d, 8930, 1e-8);
  EXPECT_EQ(m->imports().front().field.name, "temperature");
}

TEST(Mechanics, OneElementOnManyRanks) {
  BoxShape cube;
  const auto m = body(shared_mesh(on_root(cube)), copper(), impact(100));
  m->initialize();
  Ledger ledger(*m);
  for (int s = 0; s < 100; ++s) m->advance(m->time_step());
  EXPECT_LT(ledger.error(), 1e-13);
  EXPECT_EQ(communicator().sum(m->work_done()), 100);
  EXPECT_GT(communicator().sum(m->memory()), 0);
}

TEST(Mechanics, CostsFollowTheMaterial) {
  MechanicsOptions options;
  options.blocks = {{"a", steel(), {}, {}}, {"b", copper(), {}, {}}};
  const ElementCost cost = mechanics_cost(options);
  EXPECT_EQ(cost("a", ElementKind::hex8), 1.0);
  EXPECT_GT(cost("b", ElementKind::hex8), 1.0);
}

}  // namespace
}  // namespace tenon::testing

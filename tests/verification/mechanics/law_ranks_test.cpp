// SPDX-License-Identifier: BSD-3-Clause
// Every law of a material in a small block that strikes a wall askew, and the laws of shells in a warped panel: the
// same bits on any number of ranks, and after a restart from half-way.
#include <cstdio>
#include <filesystem>

#include "shell_case.hpp"

namespace tenon::testing {
namespace {

struct Law {
  std::string name;
  MaterialDescription material;
  double speed;       ///< of the impact, m/s
  bool flows = true;  ///< must show plastic work
};

MaterialDescription metal(const PlasticityParameters& plasticity) {
  MaterialDescription m = copper();
  m.plasticity = plasticity;
  m.elastic->expansion = 17e-6;
  return m;
}

JohnsonCookParameters johnson_cook() {
  return {90e6, 292e6, 0.31, 0.025, 1.09, 1, 293.15, 1356};
}

/// Laws that shells have as well.
std::vector<Law> common_laws() {
  Law elastic{"elastic", copper(), 20, false};
  elastic.material.plasticity = {};
  Law failing{"johnson_cook_with_damage", metal(johnson_cook()), 200};
  failing.material.failure.emplace().johnson_cook = JohnsonCookDamage{0.05, 0.3, -2.1, 0.01, 0.5, 1, 293.15, 1356};
  Law spalling{"linear_hardening_with_tensile_failure", copper(), 200};
  spalling.material.failure.emplace().tensile_stress = 500e6;
  return {elastic,
          {"linear_hardening", copper(), 200},
          {"linear_hardening_with_rate", metal(LinearHardeningParameters{90e6, 100e6, {1e4, 5}}), 200},
          {"voce", metal(VoceHardeningParameters{{90e6, 200e6, 10, 20e6}, {}}), 200},
          {"voce_with_rate", metal(VoceHardeningParameters{{90e6, 200e6, 10, 20e6}, {1e4, 5}}), 200},
          {"table", metal(TableHardeningParameters{{{0, 90e6}, {0.05, 200e6}, {0.3, 300e6}}, {}}), 200},
          {"kinematic", metal(KinematicHardeningParameters{90e6, 50e6, 2e9, 10}), 200},
          {"johnson_cook", metal(johnson_cook()), 200},
          failing,
          spalling};
}

std::vector<Law> all_laws() {
  std::vector<Law> laws = common_laws();
  const auto whole = [&](const char* name, const WholeLawParameters& law, double density, double speed,
                         const std::optional<Elasticity>& elastic = {}) {
    Law l{name, {}, speed, false};
    l.material.name = name, l.material.density = density, l.material.elastic = elastic, l.material.whole_law = law;
    laws.push_back(l);
  };
  whole("neo_hookean", MooneyRivlinParameters{0.5e6, 0, 50e6}, 1000, 20);
  whole("mooney_rivlin", MooneyRivlinParameters{0.4e6, 0.1e6, 50e6}, 1000, 20);
  OrthotropicParameters wood{10e9, 1e9, 2e9, 0.3, 0.2, 0.05, 0.8e9, 0.5e9, 0.7e9};
  wood.axis_1[0] = 0.8, wood.axis_1[1] = 0.6, wood.axis_2[0] = -0.6, wood.axis_2[1] = 0.8;
  whole("orthotropic", wood, 600, 30);
  whole("foam", FoamParameters{{{0, 2e6}, {0.6, 3e6}, {0.8, 100e6}}, 1e6}, 200, 40, Elasticity{100e6, 0.1, 0});
  whole("soil", SoilParameters{{{0, 0}, {0.02, 5e6}, {0.1, 50e6}}, 1e10, 1e4, 0.3, 1e4}, 1800, 60,
        Elasticity{2e9, 0.25, 0});
  const auto with_state = [&](const char* name, const MaterialDescription& base, const EquationOfState& state) {
    Law l{name, base, 300};
    l.material.equation_of_state = state;
    laws.push_back(l);
  };
  EquationOfState gruneisen{Gruneisen{8930, 3940, 1.489, 0, 0, 2.02, 0.47, 0}}, polynomial;
  gruneisen.least_pressure = -1e9;
  PolynomialState p;
  p.C[1] = 140e9, p.C[2] = 280e9, p.C[3] = 50e9, p.C[4] = 2, p.C[5] = 1;
  polynomial.law = p;
  with_state("gruneisen_johnson_cook", metal(johnson_cook()), gruneisen);
  with_state("polynomial_linear_hardening", copper(), polynomial);
  with_state("gruneisen_kinematic", metal(KinematicHardeningParameters{90e6, 50e6, 2e9, 10}), gruneisen);
  return laws;
}

MechanicsOptions strike(double speed, const MaterialDescription& material) {
  MechanicsOptions o;
  if (material.thermal) o.heat = HeatMode::adiabatic;
  o.initial_velocities.push_back({"", "", {-speed, 0.1 * speed, 0}, {}, {}});
  o.walls.push_back({{0, 0, 0}, {1, 0, 0}, TimeFunction::constant(0), {}, "wall"});
  o.motions = {symmetry("z_min", {0, 0, 1})};
  return o;
}

MeshData block() {
  BoxShape box;
  box.high = {0.01, 0.008, 0.006};
  box.elements = {4, 3, 3};
  box.distortion = 0.2;
  return on_root(box);
}

MeshData panel() {
  return shell_grid({5, 4, ShellGrid::Cells::mixed}, [](double r, double s) {
    return Vec3{0.01 + 0.1 * r + 0.01 * r * s, 0.1 * s, 0.02 * r * s + 0.01 * std::sin(3 * r)};
  });
}

std::unique_ptr<Mechanics> struck(std::shared_ptr<const Mesh> mesh, const Law& law, bool shell) {
  MechanicsOptions o = strike(law.speed, law.material);
  if (!shell) return body(std::move(mesh), law.material, o);
  o.motions = {hold("r1", "xyzrxryrz")};
  o.walls.clear();
  o.initial_velocities = {{"", "", {0, 0, -law.speed}, {0, -300, 0, 300, 0, 100, 0, -100, 0}, {}}};
  return shell_body(std::move(mesh), law.material, section(0.003), o);
}

void advance_together(Mechanics& a, Mechanics& b, int steps) {
  for (int s = 0; s < steps; ++s) {
    ASSERT_EQ(a.time_step(), b.time_step()) << "step " << s;
    a.advance(a.time_step());
    b.advance(b.time_step());
  }
}

void expect_same(Mechanics& a, Mechanics& b, const std::string& what) {
  for (const char* name : {"displacement", "velocity", "stress", "eqps", "temperature"})
    expect_same_bits(in_global_order(a, name), in_global_order(b, name), what + ", " + name);
  EXPECT_EQ(energy_rows(a), energy_rows(b)) << what;
}

/// On all ranks and on one; then from a checkpoint of half-way on.
void check(const Law& law, bool shell) {
  SCOPED_TRACE(law.name + (shell ? " shell" : ""));
  constexpr int half = 40;
  const auto data = [&] { return shell ? panel() : block(); };
  const auto shared = struck(shared_mesh(data()), law, shell), whole = struck(whole_mesh(data()), law, shell);
  shared->initialize();
  whole->initialize();
  advance_together(*shared, *whole, half);
  const std::string file = "law_" + law.name + (shell ? "_shell" : "") + std::to_string(communicator().size()) + ".h5";
  {
    CheckpointWriter writer(communicator(), file);
    shared->save(writer);
    writer.finish();
  }
  advance_together(*shared, *whole, half);
  expect_same(*shared, *whole, "ranks");
  const auto rows = energy_rows(*shared);
  EXPECT_GT(std::abs(rows.at("internal_energy")), 1e-3 * rows.at("kinetic_energy"));
  if (law.flows) {
    EXPECT_GT(rows.at("plastic_work"), 0.01 * rows.at("kinetic_energy"));
  }
  const auto continued = struck(shared_mesh(data()), law, shell);
  {
    const CheckpointReader reader(communicator(), file);
    continued->set_clock(whole->time());
    continued->load(reader);
  }
  continued->initialize();
  for (int s = 0; s < half; ++s) continued->advance(continued->time_step());
  expect_same(*continued, *whole, "restart");
  communicator().barrier();
  if (communicator().rank() == 0) std::filesystem::remove(file);
}

TEST(LawRanks, SolidsOfEveryLaw) {
  for (const Law& law : all_laws()) check(law, false);
}

TEST(LawRanks, ShellsOfEveryLaw) {
  for (const Law& law : common_laws()) check(law, true);
}

}  // namespace
}  // namespace tenon::testing

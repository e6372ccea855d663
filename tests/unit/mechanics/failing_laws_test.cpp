// SPDX-License-Identifier: BSD-3-Clause
// Laws that follow from the deformation gradient, the volume or added heat, in elements that fail: the same bits on any
// ranks and after a restart, and no energy out of nothing.
#include <filesystem>

#include "constraints_case.hpp"
#include "solid_meshes.hpp"

namespace tenon::testing {
namespace {

using Formulation = MechanicsOptions::Formulation;

/// A material, and how fast its end is pulled so that part of the body fails.
struct Law {
  const char* name;
  MaterialDescription material;
  double speed;
};

MaterialDescription metal(double plastic_strain) {
  MaterialDescription m = copper();
  m.plasticity = LinearHardeningParameters{100e6, 100e6};
  m.failure.emplace().plastic_strain = plastic_strain;
  return m;
}

std::vector<Law> laws() {
  std::vector<Law> all;
  MaterialDescription m = metal(0.05);
  m.equation_of_state = EquationOfState{Gruneisen{8930, 3940, 1.49, 0, 0, 2, 0}};
  all.push_back({"gruneisen", m, 100});

  m = metal(0.05);
  m.plasticity = JohnsonCookParameters{90e6, 292e6, 0.31, 0.025, 1.09, 1, 293.15, 1356};
  m.equation_of_state = EquationOfState{PolynomialState{{0, 137e9, 175e9, 0, 2, 2, 0}, 0}};
  m.failure.emplace().johnson_cook = JohnsonCookDamage{0.02, 0.2, -3, 0.01, 1, 1, 293.15, 1356};
  all.push_back({"johnson_cook", m, 120});

  m = metal(0.05);
  m.plasticity = KinematicHardeningParameters{100e6, 50e6, 500e6, 2};
  all.push_back({"kinematic", m, 100});

  m = elastic_material(10e6, 0.1, 100);
  m.whole_law = FoamParameters{{{0, 0.2e6}, {0.6, 0.5e6}, {0.8, 5e6}}, 0.5e6};
  m.failure.emplace().tensile_stress = 0.3e6;
  all.push_back({"foam", m, 15});

  m = elastic_material(50e6, 0.25, 1800);
  m.whole_law = SoilParameters{{{0, 0}, {0.1, 1e6}, {0.2, 4e6}}, 1e10, 1e4, 0.2, 0.5e6};
  m.failure.emplace().spall_pressure = 0.2e6;
  all.push_back({"soil", m, 4});

  m = {};
  m.name = "rubber", m.density = 1100;
  m.whole_law = MooneyRivlinParameters{0.8e6, 0.2e6, 50e6};
  m.failure.emplace().tensile_stress = 3e6;
  all.push_back({"rubber", m, 25});

  m = {};
  m.name = "wood", m.density = 700;
  m.whole_law =
      OrthotropicParameters{10e9, 1e9, 0.6e9, 0.3, 0.3, 0.02, 0.8e9, 0.3e9, 0.6e9, {0.6, 0.8, 0}, {-0.8, 0.6, 0}};
  m.failure.emplace().tensile_stress = 20e6;
  all.push_back({"orthotropic", m, 40});
  return all;
}

/// Pulled apart from rest; one end held.
std::unique_ptr<Mechanics> pulled(std::shared_ptr<const Mesh> mesh, const Law& law, Formulation formulation) {
  MechanicsOptions o;
  o.hourglass.form = HourglassOptions::Form::stiffness;
  PrescribedMotion pull = motion(PrescribedMotion::Kind::velocity, {"x_max"});
  pull.components = {true, false, false};
  pull.value[0] = TimeFunction::constant(law.speed);
  o.motions = {motion(PrescribedMotion::Kind::fixed, {"x_min"}), pull};
  auto body = solid_body(std::move(mesh), law.material, formulation, o);
  body->initialize();
  return body;
}

double deaths(Mechanics& body) {
  double dead = 0;
  std::size_t i = 0;
  const std::vector<double> status = field(body, "element_status");
  for (const ElementBlock& block : body.mesh().blocks)
    for (const int owner : block.owners) dead += owner == body.mesh().comm.rank() && status[i] == 0 ? 1 : 0, ++i;
  ExactSum sum;
  sum.add(dead);
  return body.mesh().comm.sum(sum);
}

void expect_same(Mechanics& a, Mechanics& b, const std::string& what) {
  for (const char* name : {"displacement", "velocity", "stress", "element_status", "damage"})
    expect_same_bits(in_global_order(a, name), in_global_order(b, name), what + " " + name);
  EXPECT_EQ(energy_rows(a), energy_rows(b)) << what;
  EXPECT_EQ(a.time_step(), b.time_step()) << what;
}

/// No more moves than was put in, and what is left in the living parts is not less than nothing.
void expect_no_energy_from_nothing(Mechanics& body, double start, const std::string& what) {
  const auto rows = energy_rows(body);
  const double work = start + rows.at("boundary_work");
  ASSERT_LE(rows.at("kinetic_energy"), 1.001 * work) << what;
  const double within = rows.at("internal_energy") + rows.at("hourglass_energy") + rows.at("viscosity_energy");
  ASSERT_GE(within, -0.01 * work) << what;
  ASSERT_GE(rows.at("eroded_energy"), 0) << what;
}

/// Compared step by step with one rank, saved at the step of the first death, and continued from there.
void check(const Law& law, ElementKind kind, Formulation formulation) {
  const std::string what = std::string(law.name) + ", " + std::string(topology(kind).name) +
                           (formulation == Formulation::full ? ", full" : "");
  SCOPED_TRACE(what);
  BoxShape box;
  box.high = {0.012, 0.004, 0.004};
  box.elements = {6, 2, 2};
  box.distortion = 0.2;
  const auto make = [&](bool shared) {
    return pulled(shared ? shared_mesh(solid_box(box, kind)) : whole_mesh(solid_box(box, kind)), law, formulation);
  };
  const auto shared = make(true), whole = make(false);
  Ledger ledger(*shared);
  const double start = energy_rows(*shared).at("kinetic_energy");  // of the end that is pulled
  constexpr int limit = 200, after = 20;
  int steps = 0;
  const auto step = [&] {
    const double dt = shared->time_step();
    ASSERT_EQ(dt, whole->time_step()) << "step " << steps;
    shared->advance(dt), whole->advance(dt);
    if (steps % 5 == 0) expect_no_energy_from_nothing(*shared, start, what + ", step " + std::to_string(steps));
    ++steps;
  };
  while (deaths(*shared) == 0 && steps < limit && !::testing::Test::HasFailure()) step();
  ASSERT_GT(deaths(*shared), 0);
  const std::string file = "failing_" + std::to_string(communicator().size()) + ".h5";
  {
    CheckpointWriter writer(communicator(), file);
    shared->save(writer);
    writer.finish();
  }
  const auto continued = [&] {
    auto body = pulled(shared_mesh(solid_box(box, kind)), law, formulation);
    const CheckpointReader reader(communicator(), file);
    body->set_clock(shared->time());
    body->load(reader);
    body->initialize();
    return body;
  }();
  for (int s = 0; s < after && !::testing::Test::HasFailure(); ++s) {
    ASSERT_EQ(continued->time_step(), shared->time_step()) << "step " << s << " after the restart";
    continued->advance(continued->time_step());
    step();
  }
  expect_same(*shared, *whole, what + ", ranks,");
  expect_same(*continued, *shared, what + ", restart,");
  EXPECT_LT(deaths(*shared), static_cast<double>(shared->mesh().global_elements));
  EXPECT_LT(ledger.error(), 1e-12);
  communicator().barrier();
  if (communicator().rank() == 0) std::filesystem::remove(file);
}

class FailingLaws : public ::testing::TestWithParam<int> {};

TEST_P(FailingLaws, OnePointHexahedra) {
  check(laws()[static_cast<std::size_t>(GetParam())], ElementKind::hex8, Formulation::automatic);
}
TEST_P(FailingLaws, FullHexahedra) {
  check(laws()[static_cast<std::size_t>(GetParam())], ElementKind::hex8, Formulation::full);
}
TEST_P(FailingLaws, AveragedTetrahedra) {
  check(laws()[static_cast<std::size_t>(GetParam())], ElementKind::tet4, Formulation::automatic);
}
TEST_P(FailingLaws, AveragedWedges) {
  check(laws()[static_cast<std::size_t>(GetParam())], ElementKind::wedge6, Formulation::automatic);
}

INSTANTIATE_TEST_SUITE_P(Every, FailingLaws, ::testing::Range(0, static_cast<int>(laws().size())),
                         [](const auto& law) { return laws()[static_cast<std::size_t>(law.param)].name; });

}  // namespace
}  // namespace tenon::testing

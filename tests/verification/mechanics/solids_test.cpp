// SPDX-License-Identifier: BSD-3-Clause
// Patch test, rigid spin, energy and momentum of every kind of solid, on distorted meshes.
#include <numbers>

#include "solid_meshes.hpp"

namespace tenon::testing {
namespace {

using Form = HourglassOptions::Form;
using Formulation = MechanicsOptions::Formulation;
using Kind = PrescribedMotion::Kind;

struct Case {
  ElementKind kind;
  Formulation formulation;
  Form form;
  std::string name;
};

class Solid : public ::testing::TestWithParam<Case> {
 protected:
  std::unique_ptr<Mechanics> make(const BoxShape& box, const MaterialDescription& material, MechanicsOptions options) {
    options.hourglass.form = GetParam().form;
    return solid_body(shared_mesh(solid_box(box, GetParam().kind)), material, GetParam().formulation,
                      std::move(options));
  }
};

BoxShape distorted_box(int n) {
  BoxShape box;
  box.elements = {n, n, n};
  box.distortion = 0.25;
  return box;
}

const std::vector<std::string> all_faces{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

/// A linear displacement at the surface nodes and the matching velocity inside give the same stress everywhere and no
/// force at inner nodes (A01).
TEST_P(Solid, PassesThePatchTest) {
  const std::array<double, 9> gradient{2e-6, 1e-6, 1e-6, 1e-6, 2e-6, 1e-6, 1e-6, 1e-6, 2e-6};
  MechanicsOptions options;
  options.viscosity = {0, 0};
  PrescribedMotion m = motion(Kind::gradient, all_faces);
  m.gradient = gradient;
  m.factor = TimeFunction::table({{0, 0}, {1, 1}});
  options.motions = {m};
  options.time_step.fixed = 0.1;
  options.initial_velocity_function = [&](const Vec3& x) {
    return Vec3{gradient[0] * x[0] + gradient[1] * x[1] + gradient[2] * x[2],
                gradient[3] * x[0] + gradient[4] * x[1] + gradient[5] * x[2],
                gradient[6] * x[0] + gradient[7] * x[1] + gradient[8] * x[2]};
  };
  const auto body = make(distorted_box(3), elastic_material(1e6, 0.25, 1e12), options);
  body->initialize();
  for (int s = 0; s < 10; ++s) body->advance(0.1);
  const std::vector<double> stress = field(*body, "stress");
  const double expected[6] = {4, 4, 4, 0.8, 0.8, 0.8};  // 2 mu e + lambda tr e
  for (std::size_t i = 0; i < stress.size(); ++i) EXPECT_NEAR(stress[i], expected[i % 6], 1e-4);
  double most = 0;
  const Mesh& mesh = body->mesh();
  for (std::size_t n = 0; n < mesh.coordinates.size(); ++n) {
    const Vec3& x = mesh.coordinates[n];
    const bool inner = std::ranges::all_of(x, [](double c) { return c > 1e-9 && c < 1 - 1e-9; });
    for (int c = 0; inner && c < 3; ++c) most = std::max(most, std::abs(body->internal_force()[n].v[c]));
  }
  EXPECT_LT(most, 1e-5);
}

TEST_P(Solid, SpinsWithoutStress) {
  PrescribedMotion m = motion(Kind::rotation, {"everything"});
  m.axis = {1, 2, 3};
  m.centre = {0.3, 0.1, -0.2};
  m.factor = TimeFunction::table({{0, 0}, {36, 2 * std::numbers::pi}});
  MechanicsOptions options;
  options.motions = {m};
  options.time_step.fixed = 1;
  options.hourglass.form = GetParam().form;
  MeshData mesh = solid_box(distorted_box(2), GetParam().kind);
  NodeSetData everything{"everything", 99, {}};
  for (std::size_t n = 0; n < mesh.coordinates.size(); ++n) everything.nodes.push_back(static_cast<GlobalId>(n));
  mesh.node_sets.push_back(everything);
  const auto body = solid_body(shared_mesh(std::move(mesh)), steel(), GetParam().formulation, options);
  body->initialize();
  double turned = 0;
  for (int s = 0; s < 36; ++s) {
    body->advance(1);
    for (std::size_t n = 0; n < body->mesh().coordinates.size(); ++n)
      turned = std::max(turned, norm(body->current_coordinates()[n] - body->mesh().coordinates[n]));
  }
  EXPECT_GT(turned, 1);
  const std::vector<double> stress = field(*body, "stress");
  EXPECT_EQ(stress.size(), 6 * static_cast<std::size_t>(body->mesh().elements()));
  for (const double s : stress) EXPECT_LT(std::abs(s), 1e-14 * 210e9);
}

/// An impact with plastic flow: every joule stands in the ledger, and the mass centre feels nothing from inside.
TEST_P(Solid, KeepsEnergyAndMomentum) {
  MechanicsOptions options;
  options.initial_velocity_function = [](const Vec3& x) { return Vec3{-60 * x[0], 80 * x[2], 30 * x[1] * x[0]}; };
  const auto body = make(distorted_box(2), copper(), options);
  body->initialize();
  Ledger ledger(*body);
  const auto momentum = [&] {
    Vec3 sum{};
    const std::vector<double> v = field(*body, "velocity");
    for (std::size_t n = 0; n < body->mesh().coordinates.size(); ++n)
      for (std::size_t c = 0; c < 3; ++c) sum[c] += body->nodal_mass()[n] * v[3 * n + c];
    return sum;
  };
  const Vec3 start = momentum();
  for (int s = 0; s < 400; ++s) body->advance(body->time_step());
  EXPECT_LT(ledger.error(), 1e-13);
  EXPECT_LT(norm(momentum() - start), 1e-10 * (norm(start) + 8930 * 50));
  EXPECT_GT(energy_rows(*body).at("plastic_work"), 0);
}

/// Inner work by stresses agrees with the work of the forces: the gradients of both are the same.
TEST_P(Solid, ElasticEnergyReturns) {
  MechanicsOptions options;
  options.viscosity = {0, 0};
  options.hourglass.coefficient = 0;
  options.initial_velocity_function = [](const Vec3& x) { return Vec3{0.02 * x[0], 0, 0.01 * x[1]}; };
  options.time_step.scale = 0.3;
  const auto body = make(distorted_box(2), steel(), options);
  body->initialize();
  const double start = energy_rows(*body).at("kinetic_energy");
  double least = 1, sum_most = 0;
  for (int s = 0; s < 1000; ++s) {
    body->advance(body->time_step());
    const auto rows = energy_rows(*body);
    least = std::min(least, rows.at("internal_energy") / start);
    sum_most = std::max(sum_most, rows.at("kinetic_energy") / start);
  }
  EXPECT_GT(least, -0.02);
  EXPECT_LT(sum_most, 1.02);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Solid,
    ::testing::Values(Case{ElementKind::hex8, Formulation::automatic, Form::viscous, "hex8_viscous"},
                      Case{ElementKind::hex8, Formulation::automatic, Form::physical, "hex8_physical"},
                      Case{ElementKind::hex8, Formulation::full, Form::viscous, "hex8_full"},
                      Case{ElementKind::tet4, Formulation::automatic, Form::viscous, "tet4_averaged"},
                      Case{ElementKind::tet4, Formulation::full, Form::viscous, "tet4_plain"},
                      Case{ElementKind::wedge6, Formulation::automatic, Form::viscous, "wedge6"},
                      Case{ElementKind::pyramid5, Formulation::automatic, Form::viscous, "pyramid5"}),
    [](const auto& solid) { return solid.param.name; });

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Patch test with the seven distorted hexahedra of [MH85]: a linear displacement gives one stress everywhere.
#include <cstdio>

#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

/// Unit cube with a distorted hexahedron inside; node sets "outer" (0-7), "inner" and "all".
MeshData macneal_harder_patch() {
  MeshData mesh;
  mesh.source = "patch";
  mesh.coordinates = {{0, 0, 0},
                      {1, 0, 0},
                      {1, 1, 0},
                      {0, 1, 0},
                      {0, 0, 1},
                      {1, 0, 1},
                      {1, 1, 1},
                      {0, 1, 1},
                      {0.249, 0.342, 0.192},
                      {0.826, 0.288, 0.288},
                      {0.85, 0.649, 0.263},
                      {0.273, 0.75, 0.23},
                      {0.32, 0.186, 0.643},
                      {0.677, 0.305, 0.683},
                      {0.788, 0.693, 0.644},
                      {0.165, 0.745, 0.702}};
  for (std::int64_t n = 1; n <= 16; ++n) mesh.node_labels.push_back(n);
  BlockData block;
  block.name = "patch";
  block.connectivity = {8,  9,  10, 11, 12, 13, 14, 15, 0,  1,  2, 3,  8,  9,  10, 11, 12, 13, 14,
                        15, 4,  5,  6,  7,  0,  1,  9,  8,  4,  5, 13, 12, 1,  2,  10, 9,  5,  6,
                        14, 13, 2,  3,  11, 10, 6,  7,  15, 14, 3, 0,  8,  11, 7,  4,  12, 15};
  for (std::int64_t e = 1; e <= 7; ++e) block.labels.push_back(e);
  mesh.blocks.push_back(block);
  NodeSetData outer{"outer", 1, {}}, inner{"inner", 2, {}}, all{"all", 3, {}};
  for (GlobalId n = 0; n < 16; ++n) (n < 8 ? outer : inner).nodes.push_back(n), all.nodes.push_back(n);
  mesh.node_sets = {outer, inner, all};
  return mesh;
}

constexpr double amplitude = 1e-9;  // of the strain: finite strain then adds no more than this

/// u = amplitude (2x+y+z, x+2y+z, x+y+2z)/2, factor over time.
MechanicsOptions stretched(const std::string& set, const TimeFunction& factor) {
  MechanicsOptions options;
  PrescribedMotion m = motion(Kind::gradient, {set});
  const double a = amplitude, h = 0.5 * amplitude;
  m.gradient = {a, h, h, h, a, h, h, h, a};
  m.factor = factor;
  options.motions.push_back(m);
  return options;
}

/// sigma_ii = 2000, tau = 400 for strain 1e-3 in the reference; here `amplitude`.
void expect_patch_stress(Mechanics& m, double tolerance) {
  const double normal = 2000 * (amplitude / 1e-3), shear = 400 * (amplitude / 1e-3);
  const std::vector<double> stress = field(m, "stress");
  for (std::size_t i = 0; i < stress.size(); ++i)
    EXPECT_NEAR(stress[i], i % 6 < 3 ? normal : shear, tolerance * normal)
        << "element " << i / 6 << " component " << i % 6;
}

std::shared_ptr<const Mesh> patch() {
  return shared_mesh(communicator().rank() == 0 ? macneal_harder_patch() : MeshData{});
}

// Round-off of positions is 1e-16 of the edge, 1e-7 of the displacement: with amplitude 1e-9 that is what remains.
TEST(PatchTest, PrescribedEverywhere) {
  MechanicsOptions options = stretched("all", TimeFunction::table({{0, 0}, {10, 1}}));
  options.time_step.fixed = 1;
  options.viscosity = {0, 0};
  const auto m = body(patch(), elastic_material(1e6, 0.25, 1), options);
  m->initialize();
  for (int s = 0; s < 10; ++s) m->advance(1.0);
  expect_patch_stress(*m, 1e-6);
  double residual = 0, volume = 0;
  for (const LocalIndex n : m->mesh().find_node_set("inner")->nodes) {
    if (!m->mesh().owns_node(n)) continue;
    const double* f = m->internal_force()[static_cast<std::size_t>(n)].v;
    residual = std::max(residual, std::hypot(f[0], f[1], f[2]));
  }
  EXPECT_LT(communicator().max(residual), 1e-6 * 2000 * (amplitude / 1e-3));
  ExactSum mass;
  for (const LocalIndex n : m->mesh().owned_nodes) mass.add(m->nodal_mass()[static_cast<std::size_t>(n)]);
  volume = communicator().sum(mass);
  EXPECT_NEAR(volume, 1, 1e-14);
}

// The same at a strain of 1e-3 on a stress-free start: the increments are those of the present geometry, alike in every
// element, so the stress is one to round-off and the inner nodes feel nothing.
TEST(PatchTest, UniformAtFiniteStrain) {
  MechanicsOptions options = stretched("all", TimeFunction::table({{0, 0}, {10, 1e6}}));
  options.time_step.fixed = 1;
  options.viscosity = {0, 0};
  const auto m = body(patch(), elastic_material(1e6, 0.25, 1), options);
  m->initialize();
  for (int s = 0; s < 10; ++s) m->advance(1.0);
  const std::vector<double> stress = field(*m, "stress");
  for (std::size_t i = 0; i < stress.size(); ++i)
    EXPECT_NEAR(stress[i], i % 6 < 3 ? 2000 : 400, 4) << "element " << i / 6;  // 1e-3 of finite strain
  for (std::size_t i = 6; i < stress.size(); ++i) EXPECT_NEAR(stress[i], stress[i % 6], 1e-10 * 2000);
  for (const LocalIndex n : m->mesh().find_node_set("inner")->nodes) {
    if (!m->mesh().owns_node(n)) continue;
    const double* f = m->internal_force()[static_cast<std::size_t>(n)].v;
    EXPECT_LT(std::hypot(f[0], f[1], f[2]), 1e-10 * 2000);
  }
}

// Slowly driven by the outer nodes only, the inner ones find their places by themselves.
TEST(PatchTest, InnerNodesFindTheirPlaces) {
  const double duration = 400;  // about a thousand of the slowest periods
  MechanicsOptions options = stretched("outer", TimeFunction::smooth_step(0, 1e6, 0, duration));
  const auto m = body(patch(), elastic_material(1e6, 0.25, 1e4), options);
  m->initialize();
  run_to(*m, duration);
  const std::vector<double> u = field(*m, "displacement");
  const double h = 0.5e-3;
  for (const LocalIndex n : m->mesh().find_node_set("inner")->nodes) {
    const auto i = static_cast<std::size_t>(n);
    const Vec3& x = m->mesh().coordinates[i];
    const double sum = x[0] + x[1] + x[2];
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(u[3 * i + c], h * (sum + x[c]), 1e-8);
  }
}

// Only the outer nodes are moved; the inner ones find their places by dynamic relaxation. Round-off of positions is
// 1e-16 of the edge, and the stress that the path of the inner nodes leaves is of second order in the amplitude: a slow
// start keeps them near their places all along, so that both stay below 1e-8 of an amplitude of 1e-6.
TEST(PatchTest, InnerNodesByDynamicRelaxation) {
  constexpr double ramp = 1, share = 1e3;  // s; of the strain `amplitude`
  MechanicsOptions options = stretched("outer", TimeFunction::smooth_step(0, share, 0, ramp));
  options.hourglass.form = HourglassOptions::Form::physical;
  options.loads.relaxation = RelaxationOptions{1e-9, ramp};
  const auto m = body(patch(), elastic_material(1e6, 0.25, 1), options);
  m->initialize();
  for (int s = 0; s < 100000 && !m->finished(); ++s) m->advance(m->time_step());
  ASSERT_TRUE(m->finished()) << m->ending();
  const std::vector<double> u = field(*m, "displacement");
  const double a = share * amplitude;
  double worst = 0;
  for (std::size_t n = 0; n < 16; ++n) {
    const Vec3& x = m->mesh().coordinates[n];
    const Vec3 expected = 0.5 * a * Vec3{2 * x[0] + x[1] + x[2], x[0] + 2 * x[1] + x[2], x[0] + x[1] + 2 * x[2]};
    for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(u[3 * n + c] - expected[c]));
  }
  std::printf("A01(ii) %.3g m off, %.3g of the amplitude; %s\n", worst, worst / a, m->ending().c_str());
  EXPECT_LE(worst, 1e-8 * a);
}

}  // namespace
}  // namespace tenon::testing

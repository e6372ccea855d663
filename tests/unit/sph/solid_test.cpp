// SPDX-License-Identifier: BSD-3-Clause
// Solids of particles: exact gradients of linear fields, what is conserved, and the same bits on any ranks.
#include <gtest/gtest.h>

#include "components/sph/matrix3.hpp"
#include "sph_case.hpp"

namespace tenon::testing {
namespace {

MaterialDescription metal() {
  MaterialDescription material;
  material.name = "metal", material.density = 2700;
  material.elastic = Elasticity{70e9, 0.3, 0};
  material.plasticity = LinearHardeningParameters{200e6, 500e6, {}};
  ThermalProperties thermal;
  thermal.conductivity = 200, thermal.specific_heat = 900;
  material.thermal = thermal;
  return material;
}

MaterialDescription rubber() {
  MaterialDescription material;
  material.name = "rubber", material.density = 1000;
  material.elastic = Elasticity{1e7, 0.4, 0};
  return material;
}

double hash(const Vec3& x, double a) {
  const double s = std::sin(a * x[0] + 2.3 * a * x[1] + 3.7 * a * x[2]) * 43758.5453;
  return s - std::floor(s) - 0.5;
}

/// A block, its lattice shaken by a fifth of the spacing, so that nothing is symmetric.
SphScene shaken_block(int dimension, SphFormulation formulation) {
  SphScene scene;
  ParticleBox box;
  box.particles = {8, dimension > 1 ? 6 : 1, dimension > 2 ? 5 : 1};
  box.low = {0, 0, 0}, box.high = {0.8, dimension > 1 ? 0.6 : 0, dimension > 2 ? 0.5 : 0};
  box.dimension = dimension;
  scene.mesh = particle_bodies({{"block", generate(box)}});
  scene.options.bodies = {body_of("block", rubber())};
  scene.options.dimension = dimension;
  scene.options.formulation = formulation;
  scene.options.artificial_viscosity.alpha = 0, scene.options.artificial_viscosity.beta = 0;
  scene.options.displaced = [dimension](const Vec3& x) {
    return Vec3{0.02 * hash(x, 41), dimension > 1 ? 0.02 * hash(x, 57) : 0, dimension > 2 ? 0.02 * hash(x, 73) : 0};
  };
  return scene;
}

Matrix3 some_gradient(int dimension) {
  Matrix3 A{};
  for (int r = 0; r < dimension; ++r)
    for (int c = 0; c < dimension; ++c) A[static_cast<std::size_t>(3 * r + c)] = 10 * std::sin(1.0 + 3 * r + 5 * c);
  return A;
}

// A velocity that is linear in space: all particles, at free surfaces and corners too, have the density and the stress
// of that motion.
class LinearField : public ::testing::TestWithParam<std::pair<SphFormulation, int>> {};

TEST_P(LinearField, IsExact) {
  const auto [formulation, dimension] = GetParam();
  SphScene scene = shaken_block(dimension, formulation);
  constexpr double dt = 1e-3;
  scene.options.time_step.fixed = dt;
  const Matrix3 A = some_gradient(dimension);
  const auto displaced = scene.options.displaced;
  scene.options.initial_velocity_function = [A, displaced](const Vec3& at) {
    const Vec3 x = at + displaced(at);
    return Vec3{A[0] * x[0] + A[1] * x[1] + A[2] * x[2], A[3] * x[0] + A[4] * x[1] + A[5] * x[2],
                A[6] * x[0] + A[7] * x[1] + A[8] * x[2]};
  };
  SphRun run(scene);
  run.step();
  // x1 = (1 + dt A) x0.
  const double ratio = determinant(identity3 + dt * A);
  const std::vector<double> density = run.gathered("density");
  const std::vector<double> stress = run.gathered("stress");
  for (const double rho : density) EXPECT_NEAR(rho * ratio, 1000, 1e-10 * 1000);
  for (std::size_t k = 6; k < stress.size(); ++k)
    EXPECT_NEAR(stress[k], stress[k % 6], 1e-10 * 1e5) << "particle " << k / 6 << " component " << k % 6;
  EXPECT_TRUE(stress.empty() || std::abs(stress[0]) > 1e3);
}

std::string name_of(const ::testing::TestParamInfo<std::pair<SphFormulation, int>>& info) {
  return (info.param.first == SphFormulation::solid ? std::string("Updated") : std::string("Total")) +
         std::to_string(info.param.second) + "D";
}

INSTANTIATE_TEST_SUITE_P(Sph, LinearField,
                         ::testing::Values(std::pair{SphFormulation::solid, 1}, std::pair{SphFormulation::solid, 2},
                                           std::pair{SphFormulation::solid, 3},
                                           std::pair{SphFormulation::total_lagrangian, 1},
                                           std::pair{SphFormulation::total_lagrangian, 2},
                                           std::pair{SphFormulation::total_lagrangian, 3}),
                         name_of);

/// Two blocks that meet, the second one askew and turning; plastic, and hot.
SphScene collision(SphFormulation formulation, int dimension) {
  SphScene scene;
  ParticleBox box;
  box.particles = {6, 6, dimension > 2 ? 4 : 1}, box.dimension = dimension;
  box.low = {0, 0, 0}, box.high = {0.06, 0.06, dimension > 2 ? 0.04 : 0};
  const MeshData first = generate(box);
  box.low = {0.0725, 0.013, 0}, box.high = {0.1325, 0.073, dimension > 2 ? 0.04 : 0};
  scene.mesh = particle_bodies({{"left", first}, {"right", generate(box)}});
  scene.options.bodies = {body_of("left", metal()), body_of("right", metal())};
  scene.options.dimension = dimension;
  scene.options.formulation = formulation;
  scene.options.heat_conduction = true;
  scene.options.initial_velocity_function = [](const Vec3& x) {
    return x[0] < 0.07 ? Vec3{150, 0, 0} : Vec3{-150 - 2000 * (x[1] - 0.04), 2000 * (x[0] - 0.1), 0};
  };
  return scene;
}

std::vector<std::vector<double>> end_of(const SphScene& scene, const Communicator& comm, int steps) {
  SphRun run(scene, comm);
  run.steps(steps);
  return {
      run.gathered("position"),
      run.gathered("velocity"),
      run.gathered("stress"),
      run.gathered("temperature"),
      {run.row("internal_energy"), run.row("viscosity_energy"), run.row("thermal_energy"), run.row("plastic_work")}};
}

class Solids : public ::testing::TestWithParam<std::pair<SphFormulation, int>> {};

TEST_P(Solids, KeepMomentumAndEnergy) {
  const auto [formulation, dimension] = GetParam();
  SphRun run(collision(formulation, dimension));
  const Vec3 linear = run.momentum(), angular = run.angular_momentum();
  const double size = run.size_of_momentum();
  run.steps(150);
  EXPECT_GT(run.row("plastic_work"), 0);
  EXPECT_GT(run.row("heat_generated"), 0);
  EXPECT_LE(norm(run.momentum() - linear), 1e-12 * size);
  EXPECT_LE(norm(run.angular_momentum() - angular), 1e-12 * size * 0.1);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

TEST_P(Solids, SameBitsOnAnyRanks) {
  const auto [formulation, dimension] = GetParam();
  const SphScene scene = collision(formulation, dimension);
  const std::vector<std::vector<double>> all = end_of(scene, communicator(), 100);
  if (communicator().rank() != 0) return;
  EXPECT_EQ(all, end_of(scene, Communicator::self(), 100));
}

TEST_P(Solids, SameBitsHoweverOftenTheySearch) {
  const auto [formulation, dimension] = GetParam();
  SphScene scene = collision(formulation, dimension);
  const std::vector<std::vector<double>> with_skips = end_of(scene, communicator(), 60);
  scene.options.always_search = true;
  EXPECT_EQ(with_skips, end_of(scene, communicator(), 60));
}

TEST_P(Solids, SameBitsThroughARestart) {
  const auto [formulation, dimension] = GetParam();
  const SphScene scene = collision(formulation, dimension);
  const std::string file = "sph-solid-restart-" + std::to_string(communicator().size()) + ".h5";
  SphRun through(scene);
  through.steps(47);
  {
    CheckpointWriter writer(communicator(), file);
    through.simulation().save(writer);
    writer.finish();
  }
  through.steps(40);
  SphRun again(scene, communicator(), file);
  again.steps(40);
  for (const char* const column : {"position", "velocity", "stress", "temperature"})
    EXPECT_EQ(through.gathered(column), again.gathered(column)) << column;
  for (const char* const row : {"internal_energy", "plastic_work", "thermal_energy"})
    EXPECT_EQ(through.row(row), again.row(row)) << row;
}

/// A bar that is pulled apart until particles fail.
SphScene torn_bar(SphFormulation formulation, int dimension) {
  SphScene scene;
  ParticleBox box;
  box.particles = {16, 5, dimension > 2 ? 4 : 1}, box.dimension = dimension;
  box.low = {-0.08, 0, 0}, box.high = {0.08, 0.05, dimension > 2 ? 0.04 : 0};
  scene.mesh = particle_bodies({{"bar", generate(box)}});
  MaterialDescription brittle = metal();
  FailureCriterion failure;
  failure.plastic_strain = 0.05;
  brittle.failure = failure;
  scene.options.bodies = {body_of("bar", brittle)};
  scene.options.dimension = dimension;
  scene.options.formulation = formulation;
  scene.options.initial_velocity_function = [](const Vec3& x) { return Vec3{x[0] < 0.011 ? -150.0 : 150.0, 0, 0}; };
  return scene;
}

TEST_P(Solids, FailAndKeepMomentumAndEnergy) {
  const auto [formulation, dimension] = GetParam();
  const SphScene scene = torn_bar(formulation, dimension);
  SphRun run(scene);
  const double size = run.size_of_momentum();
  const Vec3 before = run.momentum();
  run.steps(120);
  const std::vector<double> failed = run.gathered("failed"), x = run.gathered("position");
  if (communicator().rank() == 0) {
    EXPECT_GT(std::ranges::count(failed, 1.0), 0);
    EXPECT_GT(std::ranges::count(failed, 0.0), static_cast<std::ptrdiff_t>(failed.size() / 2));
  }
  EXPECT_LE(norm(run.momentum() - before), 1e-12 * size);
  EXPECT_LE(run.ledger_error(), 1e-11);
  if (communicator().rank() == 0) {
    SphRun alone(scene, Communicator::self());
    alone.steps(120);
    EXPECT_EQ(x, alone.gathered("position"));
  }
}

INSTANTIATE_TEST_SUITE_P(Sph, Solids,
                         ::testing::Values(std::pair{SphFormulation::solid, 2}, std::pair{SphFormulation::solid, 3},
                                           std::pair{SphFormulation::total_lagrangian, 2},
                                           std::pair{SphFormulation::total_lagrangian, 3}),
                         name_of);

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Two materials in one mesh whose densities are 10,000 to 1: the estimated step against the greatest eigenvalue of the
// whole mesh, and runs just below and above that limit.
#include <Eigen/Eigenvalues>
#include <cstdio>

#include "solid_meshes.hpp"

namespace tenon::testing {
namespace {

using Form = HourglassOptions::Form;

/// 3 x 3 x 4 hexahedra; the upper half, or every other element, is of the light material.
MeshData two_materials(double distortion, bool mixed) {
  if (communicator().rank() != 0) return {};
  BoxShape shape;
  shape.elements = {3, 3, 4};
  shape.distortion = distortion;
  MeshData mesh = generate(shape);
  const BlockData all = mesh.blocks[0];
  BlockData heavy{"heavy", 1, ElementKind::hex8, {}, {}}, light{"light", 2, ElementKind::hex8, {}, {}};
  for (std::size_t e = 0; e < all.size(); ++e) {
    const std::size_t layer = e / 9;
    BlockData& to = (mixed ? (e % 3 + e / 3 % 3 + layer) % 2 == 0 : layer < 2) ? heavy : light;
    to.connectivity.insert(to.connectivity.end(), all.connectivity.begin() + static_cast<std::ptrdiff_t>(8 * e),
                           all.connectivity.begin() + static_cast<std::ptrdiff_t>(8 * e + 8));
    to.labels.push_back(all.labels[e]);
  }
  mesh.blocks = {heavy, light};
  mesh.side_sets.clear();  // they count elements in the order of the blocks
  return mesh;
}

struct Pair {
  double distortion;
  bool mixed;
  Form form;
};

std::unique_ptr<Mechanics> make(const Pair& pair, MechanicsOptions options) {
  options.viscosity = {0, 0};
  options.hourglass = {pair.form, 0.05};
  options.blocks = {{"heavy", elastic_material(1, 0.3, 1e4), {}, {}}, {"light", elastic_material(1, 0.3, 1), {}, {}}};
  return std::make_unique<Mechanics>("pair", shared_mesh(two_materials(pair.distortion, pair.mixed)),
                                     std::move(options));
}

/// 2/omega of the fastest mode, from the forces that unit velocities at one freedom after another leave.
double limit(const Pair& pair) {
  MechanicsOptions measure;
  measure.time_step.estimate = TimeStepOptions::Estimate::element;
  const auto count = static_cast<Eigen::Index>(make(pair, measure)->mesh().nodes());
  Eigen::MatrixXd stiffness(3 * count, 3 * count);
  for (Eigen::Index column = 0; column < 3 * count; ++column) {
    Eigen::Index at = 0;
    MechanicsOptions options = measure;
    options.initial_velocity_function = [&](const Vec3&) {
      Vec3 v{};
      const Eigen::Index c = column - 3 * at++;
      if (c >= 0 && c < 3) v[static_cast<std::size_t>(c)] = 1;
      return v;
    };
    const auto m = make(pair, options);
    m->initialize();
    const double dt = 1e-6 * m->time_step();
    m->advance(dt);
    const double mass = m->nodal_mass()[static_cast<std::size_t>(column / 3)];
    for (Eigen::Index n = 0; n < count; ++n)
      for (Eigen::Index c = 0; c < 3; ++c) {
        const auto i = static_cast<std::size_t>(n);
        stiffness(3 * n + c, column) = m->internal_force()[i].v[c] / dt / std::sqrt(m->nodal_mass()[i] * mass);
      }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (stiffness + stiffness.transpose()),
                                                              Eigen::EigenvaluesOnly);
  return 2 / std::sqrt(solver.eigenvalues().maxCoeff());
}

double estimate(const Pair& pair, TimeStepOptions::Estimate method) {
  MechanicsOptions options;
  options.time_step.scale = 1;
  options.time_step.estimate = method;
  const auto m = make(pair, options);
  m->initialize();
  return m->time_step();
}

/// Whether the energy stays within bounds over so many steps of length dt.
bool bounded(const Pair& pair, double dt, int steps) {
  MechanicsOptions options;
  options.time_step.fixed = dt;
  options.initial_velocity_function = [](const Vec3& x) { return Vec3{1e-7 * x[0], -2e-7 * x[1], 1e-7 * x[0] * x[2]}; };
  const auto m = make(pair, options);
  m->initialize();
  const double start = energy_rows(*m)["kinetic_energy"];
  try {
    for (int s = 0; s < steps; ++s) m->advance(dt);
  } catch (const Error&) {
    return false;
  }
  return energy_rows(*m)["kinetic_energy"] < 10 * start;
}

TEST(DensityRatio, TenThousandToOne) {
  for (const Pair& pair : {Pair{0, false, Form::physical}, Pair{0.2, false, Form::physical},
                           Pair{0.2, true, Form::physical}, Pair{0.2, true, Form::stiffness}}) {
    const double truth = limit(pair), whole = estimate(pair, TimeStepOptions::Estimate::automatic) / truth,
                 alone = estimate(pair, TimeStepOptions::Estimate::element) / truth;
    std::printf("density ratio 10,000, %s, distorted by %g: %.4f of the limit, elements alone %.4f\n",
                pair.mixed ? "mixed" : "halves", pair.distortion, whole, alone);
    EXPECT_LE(whole, 1 + 1e-5);
    EXPECT_GE(whole, pair.distortion > 0 ? 0.85 : 0.97);
    EXPECT_LE(alone, 1 + 1e-5);
    EXPECT_TRUE(bounded(pair, 0.99 * truth, 20000));
    EXPECT_FALSE(bounded(pair, 1.02 * truth, 5000));
  }
}

}  // namespace
}  // namespace tenon::testing

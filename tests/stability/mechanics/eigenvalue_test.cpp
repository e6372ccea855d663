// SPDX-License-Identifier: BSD-3-Clause
// The estimated stable step against the greatest eigenvalue of the whole mesh, found by a dense solver from the forces
// that the component answers small velocities with.
#include <Eigen/Eigenvalues>
#include <cstdio>

#include "solid_meshes.hpp"

namespace tenon::testing {
namespace {

using Form = HourglassOptions::Form;
using Formulation = MechanicsOptions::Formulation;

struct Mode {
  ElementKind kind = ElementKind::hex8;
  Formulation formulation = Formulation::automatic;
  Form form = Form::none;
  double poissons_ratio = 0.3;
};

MechanicsOptions undamped(const Mode& mode) {
  MechanicsOptions options;
  options.viscosity = {0, 0};
  options.hourglass = {mode.form, 0.05};
  return options;
}

std::unique_ptr<Mechanics> make(const BoxShape& box, const Mode& mode, MechanicsOptions options) {
  return solid_body(shared_mesh(solid_box(box, mode.kind)), elastic_material(1, mode.poissons_ratio, 1),
                    mode.formulation, std::move(options));
}

/// 2/omega of the fastest mode. One column of the stiffness matrix for each freedom: the force after a tiny step with
/// unit velocity there.
double limit(const BoxShape& box, const Mode& mode) {
  const auto nodes = static_cast<Eigen::Index>(make(box, mode, undamped(mode))->mesh().nodes());
  Eigen::MatrixXd stiffness(3 * nodes, 3 * nodes);
  for (Eigen::Index column = 0; column < 3 * nodes; ++column) {
    MechanicsOptions options = undamped(mode);
    options.time_step.estimate = TimeStepOptions::Estimate::element;
    Eigen::Index at = 0;
    options.initial_velocity_function = [&](const Vec3&) {
      Vec3 v{};
      const Eigen::Index c = column - 3 * at++;
      if (c >= 0 && c < 3) v[static_cast<std::size_t>(c)] = 1;
      return v;
    };
    const auto m = make(box, mode, options);
    m->initialize();
    const double dt = 1e-6 * m->time_step();
    m->advance(dt);
    for (Eigen::Index n = 0; n < nodes; ++n)
      for (Eigen::Index c = 0; c < 3; ++c) {
        const auto i = static_cast<std::size_t>(n);
        stiffness(3 * n + c, column) = m->internal_force()[i].v[c] / dt / std::sqrt(m->nodal_mass()[i]);
      }
    const auto i = static_cast<std::size_t>(column / 3);
    stiffness.col(column) /= std::sqrt(m->nodal_mass()[i]);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (stiffness + stiffness.transpose()),
                                                              Eigen::EigenvaluesOnly);
  return 2 / std::sqrt(solver.eigenvalues().maxCoeff());
}

double estimate(const BoxShape& box, const Mode& mode, TimeStepOptions::Estimate method) {
  MechanicsOptions options = undamped(mode);
  options.time_step.scale = 1;
  options.time_step.estimate = method;
  const auto m = make(box, mode, options);
  m->initialize();
  return m->time_step();
}

BoxShape box_of(std::array<int, 3> elements, const Vec3& size, double distortion) {
  BoxShape box;
  box.high = size;
  box.elements = elements;
  box.distortion = distortion;
  return box;
}

/// The share of the true limit that is taken must lie between `least` and 1.
void check(const BoxShape& box, const Mode& mode, double least) {
  const double truth = limit(box, mode);
  const double whole = estimate(box, mode, TimeStepOptions::Estimate::automatic) / truth;
  const double alone = estimate(box, mode, TimeStepOptions::Estimate::element) / truth;
  const std::string what = std::string(topology(mode.kind).name) + " nu " + std::to_string(mode.poissons_ratio) +
                           " distorted by " + std::to_string(box.distortion);
  EXPECT_LE(whole, 1 + 1e-5) << what;
  EXPECT_GE(whole, least) << what;
  EXPECT_LE(alone, 1 + 1e-5) << what;
  std::printf("%-50s %.4f of the limit, elements alone %.4f\n", what.c_str(), whole, alone);
}

TEST(Eigenvalues, RegularHexahedra) {
  for (const double nu : {0.0, 0.3, 0.49})
    for (const Form form : {Form::none, Form::stiffness, Form::physical}) {
      check(box_of({1, 1, 1}, {1, 1, 1}, 0), {ElementKind::hex8, Formulation::automatic, form, nu}, 0.97);
      check(box_of({3, 3, 3}, {1, 1, 1}, 0), {ElementKind::hex8, Formulation::automatic, form, nu}, 0.97);
    }
  check(box_of({3, 3, 3}, {1, 0.5, 2}, 0), {}, 0.97);
  check(box_of({2, 3, 4}, {1, 30, 1000}, 0), {}, 0.97);
}

TEST(Eigenvalues, DistortedHexahedra) {
  for (const double nu : {0.3, 0.4999})
    for (const Form form : {Form::none, Form::physical})
      check(box_of({3, 3, 3}, {1, 1, 1}, 0.2), {ElementKind::hex8, Formulation::automatic, form, nu}, 0.85);
}

TEST(Eigenvalues, OtherSolids) {
  for (const double distortion : {0.0, 0.2}) {
    const double least = distortion > 0 ? 0.85 : 0.97;
    check(box_of({2, 2, 2}, {1, 1, 1}, distortion), {ElementKind::hex8, Formulation::full}, least);
    check(box_of({2, 2, 2}, {1, 1, 1}, distortion), {ElementKind::tet4, Formulation::full}, least);
    check(box_of({2, 2, 2}, {1, 1, 1}, distortion), {ElementKind::wedge6, Formulation::full}, least);
    check(box_of({2, 2, 2}, {1, 1, 1}, distortion), {ElementKind::pyramid5}, least);
    // Nodal averages only soften: the products leave them out.
    check(box_of({2, 2, 2}, {1, 1, 1}, distortion), {ElementKind::tet4}, 0.6);
  }
}

/// Steps of `share` of the true limit; whether the energy stays within bounds all the way.
bool bounded(const BoxShape& box, const Mode& mode, double share, int steps) {
  MechanicsOptions options = undamped(mode);
  options.time_step.fixed = share * limit(box, mode);
  options.initial_velocity_function = [](const Vec3& x) { return Vec3{1e-7 * x[0], -2e-7 * x[1], 1e-7 * x[0] * x[2]}; };
  const auto m = make(box, mode, options);
  m->initialize();
  const double start = energy_rows(*m)["kinetic_energy"];
  try {
    for (int s = 0; s < steps; ++s) m->advance(m->time_step());
  } catch (const Error&) {
    return false;
  }
  return energy_rows(*m)["kinetic_energy"] < 10 * start;
}

TEST(TrueLimit, IsSharpOverAHundredThousandSteps) {
  const BoxShape box = box_of({3, 3, 2}, {1, 1, 1}, 0.2);
  EXPECT_TRUE(bounded(box, {ElementKind::hex8, Formulation::automatic, Form::physical}, 0.99, 100000));
  EXPECT_FALSE(bounded(box, {ElementKind::hex8, Formulation::automatic, Form::physical}, 1.02, 2000));
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Static states by dynamic relaxation.
#include "constraints_case.hpp"

namespace tenon::testing {
namespace {

/// Until relaxation has converged; fails after so many steps.
void settle(Mechanics& b, int most) {
  b.initialize();
  Ledger ledger(b);
  int steps = 0;
  for (; steps < most && !b.finished(); ++steps) b.advance(b.time_step());
  ASSERT_TRUE(b.finished()) << b.ending();
  EXPECT_LE(ledger.error(), 1e-12);
  EXPECT_GT(energy_rows(b).at("relaxation_energy"), 0);
  if (communicator().rank() == 0) std::printf("%s\n", b.ending().c_str());
}

// A ball under pressure on its warped faces: -p everywhere, exactly, whatever the mesh.
TEST(Statics, ABallUnderPressureIsUnderUniformStress) {
  SphereShape sphere;
  sphere.core = 2, sphere.shell = 2;
  MechanicsOptions o;
  o.hourglass.form = HourglassOptions::Form::physical;
  o.loads.surface_loads.push_back({SurfaceLoad::Kind::pressure, {"outer"}, {always(1e3)}, "pressure"});
  o.loads.relaxation = RelaxationOptions{1e-9, 0};
  const auto b = body(shared_mesh(on_root(sphere)), steel(), o);
  settle(*b, 5000);
  const std::vector<double> stress = field(*b, "stress");
  for (std::size_t i = 0; i < stress.size(); ++i) EXPECT_NEAR(stress[i], i % 6 < 3 ? -1e3 : 0, 1e-4) << i;
}

/// Tapered panel 48 x (44 -> 16) x 1, n x n x 1 hexahedra.
MeshData cook(int n) {
  MeshData mesh = on_root(box({0, 0, 0}, {48, 1, 1}, {n, n, 1}));
  for (Vec3& x : mesh.coordinates) {
    const double s = x[0] / 48, low = 44 * s, high = 44 + 16 * s;
    x[1] = low + (high - low) * x[1];
  }
  return mesh;
}

/// Plane stress, E = 1, nu = 1/3, unit shear resultant on the right edge; returns the deflection of its middle.
double cook_deflection(int n, int most) {
  constexpr double small = 1e-4;  // so that deflections stay linear
  MechanicsOptions o;
  o.hourglass.form = HourglassOptions::Form::physical;
  o.viscosity = {0, 0};
  o.motions = {motion(PrescribedMotion::Kind::fixed, {"x_min"}), symmetry("z_min", {0, 0, 1})};
  o.motions[0].components = {true, true, false};
  o.loads.surface_loads.push_back(
      {SurfaceLoad::Kind::reference_traction, {"x_max"}, {always(0), always(small / 16), always(0)}, "shear"});
  o.loads.relaxation = RelaxationOptions{1e-6, 0};
  const auto b = body(shared_mesh(cook(n)), elastic_material(1, 1.0 / 3, 1), o);
  settle(*b, most);
  const std::vector<double> u = field(*b, "displacement");
  double deflection = 0;
  for (std::size_t k = 0; 3 * k < u.size(); ++k) {
    const Vec3& x = b->mesh().coordinates[k];
    if (std::abs(x[0] - 48) < 1e-9 && std::abs(x[1] - 52) < 1e-9 && x[2] < 0.5) deflection = u[3 * k + 1];
  }
  std::printf("Cook %d: %.4f\n", n, deflection / small);
  return deflection / small;
}

TEST(Statics, CooksMembrane) {
  EXPECT_GE(cook_deflection(4, 20000), 20.5);
  EXPECT_NEAR(cook_deflection(16, 40000), 23.961, 0.015 * 23.961);
  EXPECT_NEAR(cook_deflection(32, 80000), 23.961, 0.005 * 23.961);
}

// One cube between rollers, lateral faces free: sigma = E ln(stretch), sides shrink as stretch^-nu.
void check_uniaxial(double stretch) {
  const double nu = 0.3;
  MechanicsOptions o;
  PrescribedMotion pull = motion(PrescribedMotion::Kind::displacement, {"x_max"});
  pull.components = {true, false, false};
  pull.value[0] = TimeFunction::smooth_step(0, stretch - 1, 0, 0.2);
  o.motions = {pull, symmetry("x_min", {1, 0, 0}), symmetry("y_min", {0, 1, 0}), symmetry("z_min", {0, 0, 1})};
  o.loads.relaxation = RelaxationOptions{1e-10, 0.2};
  const auto b = body(shared_mesh(on_root(BoxShape{})), elastic_material(200e9, nu, 7850), o);
  settle(*b, 40000);
  const std::vector<double> u = field(*b, "displacement");
  for (std::size_t n = 0; 3 * n < u.size(); ++n) {
    const double y = b->mesh().coordinates[n][1];
    EXPECT_NEAR(y + u[3 * n + 1], y * std::pow(stretch, -nu), 1e-4);
  }
  EXPECT_NEAR(field(*b, "stress")[0], 200e9 * std::log(stretch), 1e-4 * 200e9 * std::abs(std::log(stretch)));
}

TEST(Statics, WhatHasNotConvergedSaysSo) {
  MechanicsOptions o;
  o.loads.relaxation = RelaxationOptions{1e-6, 1};  // loads change until 1 s
  o.loads.nodal_forces.push_back({{"x_max"}, {always(1), always(0), always(0)}, false, "force"});
  o.motions = {motion(PrescribedMotion::Kind::fixed, {"x_min"})};
  const auto b = body(shared_mesh(on_root(box({0, 0, 0}, {2, 1, 1}, {2, 1, 1}))), steel(), o);
  b->initialize();
  for (int s = 0; s < 500; ++s) b->advance(b->time_step());
  EXPECT_FALSE(b->finished());
  EXPECT_NE(b->ending().find("has not converged after 500 steps"), std::string::npos) << b->ending();
}

TEST(Statics, UniaxialStretchWithFreeSides) {
  for (const double stretch : {0.5, 1.5, 3.0}) check_uniaxial(stretch);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Copper cylinder at 227 m/s on a bilateral rigid wall (VERIFICATION A07), a quarter of it, 1080 elements.
#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

TEST(TaylorBar, CopperShortensAndSpreadsAsItShould) {
  CylinderShape cylinder;
  cylinder.radius = 3.2e-3, cylinder.length = 32.4e-3;
  cylinder.core = 6, cylinder.shell = 3, cylinder.axial = 40;
  cylinder.fraction = 0.25;
  MechanicsOptions options;
  options.initial_velocities.push_back({"", "", {0, 0, -227}, {}, {}});
  PrescribedMotion wall = motion(Kind::wall, {"bottom"});
  options.motions = {symmetry("x_min", {1, 0, 0}), symmetry("y_min", {0, 1, 0}), wall};
  const auto m = body(shared_mesh(on_root(cylinder)), copper(), options);
  m->initialize();
  Ledger ledger(*m);
  const auto start = energy_rows(*m);
  run_to(*m, 80e-6);
  EXPECT_LT(ledger.error(), 1e-12);
  double length = 0, radius = 0;
  for (const Vec3& x : m->current_coordinates()) {
    length = std::max(length, x[2]);
    radius = std::max(radius, std::hypot(x[0], x[1]));
  }
  EXPECT_NEAR(length, 21.47e-3, 0.005 * 21.47e-3);
  EXPECT_NEAR(radius, 7.18e-3, 0.02 * 7.18e-3);
  double eqps = 0;
  for (const double e : field(*m, "eqps")) eqps = std::max(eqps, e);
  EXPECT_NEAR(eqps, 3.15, 0.2);
  // The nodes on the wall start at rest, so the wall never works; hourglass control must not eat the impact.
  const auto rows = energy_rows(*m);
  EXPECT_LT(std::abs(rows.at("wall_work")), 1e-3 * start.at("kinetic_energy"));
  EXPECT_LT(rows.at("hourglass_energy"), 0.03 * start.at("kinetic_energy"));
  RecordProperty("length_mm", std::to_string(1e3 * length));
  RecordProperty("radius_mm", std::to_string(1e3 * radius));
  RecordProperty("eqps", std::to_string(eqps));
  std::printf("L %.4f mm, R %.4f mm, eqps %.3f, hourglass %.2f %%, viscosity %.2f %%\n", 1e3 * length, 1e3 * radius,
              eqps, 100 * rows.at("hourglass_energy") / start.at("kinetic_energy"),
              100 * rows.at("viscosity_energy") / start.at("kinetic_energy"));
}

}  // namespace
}  // namespace tenon::testing

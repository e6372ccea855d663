// SPDX-License-Identifier: BSD-3-Clause
// The static obstacle course of shells (A09) by dynamic relaxation, linear loads.
#include "shell_statics_case.hpp"

namespace tenon::testing {
namespace {

// [MH85]
TEST(ShellStatics, TwistedBeam) {
  EXPECT_NEAR(twisted_beam(0.32, 1, 2), 1, 0.02);
  EXPECT_NEAR(twisted_beam(0.32, 1, 1), 1, 0.02);
}

TEST(ShellStatics, PinchedCylinder) {
  EXPECT_GE(pinched_cylinder(8), 0.70);
  EXPECT_GE(pinched_cylinder(16), 0.92);
}

double pinched_hemisphere(int n) {
  const auto surface = [](double r, double s) {
    const double up = 72 * pi / 180 * s, around = 0.5 * pi * r;
    return Vec3{10 * std::cos(up) * std::cos(around), 10 * std::cos(up) * std::sin(around), 10 * std::sin(up)};
  };
  MechanicsOptions options = statics(1e-4);
  options.motions = {hold("r0", "yrxrz"), hold("r1", "xryrz"), hold("r0s0", "z")};
  options.loads.nodal_forces = {force_on("r0s0", {1e-3, 0, 0}), force_on("r1s0", {0, -1e-3, 0})};
  const auto body =
      shell_body(shared_mesh(shell_grid({n, n}, surface)), elastic_material(6.825e7, 0.3, 1), section(0.04), options);
  const std::int64_t steps = relax(*body);
  const double u = 1e3 * displacement_of(*body, "r0s0")[0];
  report("pinched hemisphere", u, 0.0935, steps);
  return u;
}

// Published values lie between 0.0930 and 0.0940.
TEST(ShellStatics, PinchedHemisphere) {
  EXPECT_NEAR(pinched_hemisphere(8), 0.0935, 0.04 * 0.0935);
  EXPECT_NEAR(pinched_hemisphere(16), 0.0935, 0.015 * 0.0935);
}

double square_plate(int n, bool clamped) {
  MechanicsOptions options = statics(1e-4);
  options.motions = {hold("r0", "xryrz"), hold("s0", "yrxrz"), hold("r1", clamped ? "zrxry" : "zrx"),
                     hold("s1", clamped ? "zrxry" : "zry")};
  BodyForce weight;
  weight.label = "pressure as weight";
  for (auto& a : weight.acceleration) a = SpaceTimeFunction::constant(0);
  weight.acceleration[2] = SpaceTimeFunction::constant(1e3 / (7850 * 0.01));
  options.loads.body_forces = {weight};
  const auto body = shell_body(shared_mesh(shell_grid({n, n},
                                                      [](double r, double s) {
                                                        return Vec3{0.5 * r, 0.5 * s, 0};
                                                      })),
                               steel(), section(0.01), options);
  const std::int64_t steps = relax(*body);
  const double w = displacement_of(*body, "r0s0")[2], exact = clamped ? 6.580e-5 : 2.112423e-4;
  report(clamped ? "square plate, clamped" : "square plate, supported", w, exact, steps);
  return w / exact;
}

// A quarter of the plate with 8 x 8 elements: 16 x 16 of the whole. [TWK59]
TEST(ShellStatics, SquarePlates) {
  EXPECT_NEAR(square_plate(8, false), 1, 0.01);
  EXPECT_NEAR(square_plate(8, true), 1, 0.01);
}

// Elastica under a dead end load, P L^2/(E I) = 4: large rotations. [Sze04] 3.1
TEST(ShellStatics, CantileverElastica) {
  MechanicsOptions options = statics(1e-4);
  options.motions = {hold("r0", "xyzrxryrz")};
  options.loads.nodal_forces = {force_on("r1", {0, 0, 2})};
  const auto body = shell_body(shared_mesh(shell_grid({16, 1},
                                                      [](double r, double s) {
                                                        return Vec3{10 * r, s, 0};
                                                      })),
                               elastic_material(1.2e6, 0, 1), section(0.1), options);
  const std::int64_t steps = relax(*body);
  const Vec3 u = displacement_of(*body, "r1s0");
  report("cantilever elastica, -U", -u[0], 3.28941, steps);
  report("cantilever elastica, W", u[2], 6.69964, steps);
  EXPECT_NEAR(-u[0] / 3.28941, 1, 0.01);
  EXPECT_NEAR(u[2] / 6.69964, 1, 0.01);
}

}  // namespace
}  // namespace tenon::testing

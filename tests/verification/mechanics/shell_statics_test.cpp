// SPDX-License-Identifier: BSD-3-Clause
// The static obstacle course of shells (A09) by dynamic relaxation, linear loads, and the spherical cap (A10).
#include <cstdio>
#include <numbers>

#include "shell_case.hpp"

namespace tenon::testing {
namespace {

constexpr double pi = std::numbers::pi;

MechanicsOptions statics(double tolerance) {
  MechanicsOptions options;
  options.loads.relaxation.emplace().tolerance = tolerance;
  options.viscosity = {0, 0};
  return options;
}

void report(const char* what, double value, double reference, std::int64_t steps) {
  std::printf("A09 %-28s %13.6g, reference %13.6g, ratio %.4f, %lld steps\n", what, value, reference, value / reference,
              static_cast<long long>(steps));
}

double twisted_beam(double t, double load, int direction) {
  const auto surface = [](double r, double s) {
    const double a = 0.5 * pi * s, y = 1.1 * (r - 0.5);
    return Vec3{12 * s, y * std::cos(a), y * std::sin(a)};
  };
  MechanicsOptions options = statics(t > 0.1 ? 1e-4 : 1e-5);
  options.motions = {hold("s0", "xyzrxryrz")};
  Vec3 force{};
  force[static_cast<std::size_t>(direction)] = load;
  options.loads.nodal_forces = {force_on("middle", force)};
  const auto body =
      shell_body(shared_mesh(shell_grid({2, 12}, surface)), elastic_material(29e6, 0.22, 1), section(t), options);
  const std::int64_t steps = relax(*body);
  const double u = displacement_of(*body, "middle")[static_cast<std::size_t>(direction)];
  const double reference =
      t > 0.1 ? (direction == 2 ? 5.42453e-3 : 1.753248e-3) : (direction == 2 ? 5.256e-3 : 1.294e-3);
  report(direction == 2 ? "twisted beam, Z" : "twisted beam, Y", u, reference, steps);
  return u / reference;
}

// [MH85]; t = 0.0032: [BWS89].
TEST(ShellStatics, TwistedBeam) {
  EXPECT_NEAR(twisted_beam(0.32, 1, 2), 1, 0.02);
  EXPECT_NEAR(twisted_beam(0.32, 1, 1), 1, 0.02);
}

TEST(ShellStatics, ThinTwistedBeam) {
  EXPECT_NEAR(twisted_beam(0.0032, 1e-6, 2), 1, 0.02);
  EXPECT_NEAR(twisted_beam(0.0032, 1e-6, 1), 1, 0.02);
}

double pinched_cylinder(int n) {
  const auto surface = [](double r, double s) {
    return Vec3{300 * std::sin(0.5 * pi * s), 300 * r, 300 * std::cos(0.5 * pi * s)};
  };
  MechanicsOptions options = statics(1e-4);
  options.motions = {hold("r1", "xz"), hold("r0", "yrxrz"), hold("s0", "xryrz"), hold("s1", "zrxry")};
  options.loads.nodal_forces = {force_on("r0s0", {0, 0, -0.25})};
  const auto body =
      shell_body(shared_mesh(shell_grid({n, n}, surface)), elastic_material(3e6, 0.3, 1), section(3), options);
  const std::int64_t steps = relax(*body);
  const double w = -displacement_of(*body, "r0s0")[2];
  report("pinched cylinder", w, 1.82488e-5, steps);
  return w / 1.82488e-5;
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

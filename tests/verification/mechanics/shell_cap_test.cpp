// SPDX-License-Identifier: BSD-3-Clause
// Spherical cap under a sudden pressure (A10), in inches, pounds of force and seconds: elastic with small and large
// displacements, and elastic-plastic.
#include <cstdio>
#include <numbers>

#include "shell_case.hpp"

namespace tenon::testing {
namespace {

struct Peak {
  double time, deflection;
};

/// First minimum of the centre's deflection per psi/600 of load; 12 x 12 shells on a quarter.
Peak cap(double pressure, bool plastic) {
  constexpr double radius = 22.27, half_angle = 26.67 * std::numbers::pi / 180;
  const auto surface = [=](double r, double s) {
    // A square becomes a quarter of a disc [Fon15]; its radius is the angle from the pole.
    const double x = r * std::sqrt(1 - 0.5 * s * s), y = s * std::sqrt(1 - 0.5 * r * r), rho = std::hypot(x, y);
    const double angle = rho * half_angle, flat = rho > 0 ? radius * std::sin(angle) / rho : 0;
    return Vec3{flat * x, flat * y, radius * std::cos(angle)};
  };
  MaterialDescription metal = elastic_material(10.5e6, 0.3, 2.45e-4);
  if (plastic) metal.plasticity = LinearHardeningParameters{24e3, 0.21e6 / (1 - 0.21 / 10.5)};
  MechanicsOptions options;
  options.viscosity = {0, 0};
  options.motions = {hold("r0", "xryrz"), hold("s0", "yrxrz"), hold("r1", "xyzrxryrz"), hold("s1", "xyzrxryrz")};
  SurfaceLoad load;
  load.side_sets = {"top"}, load.label = "pressure";
  for (auto& value : load.value) value = SpaceTimeFunction::constant(0);
  load.value[0] = SpaceTimeFunction::constant(pressure);
  options.loads.surface_loads = {load};
  const auto body = shell_body(shared_mesh(shell_grid({12, 12}, surface)), metal, section(0.41), options);
  body->initialize();
  Ledger ledger(*body);
  Peak peak{0, 0};
  while (body->time() < 0.6e-3) {
    body->advance(body->time_step());
    const double w = displacement_of(*body, "r0s0")[2] * 600 / pressure;
    if (w < peak.deflection) peak = {body->time(), w};
  }
  std::printf("A10 %g psi%s: %.4f in at %.3f ms\n", pressure, plastic ? ", plastic" : "", peak.deflection,
              1e3 * peak.time);
  EXPECT_LT(ledger.error(), 1e-12);
  return peak;
}

TEST(SphericalCap, LinearElastic) {
  const Peak peak = cap(0.6, false);
  EXPECT_NEAR(peak.deflection / -0.0887, 1, 0.04);
  EXPECT_NEAR(peak.time / 0.380e-3, 1, 0.04);
}

TEST(SphericalCap, LargeDisplacements) {
  const Peak peak = cap(600, false);
  EXPECT_NEAR(peak.deflection / -0.0944, 1, 0.04);
  EXPECT_NEAR(peak.time / 0.400e-3, 1, 0.04);
}

TEST(SphericalCap, ElasticPlastic) {
  const Peak peak = cap(600, true);
  EXPECT_NEAR(peak.deflection / -0.0684, 1, 0.04);
  EXPECT_NEAR(peak.time / 0.460e-3, 1, 0.04);
}

}  // namespace
}  // namespace tenon::testing

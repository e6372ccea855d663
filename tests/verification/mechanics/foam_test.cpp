// SPDX-License-Identifier: BSD-3-Clause
// A column of crushable foam (case A12), crushed slowly and by a rigid piston: the locking shock of a rigid, plastic,
// locking material.
#include "foam_case.hpp"

namespace tenon::testing {
namespace {

using namespace foam_column;

// Five times the stated speed: the inertia of the front adds 0.4 % of the plateau. The stated one runs every night.
TEST(Foam, CrushesSlowlyAtThePlateau) {
  crush_slowly(5);
}

/// Length of crushed foam, of the column as it is under the plateau stress.
double front(Mechanics& b) {
  const std::vector<double> rho = field(b, "density");
  double x = 0;
  for (std::size_t e = 0; e < elements; ++e)
    x += std::clamp((1 - density / rho[e] - yield_strain) / (locking - yield_strain), 0.0, 1.0);
  return x * length * (1 - yield_strain) / elements;
}

struct Shock {
  double stress, front_speed, density, far_least, far_most;
};

/// The piston at `speed` until the front is half-way, from time `start` on; means over the last four fifths.
Shock crush_fast(Mechanics& b, double speed, double start) {
  b.initialize();
  Ledger ledger(b);
  const double duration = 0.5 * length * locking / speed, missing_before = missing(b);
  run_to(b, start + 0.1 * duration);
  const double early = front(b), early_time = b.time(), early_work = energy_rows(b).at("boundary_work");
  Shock s{0, 0, 0, 1e300, 0};
  for (int part = 10; part <= 50; ++part) {
    run_to(b, start + duration * part / 50);
    const double far = -field(b, "stress")[6 * (elements - 1)];
    s.far_least = std::min(s.far_least, far), s.far_most = std::max(s.far_most, far);
  }
  const double work = energy_rows(b).at("boundary_work"), span = b.time() - early_time;
  s.stress = (work - early_work) / (area * speed * span);
  s.front_speed = (front(b) - early) / span;
  const std::vector<double> rho = field(b, "density");
  for (std::size_t e = 10; e < 30; ++e) s.density += rho[e] / 20;
  std::printf("A12b %g m/s: %.4f MPa, front %.2f m/s, density %.2f kg/m^3, far end %.4f to %.4f MPa\n", speed,
              s.stress / 1e6, s.front_speed, s.density, s.far_least / 1e6, s.far_most / 1e6);
  EXPECT_LE(std::abs(missing(b) - missing_before), 1e-3 * work);
  EXPECT_LT(ledger.error(), 1e-11);
  return s;
}

// Rigid foam carries the plateau stress ahead of the front at rest; the elastic foam is brought to it slowly.
TEST(Foam, LocksInAShock) {
  const double ramp = 4e-3;  // 28 times the way of an elastic wave
  for (const double speed : {20.0, 50.0, 100.0}) {
    std::vector<std::pair<double, double>> path;
    const TimeFunction squeeze = TimeFunction::smooth_step(0, 0.995 * yield_strain * length, 0, ramp);
    for (int i = 0; i <= 400; ++i) path.emplace_back(ramp * i / 400, squeeze(ramp * i / 400));
    path.emplace_back(ramp + 1, path.back().second + speed);
    const auto b =
        column(PrescribedMotion::Kind::displacement, TimeFunction::table(path), HourglassOptions::Form::viscous);
    const Shock s = crush_fast(*b, speed, ramp);
    const double stress = plateau + density * speed * speed / locking, front_speed = speed / locking,
                 crushed = density / (1 - locking);
    EXPECT_NEAR(s.stress, stress, 0.02 * stress) << speed;
    EXPECT_NEAR(s.front_speed, front_speed, 0.03 * front_speed) << speed;
    EXPECT_NEAR(s.density, crushed, 0.02 * crushed) << speed;
    EXPECT_NEAR(s.far_least, plateau, 0.02 * plateau) << speed;
    EXPECT_NEAR(s.far_most, plateau, 0.02 * plateau) << speed;
  }
}

// From rest without stress, an elastic wave runs ahead and sets the foam moving at yield / (rho c): the front jumps by
// the rest of the velocity only, and the foam that meets the far end is crushed there as well.
TEST(Foam, LocksInAShockBehindAnElasticPrecursor) {
  const double ahead = plateau / std::sqrt(density * youngs_modulus);
  for (const double speed : {20.0, 50.0, 100.0}) {
    const auto b =
        column(PrescribedMotion::Kind::velocity, TimeFunction::constant(speed), HourglassOptions::Form::viscous);
    const Shock s = crush_fast(*b, speed, 0);
    const double jump = speed - ahead, stress = plateau + density * jump * jump / (locking - yield_strain);
    EXPECT_NEAR(s.stress, stress, 0.02 * stress) << speed;
  }
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// A column of crushable foam (case A12).
#pragma once

#include <cstdio>

#include "constraints_case.hpp"

namespace tenon::testing {
namespace foam_column {

constexpr int elements = 100;
constexpr double length = 0.1, side = 0.01, area = side * side, density = 200, plateau = 2e6, locking = 0.7,
                 youngs_modulus = 100e6, yield_strain = plateau / youngs_modulus;

/// Plateau up to a compaction of 0.7, then 50 times as steep as the elastic foam.
inline MaterialDescription foam() {
  MaterialDescription m = elastic_material(youngs_modulus, 0, density);
  m.whole_law = FoamParameters{{{0, plateau}, {locking, plateau}, {0.8, plateau + 0.1 * 50 * youngs_modulus}}, plateau};
  return m;
}

/// The column along x, held at x_max; its other end moves in as the piston says.
inline std::unique_ptr<Mechanics> column(PrescribedMotion::Kind kind, const TimeFunction& piston,
                                         HourglassOptions::Form form) {
  MechanicsOptions o;
  o.hourglass.form = form;
  PrescribedMotion push = motion(kind, {"x_min"});
  push.components = {true, false, false};
  push.value[0] = piston;
  o.motions = {push, symmetry("x_max", {1, 0, 0}), symmetry("y_min", {0, 1, 0}), symmetry("z_min", {0, 0, 1})};
  return body(shared_mesh(on_root(box({0, 0, 0}, {length, side, side}, {elements, 1, 1}))), foam(), o);
}

inline double lateral_strain(Mechanics& b) {
  double most = 0;
  const std::vector<double> u = field(b, "displacement");
  for (std::size_t n = 0; 3 * n < u.size(); ++n)
    most = std::max({most, std::abs(u[3 * n + 1]) / side, std::abs(u[3 * n + 2]) / side});
  return most;
}

/// Work of the piston that is not found in the column, J.
inline double missing(Mechanics& b) {
  const auto r = energy_rows(b);
  return r.at("boundary_work") - r.at("kinetic_energy") - r.at("internal_energy") - r.at("hourglass_energy") -
         r.at("viscosity_energy");
}

/// To a half, at `speed` (m/s). Crushed elements are a thirtieth as long as wide: over so many steps, viscous hourglass
/// control lets them creep sideways.
inline void crush_slowly(double speed) {
  const auto b =
      column(PrescribedMotion::Kind::velocity, TimeFunction::constant(speed), HourglassOptions::Form::physical);
  b->initialize();
  Ledger ledger(*b);
  // Mean force on the piston from its work between a tenth and a half; stress at the far end all along.
  const double begin = 0.1 * length / speed, end = 0.5 * length / speed, missing_before = missing(*b);
  int steps = run_to(*b, begin);
  const double work_before = energy_rows(*b).at("boundary_work");
  double least = 1e300, most = 0;
  for (int part = 1; part <= 40; ++part) {
    steps += run_to(*b, begin + (end - begin) * part / 40);
    const double far = -field(*b, "stress")[6 * (elements - 1)];
    least = std::min(least, far), most = std::max(most, far);
  }
  const double work = energy_rows(*b).at("boundary_work"), stress = (work - work_before) / (area * 0.4 * length);
  // 10 J, less the elastic start: half of the yield strain.
  const double expected = plateau * area * length * (0.5 - 0.5 * plateau / youngs_modulus);
  std::printf("A12a at %g m/s: %.4f MPa, far end %.4f to %.4f, work %.4f J (%.4f), lateral strain %.2g, %d steps\n",
              speed, stress / 1e6, least / 1e6, most / 1e6, work, expected, lateral_strain(*b), steps);
  EXPECT_NEAR(stress, plateau, 0.02 * plateau);
  EXPECT_NEAR(least, plateau, 0.02 * plateau);
  EXPECT_NEAR(most, plateau, 0.02 * plateau);
  EXPECT_NEAR(work, expected, 0.02 * expected);
  EXPECT_LE(lateral_strain(*b), 1e-3);
  EXPECT_LE(std::abs(missing(*b) - missing_before), 1e-3 * work);
  EXPECT_LT(ledger.error(), 1e-11);
}

}  // namespace foam_column
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Waves of uniaxial strain along a bar of one row of elements (case A03).
#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

constexpr double wave_speed = 6000.978;  // sqrt((K + 4G/3)/rho) of steel()

std::shared_ptr<const Mesh> bar(int n) {
  BoxShape box;
  box.high = {1, 1.0 / n, 1.0 / n};
  box.elements = {n, 1, 1};
  return shared_mesh(on_root(box));
}

/// Rollers on all sides, the far end fixed, the near end as given.
MechanicsOptions rollers(const PrescribedMotion& drive) {
  MechanicsOptions options;
  for (const char* set : {"y_min", "y_max"}) options.motions.push_back(symmetry(set, {0, 1, 0}));
  for (const char* set : {"z_min", "z_max"}) options.motions.push_back(symmetry(set, {0, 0, 1}));
  options.motions.push_back(symmetry("x_max", {1, 0, 0}));
  options.motions.push_back(drive);
  return options;
}

/// A pulse exp(-(s/0.05)^2) enters at x = 0 and travels 0.4 m: the dispersion of the reference, which starts it in the
/// bar. So small that the bar stays linear. Relative L2 error.
double pulse_error(int n, double courant) {
  const double c = std::sqrt(steel().elastic->p_wave_modulus() / steel().density);
  EXPECT_NEAR(c, wave_speed, 0.01);
  constexpr double amplitude = 1e-8, enter = 0.3, end = 0.7;
  const double dt = courant / n / c;
  const int steps = static_cast<int>(std::lround(end / (c * dt)));
  std::vector<std::pair<double, double>> table;
  for (int s = 0; s <= steps; ++s)
    table.emplace_back(s * dt, amplitude * std::exp(-std::pow((c * s * dt - enter) / 0.05, 2)));
  PrescribedMotion drive = motion(Kind::displacement, {"x_min"});
  drive.components = {true, false, false};
  drive.value[0] = TimeFunction::table(table);
  MechanicsOptions options = rollers(drive);
  options.viscosity = {0, 0};
  options.time_step.fixed = dt;
  const auto m = body(bar(n), steel(), options);
  m->initialize();
  for (int s = 0; s < steps; ++s) m->advance(dt);
  double error = 0, size = 0;
  const std::vector<double> u = field(*m, "displacement");
  for (std::size_t i = 0; i < m->mesh().coordinates.size(); ++i) {
    const double exact =
        amplitude * std::exp(-std::pow((m->mesh().coordinates[i][0] - (c * m->time() - enter)) / 0.05, 2));
    error += std::pow(u[3 * i] - exact, 2), size += exact * exact;
  }
  return std::sqrt(error / size);
}

TEST(Wave, ErrorIsThatOfLumpedLinearElements) {
  const int n[] = {50, 100, 200, 400};
  const double expected_9[] = {5.58e-2, 1.12e-2, 2.51e-3, 6.23e-4}, expected_5[] = {1.54e-1, 3.91e-2, 9.73e-3, 2.43e-3};
  double last = 0, before = 0;
  for (int i = 0; i < 4; ++i) {
    before = last;
    last = pulse_error(n[i], 0.9);
    // At n = 50 the pulse is five elements wide, and entering at an end differs from starting inside.
    EXPECT_NEAR(last, expected_9[i], (i == 0 ? 0.3 : 0.2) * expected_9[i]) << n[i];
    EXPECT_NEAR(pulse_error(n[i], 0.5), expected_5[i], 0.2 * expected_5[i]) << n[i];
  }
  EXPECT_GT(std::log2(before / last), 1.9);
}

// At the exact limit the lumped scheme carries the wave without error; any slip in mass or half steps would show.
TEST(Wave, CourantOneIsExact) {
  EXPECT_LT(pulse_error(100, 1.0), 1e-5);
}

// A suddenly moving end: the stress jumps to rho c v and the front passes the middle in time.
TEST(Wave, StepFront) {
  constexpr int n = 200;
  const double c = std::sqrt(steel().elastic->p_wave_modulus() / steel().density), plateau = 1e6;
  for (const double linear : {0.0, 0.06}) {
    PrescribedMotion drive = motion(Kind::velocity, {"x_min"});
    drive.components = {true, false, false};
    drive.value[0] = TimeFunction::constant(plateau / (steel().density * c));
    MechanicsOptions options = rollers(drive);
    options.viscosity = {linear, 0};
    options.time_step.fixed = 0.8 / n / c;
    const auto m = body(bar(n), steel(), options);
    m->initialize();
    Ledger ledger(*m);
    double crossing = 0, most = 0, sum = 0;
    int samples = 0;
    while (m->time() < 0.8 / c) {
      m->advance(m->time_step());
      const double stress = -field(*m, "stress")[6 * (n / 2)];
      if (stress < 0.5 * plateau) crossing = m->time();
      most = std::max(most, stress);
      if (m->time() > 0.6 / c) sum += stress, ++samples;
    }
    EXPECT_NEAR(crossing * c, 0.5 + 0.5 / n, 0.005 * 0.5 + 1.0 / n) << linear;
    EXPECT_NEAR(sum / samples, plateau, 0.005 * plateau) << linear;
    EXPECT_LT(most, (linear > 0 ? 1.12 : 1.30) * plateau) << linear;
    EXPECT_LT(ledger.error(), 1e-12);
  }
}

}  // namespace
}  // namespace tenon::testing

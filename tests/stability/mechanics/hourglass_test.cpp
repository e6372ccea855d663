// SPDX-License-Identifier: BSD-3-Clause
// A pure hourglass pattern is held down for ten thousand steps (case A14 a).
#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

/// The pattern of a mode, alternating from node to node.
double pattern(int mode, const Vec3& x) {
  const auto sign = [](double a) { return std::lround(a) % 2 == 0 ? 1.0 : -1.0; };
  const double xi = sign(x[0]), eta = sign(x[1]), zeta = sign(x[2]);
  const double modes[4] = {eta * zeta, zeta * xi, xi * eta, xi * eta * zeta};
  return modes[mode];
}

struct Outcome {
  double growth, energy;  // greatest displacement over that of the first cycle; total energy over the initial
};

Outcome run(HourglassOptions options_of_form, int mode, int direction) {
  BoxShape box;
  box.high = {4, 4, 4};
  box.elements = {4, 4, 4};
  MechanicsOptions options;
  options.hourglass = options_of_form;
  options.initial_velocity_function = [=](const Vec3& x) {
    Vec3 v{};
    v[static_cast<std::size_t>(direction)] = 1e-3 * pattern(mode, x);
    return v;
  };
  const auto m = body(shared_mesh(on_root(box)), steel(), options);
  m->initialize();
  const double start = energy_rows(*m)["kinetic_energy"];
  double first = 0, most = 0, energy = 0;
  for (int s = 0; s < 10000; ++s) {
    m->advance(m->time_step());
    double moved = 0;
    for (std::size_t n = 0; n < m->mesh().coordinates.size(); ++n)
      moved = std::max(moved, norm(m->current_coordinates()[n] - m->mesh().coordinates[n]));
    (s < 20 ? first : most) = std::max(s < 20 ? first : most, moved);
    if (s % 500 == 0) {
      const auto rows = energy_rows(*m);
      energy = std::max(energy, rows.at("kinetic_energy") + rows.at("internal_energy") + rows.at("hourglass_energy") +
                                    rows.at("viscosity_energy"));
    }
  }
  return {most / first, energy / start};
}

TEST(Hourglass, EveryPatternIsHeldDown) {
  for (int mode = 0; mode < 4; ++mode)
    for (int direction = 0; direction < 3; ++direction) {
      const Outcome viscous = run({HourglassOptions::Form::viscous, 0.1}, mode, direction);
      EXPECT_LT(viscous.growth, 5) << mode << direction;
      EXPECT_LT(viscous.energy, 1.001);
      const Outcome stiff = run({HourglassOptions::Form::stiffness, 0.05}, mode, direction);
      EXPECT_LT(stiff.growth, 5) << mode << direction;
      EXPECT_LT(stiff.energy, 1.001);
    }
}

TEST(Hourglass, WithoutControlItGrows) {
  EXPECT_GT(run({HourglassOptions::Form::none, 0}, 2, 2).growth, 100);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Case C01: a bar hits an equal one at rest. By characteristics (c = sqrt(E/rho)): pressure rho c v0/2 between them for
// the time 2 L/c, after which they have changed velocities and neither has any strain.
#include "contact_case.hpp"

namespace tenon::testing {
namespace {

constexpr double length = 0.1, side = 0.01, modulus = 100e9, density = 1e4, speed = 10;
const double wave = std::sqrt(modulus / density), together = 2 * length / wave,
             plateau = 0.5 * density * wave * speed * side * side;

struct TwoBars {
  std::array<int, 2> left{1, 1}, right{1, 1};  // faces across the end of each bar
  double viscosity = 0;                        // linear
  Placing placing = shifted({0, 0, 0});
  Vec3 axis{1, 0, 0};
};

ContactScene scene(const TwoBars& bars) {
  ContactScene s;
  s.mesh = placed(beside({{"left", brick({-length, 0, 0}, {0, side, side}, {100, bars.left[0], bars.left[1]})},
                          {"right", brick({0, 0, 0}, {length, side, side}, {100, bars.right[0], bars.right[1]})}}),
                  bars.placing);
  const MaterialDescription metal = elastic_material(modulus, 0, density);
  s.mechanics.blocks = {of_material("left", metal), of_material("right", metal)};
  s.mechanics.viscosity = {bars.viscosity, 0};
  s.mechanics.initial_velocities = {moving("left", speed * bars.axis)};
  s.end = 1.6 * together;
  return s;
}

/// The time between which the force is above half of the plateau, and its mean and range in between.
struct Force {
  double rise = -1, fall = -1, least = 1e300, greatest = -1e300, impulse = 0, from = 0, to = 0;
  double mean() const { return impulse / (to - from); }
};

void check(const TwoBars& bars) {
  ContactRun run(scene(bars));
  Force force;
  double before = run.time(), carried = dot(run.momentum("right"), bars.axis), most_energy = 0;
  const double kinetic = run.row("kinetic_energy");
  run.run(run.simulation().end_time(), [&] {
    // The force on the right bar is the change of its momentum: nothing else acts on it.
    const double now = dot(run.momentum("right"), bars.axis), dt = run.time() - before, f = (now - carried) / dt;
    if (f > 0.5 * plateau) {
      if (force.rise < 0) force.rise = before;
      force.fall = run.time();
    }
    if (before > 0.1 * together && run.time() < 0.9 * together) {
      if (force.from == 0) force.from = before;
      force.to = run.time(), force.impulse += now - carried;
      force.least = std::min(force.least, f), force.greatest = std::max(force.greatest, f);
    }
    before = run.time(), carried = now;
    most_energy = std::max(most_energy, run.row("contact_energy"));
  });
  const double oscillation = std::max(force.greatest - plateau, plateau - force.least) / plateau;
  const double left = dot(run.velocity("left"), bars.axis), right = dot(run.velocity("right"), bars.axis);
  std::printf("C01 plateau %.5f of the exact one, oscillation %.4f, time %.4f of 2 L/c, velocities %.4f and %.4f m/s; ",
              force.mean() / plateau, oscillation, (force.fall - force.rise) / together, left, right);
  std::printf("contact energy at most %.2e, at the end %.2e, lost %.2e of the kinetic energy; %lld steps\n",
              most_energy / kinetic, run.row("contact_energy") / kinetic, run.row("contact_dissipation") / kinetic,
              static_cast<long long>(run.simulation().steps()));
  EXPECT_NEAR(force.mean(), plateau, 0.01 * plateau);
  EXPECT_LE(oscillation, bars.viscosity > 0 ? 0.05 : 0.15);
  EXPECT_NEAR(force.fall - force.rise, together, 0.02 * together);
  if (bars.viscosity == 0) {  // it takes some 2 % of the energy of a step wave over so few elements
    EXPECT_GE(right, 0.985 * speed);
    EXPECT_LE(std::abs(left), 0.015 * speed);
  }
  EXPECT_LE(std::abs(run.row("contact_energy")), 0.01 * kinetic);  // the spring has given back what it held
  EXPECT_LE(std::abs(run.row("contact_dissipation")), 0.01 * kinetic);
  expect_conserved(run);
}

TEST(TwoBars, MatchingFaces) {
  check({});
}

TEST(TwoBars, MatchingFacesWithBulkViscosity) {
  TwoBars bars;
  bars.viscosity = 0.06;
  check(bars);
}

TEST(TwoBars, NonMatchingFaces) {
  TwoBars bars;
  bars.left = {3, 3}, bars.right = {4, 4};
  check(bars);
}

TEST(TwoBars, NonMatchingFacesWithBulkViscosity) {
  TwoBars bars;
  bars.left = {3, 3}, bars.right = {4, 4}, bars.viscosity = 0.06;
  check(bars);
}

TEST(TwoBars, NonMatchingFacesAtASkewAngle) {
  TwoBars bars;
  bars.left = {3, 3}, bars.right = {4, 4};
  bars.placing = rotated({1, 2, 3}, 0.7);
  bars.axis = bars.placing(bars.axis);
  check(bars);
}

// A force on contact's own account is what the bodies feel.
TEST(TwoBars, HistoryOfThePairIsTheChangeOfMomentum) {
  ContactRun run(scene({}));
  run.run(0.5 * together, [&] {
    const Vec3 impulse = run.impulse("left_right"), gained = run.momentum("right");
    EXPECT_NEAR(std::abs(impulse[0]), gained[0], 1e-12 * plateau * together);
  });
  EXPECT_NEAR(std::abs(run.force("left_right")[0]), plateau, 0.05 * plateau);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Case F08: a bar of elements hits one of particles with the same impedance Z = rho c. By characteristics: pressure
// Z v0/2 between them for the time 2 L/c, after which they have changed velocities.
#include "sph_contact_case.hpp"

namespace tenon::testing {
namespace {

constexpr double length = 0.1, side = 0.008, spacing = 0.002, density = 1000, wave = 1500, speed = 10;
constexpr double together = 2 * length / wave, plateau = 0.5 * density * wave * speed * side * side;

ParticlesOnMesh scene(SphFormulation formulation) {
  ParticlesOnMesh s;
  const MaterialDescription elastic = elastic_material(density * wave * wave, 0, density);
  s.mesh = beside({{"elements", brick({-length, 0, 0}, {0, side, side}, {50, 1, 1})}});
  s.mechanics.blocks = {of_material("elements", elastic)};
  s.mechanics.initial_velocities = {moving("elements", {speed, 0, 0})};
  ParticleFill fill;
  fill.spacing = spacing;
  s.particles = join_particles({{"particles", fill_box({0, 0, 0}, {length, side, side}, fill)}});
  s.sph.formulation = formulation;
  const bool solid = formulation == SphFormulation::total_lagrangian;
  s.sph.bodies = {body_of("particles", solid ? elastic : liquid(density, wave))};
  for (std::size_t c = 1; c < 3; ++c) {  // strain along the bar only
    s.sph.domain.axes[c].periodic = true;
    s.sph.domain.axes[c].low = 0, s.sph.domain.axes[c].high = side;
  }
  s.end = 1.2 * together;
  return s;
}

void collide(SphFormulation formulation, const char* name) {
  ParticlesOnMeshRun run(scene(formulation));
  const double mass = density * length * side * side, carried_at_first = run.start()[0];
  double before = 0, carried = 0, rise = -1, fall = -1, from = 0, to = 0, impulse = 0, highest = 0;
  run.run([&] {
    const double now = run.momentum_of_particles()[0], dt = run.time() - before, force = (now - carried) / dt;
    if (force > 0.5 * plateau) {
      if (rise < 0) rise = before;
      fall = run.time();
    }
    if (before > 0.1 * together && run.time() < 0.9 * together) {
      if (from == 0) from = before;
      to = run.time(), impulse += now - carried, highest = std::max(highest, std::abs(force / plateau - 1));
    }
    before = run.time(), carried = now;
  });
  const double right = carried / mass, left = (run.momentum()[0] - carried) / mass;
  std::printf(
      "F08, %s: plateau %.4f of the exact one (greatest deviation %.3f), time %.4f of 2 L/c, velocities %.4f and %.4f "
      "m/s, restitution %.4f, momentum lost %.1e, ledger %.1e, %lld steps\n",
      name, impulse / (to - from) / plateau, highest, (fall - rise) / together, left, right, (right - left) / speed,
      norm(run.momentum() - run.start()) / carried_at_first, run.ledger_error(),
      static_cast<long long>(run.simulation().steps()));
  EXPECT_NEAR(impulse / (to - from), plateau, 0.02 * plateau);
  EXPECT_LE(highest, 0.04);
  EXPECT_NEAR(fall - rise, together, 0.04 * together);
  EXPECT_GE((right - left) / speed, 0.93);
  EXPECT_LE(std::abs(left), 0.04 * speed);  // what an interface reflects stays behind
  EXPECT_LE(norm(run.momentum() - run.start()), 1e-12 * carried_at_first);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

TEST(BarOfElements, GivesItsMomentumToABarOfFluid) {
  collide(SphFormulation::fluid, "fluid");
}

TEST(BarOfElements, GivesItsMomentumToABarOfSolidParticles) {
  collide(SphFormulation::total_lagrangian, "total Lagrangian solid");
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Case C07: an elastic cube without any damping falls on a rigid plate, five times, on its face, on an edge and on a
// corner. Energy stays. Fully integrated and hyperelastic, so that all forces of the elements come from an energy.
#include "contact_case.hpp"

namespace tenon::testing {
namespace {

constexpr double side = 0.1, g = 9.81, drop = 0.5;

void bounce(const Placing& tilt, const char* what) {
  ContactScene s;
  MeshData cube = placed(brick({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}, {4, 4, 4}), tilt);
  double lowest = 0;
  for (const Vec3& x : cube.coordinates) lowest = std::min(lowest, x[2]);
  s.mesh = beside({{"cube", placed(std::move(cube), shifted({0, 0, drop - lowest}))}});
  MechanicsOptions& o = s.mechanics;
  MaterialDescription rubber = elastic_material(10e6, 0.3, 1000);
  rubber.whole_law = MooneyRivlinParameters{0.5 * 10e6 / 2.6, 0, 10e6 / 1.2};
  o.blocks = {of_material("cube", rubber)};
  o.blocks[0].formulation = MechanicsOptions::Formulation::full;
  o.time_step.scale = 0.8, o.time_step.estimate = TimeStepOptions::Estimate::element;
  o.viscosity = {0, 0};
  o.loads.body_forces = {gravity({0, 0, -g})};
  s.contact.rigid_surfaces = {rigid_plane("plate", {0, 0, 0}, {0, 0, 1})};
  s.end = 4;
  ContactRun run(s);
  const double mass = 1000 * side * side * side, scale = mass * g * drop;
  const auto energy = [&] {
    return run.row("kinetic_energy") + run.row("internal_energy") + run.row("hourglass_energy") +
           run.row("contact_energy") - run.row("body_work");
  };
  const double start = energy();
  double first = 0, lost = 0, least = 0, gained = 0, former = start, flight = 0, held = 0;
  int bounces = 0;
  bool touching = false;
  while (bounces < 5 && !run.done()) {
    const Vec3 impulse = run.impulse("cube_plate");
    run.step();
    const bool touches = norm(run.impulse("cube_plate") - impulse) > 0;
    if (touches && first == 0) first = run.time();
    const double total = energy();
    gained = std::max(gained, (total - start) / scale);
    least = std::min(least, run.row("internal_energy") / scale);
    if (touches) flight = 0;
    if (!touches && touching) flight = run.time();
    touching = touches;
    // A twentieth of a second in the air ends a bounce.
    if (!touches && flight > 0 && run.time() - flight > 0.05) {
      ++bounces, flight = 0;
      lost = std::max(lost, (former - total) / scale);
      held = std::max(held, std::abs(run.row("contact_energy")) / scale);
      former = total;
    }
  }
  std::printf(
      "C07 on %s: first touch %.6f s, %d bounces, most lost in one %.2e, gained %.2e, contact energy in flight "
      "%.2e of m g h, least internal energy %.2e; lost to contact in all %.2e; %lld steps\n",
      what, first, bounces, lost, gained, held, least, run.row("contact_dissipation") / scale,
      static_cast<long long>(run.simulation().steps()));
  EXPECT_EQ(bounces, 5);
  EXPECT_NEAR(first, 0.319275, 2 * run.simulation().dt());
  EXPECT_LE(lost, 0.005);
  EXPECT_LE(gained, 0.001);
  EXPECT_LE(held, 1e-6);
  // By the work on the nodes: the sum of energies closes whatever they do, but what elements store is not negative.
  EXPECT_GE(least, -1e-6);
  expect_conserved(run, false);
}

TEST(Bounce, OnAFace) {
  bounce(rotated({0, 0, 1}, 0), "a face");
}

TEST(Bounce, OnAnEdge) {
  bounce(rotated({1, 0, 0}, std::numbers::pi / 4), "an edge");
}

TEST(Bounce, OnACorner) {
  // The diagonal (1, 1, 1) becomes the vertical.
  bounce(rotated({1, -1, 0}, -std::acos(1 / std::sqrt(3.0))), "a corner");
}

}  // namespace
}  // namespace tenon::testing

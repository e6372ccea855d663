// SPDX-License-Identifier: BSD-3-Clause
// Case C04: a block under gravity on a plate with Coulomb friction slides to rest, sticks or slides on an incline, and
// does not creep under a load that goes to and fro.
#include "contact_case.hpp"

namespace tenon::testing {
namespace {

constexpr double side = 0.1, g = 9.81, weight = g;  // 1 kg

enum class Plate { rigid, elements };

/// The block stands on z = 0; `down` is the direction of gravity.
ContactScene scene(Plate plate, double friction, const Vec3& down, double end) {
  ContactScene s;
  const MeshData block = brick({-0.05, -0.05, 0}, {0.05, 0.05, side}, {2, 2, 2});
  const MaterialDescription rubber = elastic_material(10e6, 0, 1000);
  MechanicsOptions& o = s.mechanics;
  o.blocks = {of_material("block", rubber)};
  if (plate == Plate::rigid) {
    s.mesh = beside({{"block", block}});
    s.contact.rigid_surfaces = {rigid_plane("plate", {0, 0, 0}, {0, 0, 1})};
  } else {
    s.mesh = beside({{"block", block}, {"plate", brick({-0.2, -0.2, -0.05}, {1, 0.2, 0}, {9, 3, 1})}});
    o.blocks.push_back(of_material("plate", rubber));
    o.motions = {motion(PrescribedMotion::Kind::fixed, {"plate_x_min", "plate_x_max", "plate_z_min", "plate_z_max"})};
  }
  s.contact.friction = {friction, friction};
  BodyForce force = gravity(g * down);
  force.blocks = {"block"};
  o.loads.body_forces = {force};
  s.end = end;
  return s;
}

// (a) v0 = 2 m/s, mu = 0.3: v0^2/(2 mu g) in v0/(mu g).
void slide_to_rest(Plate plate) {
  ContactScene s = scene(plate, 0.3, {0, 0, -1}, 0.8);
  s.mechanics.initial_velocities = {moving("block", {2, 0, 0})};
  ContactRun run(s);
  const double start = run.centre("block")[0], kinetic = run.row("kinetic_energy");
  double rest = 0;
  run.run(s.end, [&] {
    if (run.velocity("block")[0] > 0.02) rest = run.time() + 0.02 / (0.3 * g);  // after that it rings
  });
  const double way = run.centre("block")[0] - start, heat = run.row("friction_energy");
  std::printf("C04a %s plate: %.5f m in %.5f s, friction took %.5f of the kinetic energy\n",
              plate == Plate::rigid ? "rigid" : "element", way, rest, heat / kinetic);
  EXPECT_NEAR(way, 0.67958, 0.0067958);
  EXPECT_NEAR(rest, 0.67958, 0.0067958);
  EXPECT_NEAR(heat, kinetic, 0.01 * kinetic);
  EXPECT_NEAR(heat, 0.3 * weight * way, 0.01 * kinetic);
  expect_conserved(run, false);
}

TEST(Coulomb, BlockSlidesToRestOnARigidPlate) {
  slide_to_rest(Plate::rigid);
}

TEST(Coulomb, BlockSlidesToRestOnElements) {
  slide_to_rest(Plate::elements);
}

// (b) An incline of 20 degrees: tan = 0.36397.
Vec3 inclined() {
  const double a = 20 * std::numbers::pi / 180;
  return {std::sin(a), 0, -std::cos(a)};
}

TEST(Coulomb, BlockSlidesDownAnIncline) {
  ContactRun run(scene(Plate::rigid, 0.2, inclined(), 1));
  const double start = run.centre("block")[0];
  run.run(1);
  const double way = run.centre("block")[0] - start;
  std::printf("C04b mu 0.2: %.5f m in 1 s, %.5f m/s\n", way, run.velocity("block")[0]);
  EXPECT_NEAR(way, 0.75577, 0.0075577);
  EXPECT_NEAR(run.velocity("block")[0], 1.51154, 0.0151154);
  expect_conserved(run, false);
}

TEST(Coulomb, BlockSticksOnAnIncline) {
  for (const double friction : {0.367, 0.4, 0.8})
    for (const Plate plate : {Plate::rigid, Plate::elements}) {
      ContactScene s = scene(plate, friction, inclined(), 1);
      // Viscous control would let corners creep under a steady force.
      s.mechanics.hourglass.form = HourglassOptions::Form::stiffness;
      // Applied slowly: with all at once the block would ring and slip at the start.
      for (auto& a : s.mechanics.loads.body_forces[0].acceleration)
        a = SpaceTimeFunction(TimeFunction::smooth_step(0, a.in_time()(0), 0, 0.1));
      ContactRun run(s);
      run.run(0.3);
      const double from = run.centre("block")[0], at = run.time();
      double fastest = 0;
      run.run(1, [&] { fastest = std::max(fastest, std::abs(run.velocity("block")[0])); });
      const double creep = (run.centre("block")[0] - from) / (run.time() - at);
      std::printf("C04b mu %.3f: creep %.2e m/s, fastest %.2e m/s\n", friction, creep, fastest);
      EXPECT_LE(std::abs(creep), 1e-4);
      EXPECT_LE(fastest, 1e-4);
      expect_conserved(run, false);
    }
}

// (c) A quarter of what slides it, to and fro along x, ten times: every part of its foot sticks, and it comes back.
TEST(Coulomb, NoDriftUnderAReversingLoad) {
  ContactScene s = scene(Plate::rigid, 0.3, {0, 0, -1}, 3);
  s.mechanics.hourglass.form = HourglassOptions::Form::stiffness;
  BodyForce& force = s.mechanics.loads.body_forces[0];
  force.acceleration[2] = SpaceTimeFunction(TimeFunction::smooth_step(0, -g, 0, 0.1));
  force.acceleration[0] = SpaceTimeFunction(TimeFunction::sine(0.25 * 0.3 * g, 0.1, 0, 0));
  ContactRun run(s);
  run.run(2);  // what the start set into motion has died out
  const double from = run.centre("block")[0];
  double most = 0;
  run.run(3, [&] { most = std::max(most, std::abs(run.centre("block")[0] - from)); });
  const double drift = run.centre("block")[0] - from, elastic = 0.25 * 0.3 * weight / (5e6 * side);
  std::printf("C04c drift %.2e m, greatest way %.2e m, elastic scale %.2e m\n", drift, most, elastic);
  EXPECT_LE(std::abs(drift), 0.01 * elastic);
  EXPECT_LE(most, 3 * elastic);
  expect_conserved(run, false);
}

// Static friction above kinetic: sticks where the kinetic value alone would let it slide, and slides once pushed.
TEST(Coulomb, StaticFrictionHoldsUntilItIsOvercome) {
  for (const double start : {0.0, 0.5}) {
    ContactScene s = scene(Plate::rigid, 0.2, inclined(), 0.6);
    s.contact.friction = {0.8, 0.2};
    s.mechanics.hourglass.form = HourglassOptions::Form::stiffness;
    for (auto& a : s.mechanics.loads.body_forces[0].acceleration)
      if (start == 0) a = SpaceTimeFunction(TimeFunction::smooth_step(0, a.in_time()(0), 0, 0.1));
    s.mechanics.initial_velocities = {moving("block", {start, 0, 0})};
    ContactRun run(s);
    run.run(0.6);
    const double v = run.velocity("block")[0], a = g * (std::sin(0.349066) - 0.2 * std::cos(0.349066));
    std::printf("C04 static 0.8, kinetic 0.2, start %.1f m/s: %.5f m/s after 0.6 s\n", start, v);
    const double exact = start == 0 ? 0 : start + a * 0.6;
    EXPECT_NEAR(v, exact, std::max(1e-4, 0.01 * exact));
  }
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Case F10: what water does to a box that is held in it, and to one that floats.
#include "water_case.hpp"

namespace tenon::testing {
namespace {

constexpr double edge = 0.1, spacing = 0.1 * edge;  // m

RigidBody rigid(bool held) {
  RigidBody body;
  body.blocks = {"box"}, body.label = "box";
  body.prescribed_velocity[2] = TimeFunction::constant(0);
  if (held) {
    for (auto& v : body.prescribed_velocity) v = TimeFunction::constant(0);
    body.rotation = RigidBody::Rotation::fixed;
  }
  return body;
}

/// A box with its foot at `bottom` in a tank of that width; of no density if it is held.
ParticlesOnMesh scene(double bottom, double level, double width, double density) {
  const bool held = density == 0;
  WaterShape water;
  const double side = 0.5 * (width - edge);
  water.high = {width, level, 0};
  water.hole = Box{{side, bottom, 0}, {side + edge, bottom + edge, 0}};
  water.room_low = Vec3{}, water.room_high = Vec3{width, level + edge, 0};
  water.spacing = spacing, water.sound = 20;
  ParticlesOnMesh s = with_water(water);
  s.sph.fluid.density_diffusion = 0;
  s.sph.artificial_viscosity.alpha = 0.3;
  s.mesh = beside({{"box", thick_brick(water.hole->low, water.hole->high, 1, 1)}});
  s.mechanics.blocks = {of_material("box", elastic_material(1e6, 0, held ? of_water : density))};
  s.mechanics.loads.rigid_bodies = {rigid(held)};
  if (!held) s.mechanics.loads.body_forces = {gravity({0, -earth, 0})};
  s.end = 1;
  return s;
}

Vec3 impulse_on_box(ParticlesOnMeshRun& run) {
  Vec3 total{};
  for (const auto& [name, share] : run.contact().amounts())
    for (std::size_t c = 0; c < 3; ++c)
      if (name == std::string("contact_box_water_impulse_") + "xyz"[c]) total[c] = run.body().mesh().comm.sum(share);
  return total;
}

TEST(Archimedes, BoxHeldUnderWater) {
  ParticlesOnMeshRun run(scene(0.1, 0.3, 0.3, 0));
  double from = 0;
  Vec3 before{};
  run.run([&] {
    if (from == 0 && run.time() > 0.3) from = run.time(), before = impulse_on_box(run);
  });
  const Vec3 force = (1 / (run.time() - from)) * (impulse_on_box(run) - before);
  const double exact = of_water * earth * edge * edge;  // N per metre
  std::printf("F10 held: force (%.4f, %.3f) of (0, %.3f) N/m, %+.2f %%, ledger %.1e, %lld steps\n", force[0], force[1],
              exact, 100 * (force[1] / exact - 1), run.ledger_error(),
              static_cast<long long>(run.simulation().steps()));
  EXPECT_NEAR(force[1], exact, 0.03 * exact);
  EXPECT_LE(std::abs(force[0]), 0.01 * exact);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

TEST(Archimedes, BoxFloats) {
  constexpr double level = 0.2, draught = 0.06, width = 0.4;
  ParticlesOnMeshRun run(scene(level - draught, level, width, 600));
  double deepest = 0, highest = 1, aside = 0, turned = 0;
  run.run([&] {
    Vec3 low{1e300, 1e300, 0}, corner{-1e300, -1e300, 0};
    const Mesh& mesh = run.body().mesh();
    const std::span<const Vec3> x = run.body().current_coordinates();
    for (const LocalIndex n : mesh.owned_nodes) {
      const auto i = static_cast<std::size_t>(n);
      if (mesh.coordinates[i][1] > level) continue;
      for (std::size_t c = 0; c < 2; ++c) low[c] = std::min(low[c], x[i][c]), corner[c] = std::max(corner[c], x[i][c]);
    }
    for (std::size_t c = 0; c < 2; ++c) low[c] = mesh.comm.min(low[c]), corner[c] = mesh.comm.max(corner[c]);
    const double foot = 0.5 * (low[1] + corner[1]);
    deepest = std::max(deepest, level - foot), highest = std::min(highest, level - foot);
    aside = std::max(aside, std::abs(0.5 * (low[0] + corner[0]) - 0.5 * width));
    turned = std::max(turned, (corner[1] - low[1]) / edge);
  });
  std::printf("F10 floating: draught %.2f to %.2f mm, aside %.4f mm, turned %.1e rad, ledger %.1e, %lld steps\n",
              1e3 * highest, 1e3 * deepest, 1e3 * aside, turned, run.ledger_error(),
              static_cast<long long>(run.simulation().steps()));
  EXPECT_NEAR(deepest, draught, 0.03 * draught);
  EXPECT_NEAR(highest, draught, 0.03 * draught);
  EXPECT_LE(aside, 0.01 * edge);
  EXPECT_LE(turned, 0.01);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Case A13 (c) with contact: elements die, and the faces behind them are hit in the same step. A block that is shot at
// a plate whose front layers have died meets the layer behind them and nothing passes.
#include "contact_case.hpp"

namespace tenon::testing {
namespace {

/// A plate of three layers of 1 mm; the weak ones fail in the first step, so that the block flies into the gap.
ContactScene scene(double gap, double speed) {
  ContactScene s;
  s.mesh = beside({{"plate", brick({-0.01, -0.01, -3e-3}, {0.01, 0.01, 0}, {10, 10, 3})},
                   {"block", brick({-3e-3, -3.3e-3, gap}, {3e-3, 2.7e-3, gap + 6e-3}, {3, 3, 3})}});
  // Elements of the plate within 5 mm of the axis, in the two upper layers, become a block of their own.
  BlockData& plate = s.mesh.blocks[0];
  BlockData strong = plate, weak = plate;
  weak.name = "weak";
  for (BlockData* b : {&strong, &weak}) b->connectivity.clear(), b->labels.clear();
  for (std::size_t e = 0; e < plate.size(); ++e) {
    Vec3 c{};
    for (std::size_t k = 0; k < 8; ++k)
      c = c + 0.125 * s.mesh.coordinates[static_cast<std::size_t>(plate.connectivity[8 * e + k])];
    BlockData& to = c[2] > -2e-3 && std::hypot(c[0], c[1]) < 7e-3 ? weak : strong;
    to.connectivity.insert(to.connectivity.end(), plate.connectivity.begin() + static_cast<std::ptrdiff_t>(8 * e),
                           plate.connectivity.begin() + static_cast<std::ptrdiff_t>(8 * e + 8));
    to.labels.push_back(plate.labels[e]);
  }
  s.mesh.blocks = {strong, weak, s.mesh.blocks[1]};
  s.mesh.side_sets.clear();  // of the former order of elements
  const MaterialDescription steel = elastic_material(200e9, 0.3, 7850);
  MaterialDescription brittle = steel;
  brittle.failure.emplace().tensile_stress = 1e6;
  MechanicsOptions& o = s.mechanics;
  o.blocks = {of_material("plate", steel), of_material("weak", brittle), of_material("block", steel)};
  InitialStress tension;
  tension.blocks = {"weak"}, tension.label = "tension";
  for (std::size_t c = 0; c < 6; ++c) tension.stress[c] = SpaceTimeFunction::constant(c == 0 ? 2e6 : 0.0);
  o.loads.initial_stresses = {tension};
  o.motions = {motion(PrescribedMotion::Kind::fixed, {"plate_x_min", "plate_x_max"})};
  o.initial_velocities = {moving("block", {0, 0, -speed})};
  s.end = 60e-6;
  return s;
}

double lowest_of_block(ContactRun& run) {
  return run.reach("block", {0, 0, 1}, -1);
}

TEST(ErosionWithContact, BlockShotIntoTheGapMeetsTheLayerBehind) {
  ContactRun run(scene(1e-4, 50));
  double deepest = 0;
  run.run(60e-6, [&] { deepest = std::min(deepest, lowest_of_block(run)); });
  const std::vector<double> status = field(run.body(), "element_status");
  double alive = 0;
  for (const double s : status) alive += s;
  std::printf("A13c block reached %.3f mm, velocity %.2f m/s, %g elements of %zu alive on this rank\n", 1e3 * deepest,
              run.velocity("block")[2], alive, status.size());
  EXPECT_LT(deepest, -0.5e-3);                     // into the gap, past what is left of the weak elements
  EXPECT_GT(deepest, -2e-3 - 0.5e-3);              // and no farther than the layer behind bends
  EXPECT_GT(run.velocity("block")[2], -0.2 * 50);  // which has stopped it
  EXPECT_LE(run.momentum_residual(), 1e-13);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

// The block stands on the new faces: it must be stopped in the very step in which they appear, at a speed that would
// carry it a whole layer in one step.
TEST(ErosionWithContact, NewFacesAreHitInTheSameStep) {
  ContactScene s = scene(-2e-3 + 1e-6, 3000);  // inside the weak layers, above the layer behind
  s.contact.pairs = {{"weak", "block", true, {}}};
  ContactRun run(s);
  run.step();
  run.step();
  // 3000 m/s times a step of some 0.1 us is 0.3 mm.
  std::printf("A13c after two steps: lowest node of the block %.4f mm, impulse %.3e N s\n", 1e3 * lowest_of_block(run),
              norm(run.impulse("plate_block")));
  EXPECT_GT(norm(run.impulse("plate_block")), 0);
  EXPECT_LE(run.momentum_residual(), 1e-13);
}

}  // namespace
}  // namespace tenon::testing

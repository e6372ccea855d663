// SPDX-License-Identifier: BSD-3-Clause
// Bodies that overlap before the first step: moved apart without stress, kept as they are, or refused.
#include "depth.hpp"

namespace tenon::testing {
namespace {

constexpr double overlap = 1e-4;
using InitialOverlaps = ContactOptions::InitialOverlaps;

ContactScene overlapping(InitialOverlaps what) {
  ContactScene s;
  s.mesh = beside({{"under", brick({0, 0, -0.02}, {0.05, 0.05, 0}, {5, 5, 2})},
                   {"over", brick({0.011, 0.013, -overlap}, {0.041, 0.043, 0.02}, {4, 4, 2})}});
  const MaterialDescription m = elastic_material(1e9, 0.3, 1000);
  s.mechanics.blocks = {of_material("under", m), of_material("over", m)};
  s.contact.initial_overlaps = what;
  s.end = 2e-4;
  return s;
}

TEST(InitialOverlap, IsRemovedWithoutStress) {
  ContactRun run(overlapping(InitialOverlaps::remove));
  const double left = std::max(
      run.comm().max(depth_below(nodes_of(run.body(), "over_z_min"), triangles_of(run.body(), "under_z_max"))), -1.0);
  EXPECT_LE(left, 0.01 * overlap);
  run.run(2e-4);
  const std::vector<double> stress = field(run.body(), "stress");
  for (const double s : stress) EXPECT_LE(std::abs(s), 1e-6 * 1e9);
  EXPECT_LE(run.row("kinetic_energy"), 1e-12);
  expect_conserved(run, false);
}

TEST(InitialOverlap, KeptItDoesNotGrow) {
  ContactScene s = overlapping(InitialOverlaps::keep);
  ContactRun still(s);
  still.run(2e-4);
  EXPECT_LE(still.row("kinetic_energy"), 1e-12);
  EXPECT_NEAR(still.reach("under", {0, 0, 1}, 1) - still.reach("over", {0, 0, 1}, -1), overlap, 1e-3 * overlap);
  s.mechanics.initial_velocities = {moving("over", {0, 0, -1}), moving("under", {0, 0, 0.36})};
  ContactRun pressed(s);
  double deepest = 0;
  pressed.run(2e-4, [&] {
    deepest = std::max(
        deepest, pressed.now_at("under", {0.03, 0.03, 0})[2] - pressed.now_at("over", {0.026, 0.028, -overlap})[2]);
  });
  EXPECT_LE(deepest, 1.2 * overlap);  // of the middles of both faces, which bend
  EXPECT_GT(pressed.velocity("over")[2], -0.5);
  expect_conserved(pressed);
}

TEST(InitialOverlap, RefusedNamesBothBodies) {
  try {
    ContactRun run(overlapping(InitialOverlaps::refuse));
    FAIL() << "it ran";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("under"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("over"), std::string::npos) << e.what();
  }
}

TEST(InitialOverlap, NoneIsNotRefused) {
  ContactScene s = overlapping(InitialOverlaps::refuse);
  const std::size_t under = 6 * 6 * 3;
  for (std::size_t n = under; n < s.mesh.coordinates.size(); ++n) s.mesh.coordinates[n][2] += overlap;
  ContactRun run(s);
  run.run(1e-5);
  EXPECT_EQ(run.row("kinetic_energy"), 0);
}

}  // namespace
}  // namespace tenon::testing

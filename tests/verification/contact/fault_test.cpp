// SPDX-License-Identifier: BSD-3-Clause
// What contact must survive or refuse, on any number of ranks, and never hang: coincident faces, a body inside another,
// degenerate faces, faces larger than the box of a rank, everything in one rank's box, one face per rank.
#include "contact_case.hpp"

namespace tenon::testing {
namespace {

MaterialDescription solid() {
  return elastic_material(1e9, 0.3, 1000);
}

/// Runs some steps; true if it ran, false if it was refused with a message. Any other end fails the test.
bool runs(const ContactScene& scene, int steps) {
  try {
    ContactRun run(scene);
    for (int s = 0; s < steps && !run.done(); ++s) run.step();
    for (const Vec3& x : run.body().current_coordinates())
      for (const double c : x) EXPECT_TRUE(std::isfinite(c));
    expect_conserved(run, false);
    return true;
  } catch (const Error& e) {
    EXPECT_FALSE(std::string(e.what()).empty());
    return false;
  }
}

TEST(ContactFaults, CoincidentFaces) {
  // The same cube twice in the same place: every face is there twice.
  ContactScene s;
  const MeshData cube = brick({0, 0, 0}, {0.02, 0.02, 0.02}, {2, 2, 2});
  s.mesh = beside({{"one", cube}, {"two", cube}});
  s.mechanics.blocks = {of_material("one", solid()), of_material("two", solid())};
  EXPECT_FALSE(runs(s, 20));
}

TEST(ContactFaults, FacesThatTouchExactly) {
  ContactScene s;
  s.mesh = beside({{"one", brick({0, 0, 0}, {0.02, 0.02, 0.02}, {2, 2, 2})},
                   {"two", brick({0, 0, 0.02}, {0.02, 0.02, 0.04}, {2, 2, 2})}});
  s.mechanics.blocks = {of_material("one", solid()), of_material("two", solid())};
  s.contact.initial_overlaps = ContactOptions::InitialOverlaps::refuse;
  s.mechanics.initial_velocities = {moving("one", {0, 0, 1})};
  EXPECT_TRUE(runs(s, 50));
}

TEST(ContactFaults, ABodyInsideAnother) {
  ContactScene s;
  s.mesh = beside({{"large", brick({0, 0, 0}, {0.1, 0.1, 0.1}, {4, 4, 4})},
                   {"small", brick({0.045, 0.045, 0.045}, {0.055, 0.055, 0.055}, {2, 2, 2})}});
  s.mechanics.blocks = {of_material("large", solid()), of_material("small", solid())};
  s.mechanics.initial_velocities = {moving("small", {1, 0, 0})};
  EXPECT_FALSE(runs(s, 50));
}

TEST(ContactFaults, ABodyInTheHollowOfAnother) {
  ContactScene s;
  AnnulusShape ring;
  ring.inner_radius = 0.02, ring.outer_radius = 0.03, ring.length = 0.02;
  ring.radial = 2, ring.circumferential = 24, ring.axial = 4;
  s.mesh =
      beside({{"ring", generate(ring)}, {"cube", brick({-0.005, -0.005, 0.005}, {0.005, 0.005, 0.015}, {2, 2, 2})}});
  s.mechanics.blocks = {of_material("ring", solid()), of_material("cube", solid())};
  s.mechanics.initial_velocities = {moving("cube", {100, 30, 0})};
  ContactRun run(s);
  run.run(1e-3);
  const Vec3 cube = run.centre("cube"), ring_centre = run.centre("ring");
  EXPECT_LE(std::hypot(cube[0] - ring_centre[0], cube[1] - ring_centre[1]), 0.02);  // it never left
  expect_conserved(run);
}

TEST(ContactFaults, DegenerateFaces) {
  // Hexahedra with an edge collapsed to (nearly) a point: needles and triangles as quadrilaterals.
  ContactScene s;
  MeshData wedge = brick({0, 0, 0.001}, {0.02, 0.02, 0.021}, {2, 2, 2});
  for (Vec3& x : wedge.coordinates) x[1] = 0.01 + (x[1] - 0.01) * (x[0] < 1e-9 ? 1e-7 : 1);
  s.mesh = beside({{"plate", brick({-0.02, -0.02, -0.01}, {0.04, 0.04, 0}, {3, 3, 1})}, {"wedge", wedge}});
  s.mechanics.blocks = {of_material("plate", solid()), of_material("wedge", solid())};
  s.mechanics.initial_velocities = {moving("wedge", {0, 0, -10})};
  s.mechanics.time_step.fixed = 1e-7;
  runs(s, 200);
}

TEST(ContactFaults, FacesLargerThanTheBoxOfARank) {
  // One face of a metre under a hundred faces of a centimetre.
  ContactScene s;
  s.mesh = beside({{"floor", brick({-0.5, -0.5, -0.2}, {0.5, 0.5, 0}, {1, 1, 1})},
                   {"mat", brick({-0.05, -0.05, 1e-4}, {0.05, 0.05, 0.02}, {10, 10, 2})}});
  s.mechanics.blocks = {of_material("floor", solid()), of_material("mat", solid())};
  s.mechanics.initial_velocities = {moving("mat", {0, 0, -10})};
  s.end = 3e-4;
  ContactRun run(s);
  run.run(s.end);
  EXPECT_GT(run.velocity("mat")[2], 0);
  EXPECT_GE(run.reach("mat", {0, 0, 1}, -1), -1e-3);
  expect_conserved(run);
}

TEST(ContactFaults, EverythingInOneRanksBox) {
  // Two cubes that touch, and two far away from everything, so that every cut but one is through nothing.
  ContactScene s;
  s.mesh = beside({{"a", brick({0, 0, 0}, {0.01, 0.01, 0.01}, {3, 3, 3})},
                   {"b", brick({0, 0, 0.0101}, {0.01, 0.01, 0.0201}, {3, 3, 3})},
                   {"far", brick({1000, 0, 0}, {1000.01, 0.01, 0.01}, {1, 1, 1})},
                   {"away", brick({-1000, 500, 0}, {-999.99, 500.01, 0.01}, {1, 1, 1})}});
  for (const char* name : {"a", "b", "far", "away"}) s.mechanics.blocks.push_back(of_material(name, solid()));
  s.mechanics.initial_velocities = {moving("b", {0, 0, -10})};
  s.end = 1e-4;
  ContactRun run(s);
  run.run(s.end);
  EXPECT_GT(run.velocity("b")[2], run.velocity("a")[2]);
  EXPECT_LE(run.momentum_residual(), 1e-13);
}

TEST(ContactFaults, OneFacePerRank) {
  // As many shells as ranks, one above the other: each rank owns one face, and all of them hit.
  const int ranks = communicator().size();
  std::vector<std::pair<std::string, MeshData>> shells;
  ContactScene s;
  for (int r = 0; r < ranks + 1; ++r) {
    PlateShape plate;
    plate.length_x = plate.length_y = 0.01;
    const std::string name = "shell" + std::to_string(r);
    shells.push_back({name, placed(generate(plate), shifted({1e-3 * (r % 2), 1.7e-3 * (r % 3), 1.5e-3 * r}))});
    s.mechanics.blocks.push_back(of_material(name, solid()));
    s.mechanics.blocks.back().shell.thickness = 1e-3;
    s.mechanics.initial_velocities.push_back(moving(name, {0, 0, -5.0 * r}));
  }
  s.mesh = beside(std::move(shells));
  s.end = 2e-3;
  ContactRun run(s);
  run.run(s.end);
  for (int r = 0; r < ranks; ++r)
    EXPECT_GT(run.velocity("shell" + std::to_string(r + 1))[2], run.velocity("shell" + std::to_string(r))[2]) << r;
  expect_conserved(run);
}

}  // namespace
}  // namespace tenon::testing

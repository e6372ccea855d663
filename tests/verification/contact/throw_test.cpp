// SPDX-License-Identifier: BSD-3-Clause
// Contact itself throws a light sheet farther than its skin in a single step: what stands in its way there, which no
// search has found, is hit all the same.
#include "contact_case.hpp"

namespace tenon::testing {
namespace {

constexpr double stand_off = 11.5e-3;  // m, of the second sheet: beyond both skins (5 mm), within a step of the striker

MeshData sheet(double z) {
  PlateShape plate;
  plate.length_x = plate.length_y = 0.03, plate.elements_x = plate.elements_y = 3;
  return placed(generate(plate), shifted({0, 0, z}));
}

/// A heavy block at 1000 m/s, 15 mm a step, under two sheets of a thousandth of its mass. Most nodes stand far away.
ContactScene sheets_over_a_striker() {
  ContactScene s;
  s.mesh = beside({{"striker", brick({-0.01, -0.01, -0.042}, {0.04, 0.04, -0.002}, {3, 3, 2})},
                   {"near", sheet(0)},
                   {"far", sheet(stand_off)},
                   {"crowd", brick({1, 1, 1}, {1.08, 1.08, 1.08}, {8, 8, 8})}});
  s.mechanics.blocks = {
      of_material("striker", elastic_material(1e10, 0.3, 1e5)), of_material("near", elastic_material(1e8, 0.3, 1000)),
      of_material("far", elastic_material(1e8, 0.3, 1000)), of_material("crowd", elastic_material(1e8, 0.3, 1000))};
  for (std::size_t b : {1, 2}) s.mechanics.blocks[b].shell.thickness = 1e-3;
  s.mechanics.initial_velocities = {moving("striker", {0, 0, 1000})};
  s.mechanics.time_step.fixed = 1.5e-5;
  s.end = 1.2e-4;
  return s;
}

TEST(Throw, WhatIsThrownBeyondItsSkinMeetsWhatIsInItsWay) {
  ContactRun run(sheets_over_a_striker());
  double least = 1;
  bool hit = false;
  for (int step = 0; step < 2; ++step) {
    run.step();
    least = std::min(least, run.reach("far", {0, 0, 1}, -1) - run.reach("near", {0, 0, 1}, 1));
    hit = hit || run.velocity("far")[2] > 100;
  }
  EXPECT_TRUE(hit);
  EXPECT_GT(least, 0.9e-3);  // of their middle surfaces; both are 1 mm thick
  expect_conserved(run, false);
}

TEST(Throw, TheSameBitsHoweverOftenItSearches) {
  ContactScene s = sheets_over_a_striker();
  ContactRun run(s);
  s.contact.always_search = true;
  ContactRun always(s);
  for (int step = 0; step < 6; ++step) {
    run.step(), always.step();
    expect_same_bits(in_global_order(run.body(), "velocity"), in_global_order(always.body(), "velocity"), "velocity");
  }
}

}  // namespace
}  // namespace tenon::testing

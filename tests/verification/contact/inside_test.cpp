// SPDX-License-Identifier: BSD-3-Clause
// Bodies that are inside each other, or coincide, before the first step: refused with both their names, on any number
// of ranks, unless overlaps are kept or the two are not to touch.
#include "contact_case.hpp"

namespace tenon::testing {
namespace {

using InitialOverlaps = ContactOptions::InitialOverlaps;

ContactScene of_two(MeshData one, MeshData two, double thickness = 0) {
  ContactScene s;
  s.mesh = beside({{"one", std::move(one)}, {"two", std::move(two)}});
  for (const char* name : {"one", "two"}) {
    s.mechanics.blocks.push_back(of_material(name, elastic_material(1e9, 0.3, 1000)));
    s.mechanics.blocks.back().shell.thickness = thickness;
  }
  s.end = 1e-5;
  return s;
}

void expect_refused(ContactScene scene) {
  for (const InitialOverlaps choice : {InitialOverlaps::remove, InitialOverlaps::refuse}) {
    scene.contact.initial_overlaps = choice;
    try {
      ContactRun run(scene);
      ADD_FAILURE() << "it ran";
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ExitCode::geometry);
      EXPECT_NE(std::string(e.what()).find("one and two"), std::string::npos) << e.what();
    }
  }
}

/// It runs, and nothing moves.
void expect_at_rest(const ContactScene& scene) {
  ContactRun run(scene);
  run.run(scene.end);
  EXPECT_EQ(run.row("kinetic_energy"), 0);
}

MeshData cube(const Vec3& low, double size, int elements) {
  return brick(low, low + Vec3{size, size, size}, {elements, elements, elements});
}

MeshData sheet(double x, double z) {
  PlateShape plate;
  plate.length_x = plate.length_y = 0.02, plate.elements_x = plate.elements_y = 2;
  return placed(generate(plate), shifted({x, 0, z}));
}

TEST(Inside, TheSameBodyTwiceIsRefused) {
  ContactScene s = of_two(cube({0, 0, 0}, 0.02, 2), cube({0, 0, 0}, 0.02, 2));
  expect_refused(s);
  s.contact.pairs = {{"one", "two", true, {}}};
  expect_at_rest(s);
}

TEST(Inside, TheSamePlaceByOtherElementsIsRefused) {
  expect_refused(of_two(cube({0, 0, 0}, 0.02, 2), cube({0, 0, 0}, 0.02, 3)));
}

TEST(Inside, ASmallBodyWithinALargeOneIsRefused) {
  const ContactScene s = of_two(cube({0, 0, 0}, 0.1, 4), cube({0.045, 0.045, 0.045}, 0.01, 2));
  expect_refused(s);
}

TEST(Inside, ABodyWithinOneElementIsRefused) {
  expect_refused(of_two(cube({0, 0, 0}, 0.1, 1), cube({0.04, 0.05, 0.045}, 0.01, 1)));
}

TEST(Inside, ADeepOverlapIsRefused) {
  // By one and a half elements: the surfaces of the one are nearer to the far sides of the other's elements.
  expect_refused(of_two(cube({0, 0, 0}, 0.04, 4), cube({0.003, 0.004, 0.025}, 0.04, 4)));
}

TEST(Inside, AShellWithinASolidIsRefused) {
  expect_refused(of_two(placed(cube({0, 0, 0}, 0.1, 3), shifted({-0.04, -0.04, -0.045})), sheet(0, 0), 1e-3));
}

TEST(Inside, CoincidentShellsAreRefused) {
  expect_refused(of_two(sheet(0, 0), sheet(0, 0), 1e-3));
}

TEST(Inside, WhatOnlyTouchesIsNot) {
  expect_at_rest(of_two(cube({0, 0, 0}, 0.02, 2), cube({0, 0, 0.02}, 0.02, 2)));
  expect_at_rest(of_two(cube({0, 0, 0}, 0.02, 2), cube({0.02, 0.005, 0.02}, 0.02, 3)));
  expect_at_rest(of_two(sheet(0, 0), sheet(0.02, 0), 1e-3));
  expect_at_rest(of_two(sheet(0, 0), sheet(0.003, 1e-3), 1e-3));
}

}  // namespace
}  // namespace tenon::testing

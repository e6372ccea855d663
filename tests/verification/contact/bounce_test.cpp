// SPDX-License-Identifier: BSD-3-Clause
// Of case C07: what a cube gains in a hit of its face on a rigid plate is the impulse that it was given.
#include "contact_case.hpp"

namespace tenon::testing {
namespace {

TEST(Bounce, MomentumIsTheImpulse) {
  // Without gravity the whole change of momentum is the impulse of contact.
  ContactScene s;
  s.mesh = beside({{"cube", brick({-0.05, -0.05, 0.001}, {0.05, 0.05, 0.101}, {4, 4, 4})}});
  s.mechanics.blocks = {of_material("cube", elastic_material(10e6, 0.3, 1000))};
  s.mechanics.initial_velocities = {moving("cube", {0, 0, -3.13209})};
  s.contact.rigid_surfaces = {rigid_plane("plate", {0, 0, 0}, {0, 0, 1})};
  s.end = 0.02;
  ContactRun run(s);
  const Vec3 start = run.momentum();
  run.run(s.end);
  const double gained = run.momentum()[2] - start[2], given = run.impulse("cube_plate")[2];
  std::printf("C07 flat hit: %.6f kg m/s, impulse %.6f N s\n", gained, given);
  EXPECT_GT(gained, 5);
  EXPECT_NEAR(gained, std::abs(given), 1e-6 * gained);
}

}  // namespace
}  // namespace tenon::testing

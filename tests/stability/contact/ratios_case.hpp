// SPDX-License-Identifier: BSD-3-Clause
// Two blocks that hit each other at given ratios of stiffness, density and mesh, with the defaults of contact: energy
// is bounded, nothing penetrates, they part.
#pragma once

#include "depth.hpp"

namespace tenon::testing {

struct Ratios {
  double stiffness = 1;     // of the lower block to the upper one
  int under = 2, over = 2;  // elements along an edge of each block
  double density = 1;       // of the lower block to the upper one
};

inline void hit(const Ratios& r) {
  constexpr double side = 0.1, speed = 2, soft = 1e7;
  ContactScene s;
  // The upper block stands askew over the lower one, whose face is larger.
  const MeshData upper = placed(placed(brick({-side / 2, -side / 2, 0}, {side / 2, side / 2, side / 2},
                                             {r.over, r.over, std::max(1, r.over / 2)}),
                                       rotated({0, 0, 1}, 0.4)),
                                shifted({0.003, 0.007, 1e-3}));
  s.mesh = beside(
      {{"under", brick({-0.08, -0.08, -side / 2}, {0.08, 0.08, 0}, {r.under, r.under, std::max(1, r.under / 2)})},
       {"over", upper}});
  s.mechanics.blocks = {of_material("under", elastic_material(soft * std::max(1.0, r.stiffness), 0.3,
                                                              1000 / std::max(1.0, 1 / r.density))),
                        of_material("over", elastic_material(soft * std::max(1.0, 1 / r.stiffness), 0.3,
                                                             1000 / std::max(1.0, r.density)))};
  s.mechanics.initial_velocities = {moving("over", {0.3, 0.1, -speed})};
  const double wave = std::sqrt(soft / 1000);
  s.end = 1e-3 / speed + 4 * side / wave;
  ContactRun run(s);
  const double kinetic = run.row("kinetic_energy");
  const double element = std::min(0.16 / r.under, side / r.over);
  double deepest = -1e300, gained = 0;
  run.run(s.end, [&] {
    gained = std::max(gained, (run.row("kinetic_energy") + run.row("internal_energy") + run.row("hourglass_energy") +
                               run.row("viscosity_energy") + run.row("contact_energy")) /
                                      kinetic -
                                  1);
    if (run.simulation().steps() % 7 != 0) return;
    deepest =
        std::max(deepest, depth_below(nodes_of(run.body(), "over_z_min"), triangles_of(run.body(), "under_z_max")));
  });
  const double parting = run.velocity("over")[2] - run.velocity("under")[2];
  std::printf(
      "stiffness %g, elements %d under %d, density %g: parting at %.3f of %.1f m/s, gained %.1e, deepest %.1e of an "
      "element, contact took %.1e; %lld steps\n",
      r.stiffness, r.under, r.over, r.density, parting, speed, gained, deepest / element,
      run.row("contact_dissipation") / kinetic, static_cast<long long>(run.simulation().steps()));
  EXPECT_GT(parting, 0);
  EXPECT_LE(gained, 1e-3);
  EXPECT_LE(deepest, 1e-2 * element);
  expect_conserved(run);
}

}  // namespace tenon::testing

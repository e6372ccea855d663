// SPDX-License-Identifier: BSD-3-Clause
// Case C08: two crossed bars, each rolled by 45 degrees, meet edge against edge.
#include "contact_case.hpp"

namespace tenon::testing {
namespace {

void cross_bars(int along) {
  constexpr double side = 0.01, length = 0.1, gap = 1e-4, closing = 10;
  const double half = side / std::sqrt(2.0), quarter_turn = std::numbers::pi / 4, element = length / along;
  const MeshData bar =
      placed(brick({-length / 2, -side / 2, -side / 2}, {length / 2, side / 2, side / 2}, {along, 4, 4}),
             rotated({1, 0, 0}, quarter_turn));
  ContactScene s;
  s.mesh = beside(
      {{"under", placed(bar, shifted({0, 0, -half - 0.5 * gap}))},
       {"over", placed(placed(bar, rotated({0, 0, 1}, std::numbers::pi / 2)), shifted({0, 0, half + 0.5 * gap}))}});
  const MaterialDescription m = elastic_material(10e9, 0.3, 1000);
  s.mechanics.blocks = {of_material("under", m), of_material("over", m)};
  s.mechanics.hourglass.form = HourglassOptions::Form::stiffness;
  s.mechanics.initial_velocities = {moving("under", {0, 0, 0.5 * closing}), moving("over", {0, 0, -0.5 * closing})};
  s.end = 1.5e-3;
  ContactRun run(s);
  // Where the edges cross: the middle of each, between its two middle nodes (or at the middle node).
  const double x = along % 2 == 0 ? 0 : 0.5 * element;
  const auto distance = [&] {
    const Vec3 low = 0.5 * (run.now_at("under", {-x, 0, -0.5 * gap}) + run.now_at("under", {x, 0, -0.5 * gap}));
    const Vec3 high = 0.5 * (run.now_at("over", {0, -x, 0.5 * gap}) + run.now_at("over", {0, x, 0.5 * gap}));
    return high[2] - low[2];
  };
  const double kinetic = run.row("kinetic_energy");
  double deepest = distance();
  run.run(s.end, [&] { deepest = std::min(deepest, distance()); });
  const double parting = run.velocity("over")[2] - run.velocity("under")[2];
  std::printf(
      "C08 %d elements: parting at %.4f m/s, deepest %.2e of an element, contact took %.2e, viscosity %.2e of "
      "the kinetic energy\n",
      along, parting, -deepest / element, run.row("contact_dissipation") / kinetic,
      run.row("viscosity_energy") / kinetic);
  EXPECT_GT(parting, 0);
  EXPECT_GE(deepest, -0.05 * element);
  EXPECT_LE(std::abs(run.row("contact_dissipation")), 0.01 * kinetic);
  EXPECT_LE(std::abs(run.row("contact_energy")), 0.01 * kinetic);
  expect_conserved(run);
}

TEST(EdgeToEdge, EdgesMeetBetweenNodes) {
  cross_bars(41);
}

TEST(EdgeToEdge, EdgesMeetAtNodes) {
  cross_bars(40);
}

}  // namespace
}  // namespace tenon::testing

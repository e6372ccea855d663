// SPDX-License-Identifier: BSD-3-Clause
// Stresses of bodies that conduction warms through a transfer: constrained bars (case F02) and a bimetal strip of
// shells (F03).
#include "thermal_stress_case.hpp"

namespace tenon::testing::thermal_stress {
namespace {

struct Bar {
  double stress, elongation;
};

/// 100 x 20 x 20 mm of steel, warmed by 100 K in 20 ms; held along as many axes as asked for.
Bar warmed_bar(int axes_held, const BoxShape& thermal_shape) {
  const BoxShape shape = box({0, 0, 0}, {0.1, 0.02, 0.02}, {5, 2, 2});
  MechanicsOptions o;
  o.hourglass.form = Form::physical;
  const char* const sets[3][2] = {{"x_min", "x_max"}, {"y_min", "y_max"}, {"z_min", "z_max"}};
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 normal{};
    normal[static_cast<std::size_t>(axis)] = 1;
    for (int end = 0; end < (axis < axes_held ? 2 : 1); ++end) o.motions.push_back(symmetry(sets[axis][end], normal));
  }
  constexpr double ramp = 0.02;
  o.loads.relaxation = RelaxationOptions{1e-6, ramp};
  const auto simulation = run(warmed(shared_mesh(on_root(thermal_shape)), 100, ramp, 4e-5),
                              body(shared_mesh(on_root(shape)), metal(210e9, 0.3, 12e-6), o), 2 * ramp);
  Mechanics& b = solid_of(*simulation);
  EXPECT_TRUE(b.finished()) << b.ending();
  // Held along all axes, the bar does no work but round-off, and a ledger has nothing to be measured by.
  if (axes_held < 3) {
    EXPECT_LT(simulation->ledger().take().error, 1e-11);
  }
  const std::vector<double> stress = in_global_order(b, "stress"), u = in_global_order(b, "displacement");
  Bar bar{0, 0};
  if (communicator().rank() == 0) {
    for (std::size_t e = 0; 6 * e < stress.size(); ++e)
      for (int c = 0; c < axes_held; ++c) EXPECT_NEAR(stress[6 * e], stress[6 * e + std::size_t(c)], 1e-3 * 252e6);
    bar.stress = stress[0];
    for (std::size_t n = 0; 3 * n < u.size(); ++n) bar.elongation = std::max(bar.elongation, u[3 * n]);
  }
  ExactSum stress_of_root;
  stress_of_root.add(bar.stress);
  bar.stress = communicator().sum(stress_of_root), bar.elongation = communicator().max(bar.elongation);
  return bar;
}

TEST(ThermalStress, ConstrainedBars) {
  const BoxShape same = box({0, 0, 0}, {0.1, 0.02, 0.02}, {5, 2, 2});
  BoxShape other = box({0, 0, 0}, {0.1, 0.02, 0.02}, {4, 3, 1});
  other.tetrahedra = true;
  const double expected[4] = {0, -252e6, -360e6, -630e6};
  for (int axes = 1; axes <= 3; ++axes) {
    const Bar bar = warmed_bar(axes, axes == 2 ? other : same);
    std::printf("F02 held along %d axes: %.3f MPa\n", axes, bar.stress / 1e6);
    EXPECT_NEAR(bar.stress, expected[axes], 1e-3 * std::abs(expected[axes])) << axes;
  }
  const Bar free = warmed_bar(0, same);
  std::printf("F02 free: %.6g of the length\n", free.elongation / 0.1);
  EXPECT_NEAR(free.elongation, 1.2e-3 * 0.1, 1e-3 * 1.2e-4);
}

TEST(Bimetal, Shells) {
  expect_tip("shells", shells(20), 0.01);
}

}  // namespace
}  // namespace tenon::testing::thermal_stress

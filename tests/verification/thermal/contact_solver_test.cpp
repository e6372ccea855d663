// SPDX-License-Identifier: BSD-3-Clause
// Iterations that the linear solution takes where bodies exchange heat, over the conductance and the size of the mesh.
#include <gtest/gtest.h>

#include "thermal_contact_case.hpp"

namespace tenon::testing {
namespace {

/// Two cubes that touch; heat enters unevenly, so that temperatures vary along the surface.
thermal::SolveReport solution(double h, int n, int m, ThermalPreconditioner preconditioner) {
  BoxShape a, b;
  a.elements = {n, n, n}, b.elements = {m, m, m};
  b.low = {1, 0, 0}, b.high = {2, 1, 1};
  ThermalOptions options = two_bars(ThermalStepper::steady, 50, 20);
  options.tolerance = 1e-10;
  options.preconditioner = preconditioner;
  options.prescribed = {{"a_x_min", TimeFunction::constant(100)}};
  options.convection = {{"b_y_max", 20, TimeFunction::constant(0)}};
  options.fluxes = {{"a_z_max", TimeFunction::constant(1e3)}};
  options.contacts = {contact_of_ends(h)};
  Thermal thermal("heat", distributed_pair(a, b), options);
  thermal.initialize();
  thermal.advance(1);
  EXPECT_LT(balance(thermal).error(), 1e-9);
  return thermal.last_solve();
}

// Neither the conductance, from next to none to a hundred thousand times that of the elements, nor the size of the mesh
// matters much.
TEST(ContactSolver, MultigridTakesFewIterations) {
  for (const auto& [n, m, most] : {std::tuple{6, 6, 13}, {5, 7, 18}, {10, 14, 22}})
    for (const double h : {0.1, 10.0, 1e3, 1e5, 1e7, 1e9}) {
      const auto report = solution(h, n, m, ThermalPreconditioner::multigrid);
      std::printf("%d | %d, h %g: %d iterations\n", n, m, h, report.iterations);
      EXPECT_LE(report.iterations, most) << n << " | " << m << ", h " << h;
    }
}

TEST(ContactSolver, TheDiagonalAloneConverges) {
  EXPECT_LT(solution(1e7, 5, 7, ThermalPreconditioner::jacobi).iterations, 500);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Manufactured solution T = e^-t sin x sin 2y sin 3z with its source, on distorted meshes: second order in the L2 norm.
#include <gtest/gtest.h>

#include <numbers>

#include "thermal_case.hpp"

namespace tenon::testing {
namespace {

double exact(const Vec3& x, double t) {
  return std::exp(-t) * std::sin(x[0]) * std::sin(2 * x[1]) * std::sin(3 * x[2]);
}

double l2_error(int n, bool tetrahedra) {
  constexpr double pi = std::numbers::pi, end = 0.2;
  BoxShape shape = cube(n, tetrahedra, 0.15);
  shape.high = {pi, pi / 2, pi / 3};  // where the solution vanishes
  ThermalOptions options;
  options.blocks = {material(1, 1)};
  options.stepper = ThermalStepper::crank_nicolson;
  options.fixed_step = end / (2 * n);
  options.initial_function = [](const Vec3& x) { return exact(x, 0); };
  options.source_function = [](const Vec3& x, double t) { return 13 * exact(x, t); };  // -1 + 1 + 4 + 9
  for (const char* set : {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"})
    options.prescribed.push_back({set, TimeFunction::constant(0)});
  Thermal thermal("heat", distributed(shape), options);
  thermal.initialize();
  run_until(thermal, end);
  const Mesh& mesh = thermal.mesh();
  ExactSum error, size;
  for (const LocalIndex owned : mesh.owned_nodes) {
    const auto node = static_cast<std::size_t>(owned);
    const double t = exact(mesh.coordinates[node], end), d = thermal.temperature()[node] - t;
    error.add(d * d), size.add(t * t);
  }
  return std::sqrt(mesh.comm.sum(error) / mesh.comm.sum(size));
}

TEST(ManufacturedSolution, IsOfSecondOrder) {
  for (const bool tetrahedra : {false, true}) {
    const double coarse = l2_error(8, tetrahedra), fine = l2_error(16, tetrahedra);
    EXPECT_LT(fine, 0.03) << tetrahedra;
    EXPECT_GT(std::log2(coarse / fine), 1.7) << tetrahedra;
  }
}

}  // namespace
}  // namespace tenon::testing

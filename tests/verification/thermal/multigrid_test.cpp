// SPDX-License-Identifier: BSD-3-Clause
// The multigrid preconditioner: iterations that do not grow with the mesh, symmetry, and when it is chosen.
#include <gtest/gtest.h>

#include "components/thermal/conjugate_gradient.hpp"
#include "thermal_case.hpp"

namespace tenon::testing {
namespace {

/// Iterations of one steady solution; multigrid, to 1e-10.
std::int64_t iterations(const std::shared_ptr<const Mesh>& mesh, const std::string& block, const char* held,
                        ThermalPreconditioner preconditioner = ThermalPreconditioner::multigrid) {
  ThermalOptions options;
  options.blocks = {{block, 1, 1, 1, 0}};
  options.stepper = ThermalStepper::steady;
  options.preconditioner = preconditioner;
  options.tolerance = 1e-10;
  options.prescribed = {{held, TimeFunction::constant(1)}};
  options.source_function = [](const Vec3& x, double) { return std::sin(9 * x[0]) * std::cos(5 * x[1] * x[2]); };
  Thermal thermal("heat", mesh, options);
  thermal.initialize();
  thermal.advance(1);
  EXPECT_LT(balance(thermal).error(), 1e-11);
  return thermal.last_solve().iterations;
}

class Boxes : public ::testing::TestWithParam<std::tuple<bool, double>> {};

TEST_P(Boxes, IterationsDoNotGrowWithTheMesh) {
  const auto [tetrahedra, distortion] = GetParam();
  std::vector<std::int64_t> counts;
  for (const int n : {8, 16, tetrahedra ? 24 : 48})
    counts.push_back(iterations(distributed(cube(n, tetrahedra, distortion)), "box", "x_min"));
  EXPECT_LE(counts.back(), counts.front() + 3) << counts[0] << " " << counts[1] << " " << counts[2];
  EXPECT_LE(counts.back(), 14);
  RecordProperty("iterations", static_cast<int>(counts.back()));
}

INSTANTIATE_TEST_SUITE_P(Multigrid, Boxes, ::testing::Combine(::testing::Bool(), ::testing::Values(0.0, 0.2)));

TEST(Multigrid, GradedBoxAndFlatElements) {
  BoxShape graded = cube(16);
  graded.grading = {20, 1, 0.1};
  EXPECT_LE(iterations(distributed(graded), "box", "x_min"), 40);
  BoxShape flat = cube(16);
  flat.high = {1, 1, 0.05};
  EXPECT_LE(iterations(distributed(flat), "box", "x_min"), 30);
}

TEST(Multigrid, AnnulusOfTetrahedra) {
  std::vector<std::int64_t> counts;
  for (const int f : {1, 2}) {
    AnnulusShape shape;
    shape.radial *= f, shape.circumferential *= f, shape.axial *= f;
    shape.tetrahedra = true;
    MeshData data;
    if (communicator().rank() == 0) data = generate(shape);
    counts.push_back(iterations(distribute(communicator(), std::move(data), {}), "annulus", "inner"));
  }
  EXPECT_LE(counts[1], counts[0] + 4) << counts[0] << " " << counts[1];
  EXPECT_LE(counts[1], 22);
}

/// A cube of n^3 x 6 tetrahedra, an uneven part in the middle of which is a block of its own.
MeshData two_blocks(int n) {
  MeshData data = generate(cube(n, true));
  data.side_sets.clear();  // they count elements in the old order
  BlockData whole = data.blocks.front();
  BlockData box = whole, core = whole;
  core.name = "core", core.label = whole.label + 1;
  for (BlockData* b : {&box, &core}) b->connectivity.clear(), b->labels.clear();
  for (std::size_t e = 0; e < whole.size(); ++e) {
    Vec3 centre{};
    for (std::size_t a = 0; a < 4; ++a)
      centre = centre + 0.25 * data.coordinates[static_cast<std::size_t>(whole.connectivity[4 * e + a])];
    const bool inside = centre[0] > 0.25 && centre[0] < 0.75 && centre[1] > 0.3 && centre[2] < 0.6;
    BlockData& mine = inside ? core : box;
    mine.labels.push_back(whole.labels[e]);
    for (std::size_t a = 0; a < 4; ++a) mine.connectivity.push_back(whole.connectivity[4 * e + a]);
  }
  data.blocks = {box, core};
  return data;
}

TEST(Multigrid, ContrastOfAThousand) {
  std::vector<std::int64_t> counts;
  for (const int n : {8, 16}) {
    MeshData data;
    if (communicator().rank() == 0) data = two_blocks(n);
    ThermalOptions options;
    options.blocks = {{"box", 1, 1, 1, 0}, {"core", 1, 1, 1000, 0}};
    options.stepper = ThermalStepper::steady;
    options.preconditioner = ThermalPreconditioner::multigrid;
    options.tolerance = 1e-10;
    options.prescribed = {{"x_min", TimeFunction::constant(1)}, {"x_max", TimeFunction::constant(0)}};
    Thermal thermal("heat", distribute(communicator(), std::move(data), {}), options);
    thermal.initialize();
    thermal.advance(1);
    counts.push_back(thermal.last_solve().iterations);
  }
  EXPECT_LE(counts[1], counts[0] + 8) << counts[0] << " " << counts[1];
  EXPECT_LE(counts[1], 30);
}

TEST(Multigrid, DiagonalNeedsManyMore) {
  EXPECT_GT(iterations(distributed(cube(16, true)), "box", "x_min", ThermalPreconditioner::jacobi), 70);
}

TEST(Multigrid, AutomaticChoiceFollowsTheStep) {
  for (const bool long_step : {false, true}) {
    ThermalOptions options = all_loads(ThermalStepper::backward_euler);
    options.fixed_step = long_step ? 1e5 : 1;
    Thermal thermal("heat", distributed(cube(12, true)), options);
    thermal.initialize();
    for (int i = 0; i < 3; ++i) thermal.advance(*options.fixed_step);
    EXPECT_EQ(thermal.uses_multigrid(), long_step);
    EXPECT_LT(balance(thermal).error(), 1e-13);
  }
}

/// (x, M y) - (y, M x) beside (x, M x), and the sign of that, for vectors that know no symmetry.
TEST(Multigrid, IsSymmetricAndPositive) {
  const auto mesh = distributed(cube(9, true, 0.2));
  thermal::ConductionMatrix matrix(*mesh, {thermal::Conductivity(1.0)});
  matrix.assemble(mesh->coordinates, {});
  matrix.finish();
  const std::size_t rows = mesh->owned_nodes.size();
  std::vector<double> diagonal(rows), inverse(rows), x(rows), y(rows);
  for (std::size_t k = 0; k < rows; ++k) {
    const auto n = static_cast<std::size_t>(mesh->owned_nodes[k]);
    const auto id = static_cast<double>(mesh->node_ids[n]);
    diagonal[k] = 1e-3 + matrix.diagonal()[k];
    inverse[k] = mesh->coordinates[n][0] > 0 ? 1 / diagonal[k] : 0;
    x[k] = inverse[k] > 0 ? std::sin(id * id) : 0, y[k] = inverse[k] > 0 ? std::cos(3 * id) : 0;
  }
  const thermal::HeatSystem system{matrix, 1.0, diagonal, inverse};
  thermal::Multigrid multigrid(*mesh);
  multigrid.build(system);
  const auto apply = [&](const std::vector<double>& r) {
    std::vector<double> z(static_cast<std::size_t>(mesh->nodes()), 0.0);
    multigrid.apply(system, r, z);
    return z;
  };
  const auto product = [&](const std::vector<double>& a, const std::vector<double>& z) {
    ExactSum sum;
    for (std::size_t k = 0; k < rows; ++k) sum.add(a[k] * z[static_cast<std::size_t>(mesh->owned_nodes[k])]);
    return mesh->comm.sum(sum);
  };
  const std::vector<double> mx = apply(x), my = apply(y);
  EXPECT_GT(product(x, mx), 0);
  EXPECT_GT(product(y, my), 0);
  EXPECT_NEAR(product(x, my), product(y, mx), 1e-12 * std::sqrt(product(x, mx) * product(y, my)));
}

}  // namespace
}  // namespace tenon::testing

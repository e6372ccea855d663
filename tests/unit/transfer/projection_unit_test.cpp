// SPDX-License-Identifier: BSD-3-Clause
// The parts of an L2 projection: sparse rows, the mass matrix and its inverse; no allocation in a steady application.
#include <gtest/gtest.h>

#include <cmath>

#include "allocation_counter.hpp"
#include "transfer/element_points.hpp"
#include "transfer/mass_matrix.hpp"
#include "transfer/projection.hpp"
#include "transfer_testing.hpp"

namespace tenon::transfer {
namespace {

using testing::box;
using testing::distributed;

TEST(SparseRows, SumsAreTheSameForAnyNumberOfComponents) {
  SparseRows<double> rows;
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < i; ++k) {
      rows.column.push_back((7 * i + 3 * k) % 31);
      rows.value.push_back(testing::random_number(1, static_cast<std::uint64_t>(100 * i + k)));
    }
    rows.begin.push_back(static_cast<std::int64_t>(rows.column.size()));
  }
  std::vector<double> one(31), single(20);
  for (std::size_t i = 0; i < one.size(); ++i) one[i] = testing::random_number(2, i);
  rows.multiply(one, single, 1);
  for (std::size_t i = 0; i < single.size(); ++i) {
    double sum = 0;
    for (std::size_t k = rows.first(i); k < rows.last(i); ++k)
      sum += rows.value[k] * one[static_cast<std::size_t>(rows.column[k])];
    EXPECT_NEAR(single[i], sum, 1e-14);
  }
  for (const std::size_t components : {2u, 3u, 4u, 6u, 9u}) {
    std::vector<double> many, result(20 * components);
    for (const double v : one) many.insert(many.end(), components, v);
    rows.multiply(many, result, static_cast<int>(components));
    for (std::size_t i = 0; i < result.size(); ++i) EXPECT_EQ(result[i], single[i / components]);
  }
}

struct Matrix {
  explicit Matrix(MeshData data)
      : mesh(distributed(std::move(data))),
        nodes(items_of(*mesh, Location::node)),
        mass({*mesh, mesh->coordinates, Location::node, nodes, nodes}, node_elements(*mesh)) {}
  testing::MeshPointer mesh;
  Items nodes;
  MassMatrix mass;
};

TEST(MassMatrix, RowsAddUpToTheVolumesOfTheNodes) {
  for (MeshData data : {box(4, {.distortion = 0.2}), box(3, {.tetrahedra = true}), testing::mixed_box(3)}) {
    const Matrix m(std::move(data));
    const std::vector<double> volumes = item_volumes(*m.mesh, m.mesh->coordinates, Location::node);
    const std::vector<double> ones(static_cast<std::size_t>(m.mesh->nodes()), 1.0);
    std::vector<double> sums(m.mesh->owned_nodes.size());
    m.mass.rows().multiply(ones, sums, 1);
    for (std::size_t k = 0; k < sums.size(); ++k)
      EXPECT_NEAR(sums[k] / volumes[static_cast<std::size_t>(m.mesh->owned_nodes[k])], 1.0, 1e-6);
  }
}

TEST(MassMatrix, SolveReducesEveryModeAHundredTimesAndKeepsSums) {
  for (MeshData data :
       {box(5, {.distortion = 0.2}), box(4, {.tetrahedra = true, .distortion = 0.2}), testing::mixed_box(4)}) {
    const Matrix m(std::move(data));
    const auto size = static_cast<std::size_t>(m.mesh->nodes());
    std::vector<double> exact(2 * size), right(2 * m.mesh->owned_nodes.size()), solved(2 * size);
    for (std::size_t i = 0; i < size; ++i) {
      const auto id = static_cast<std::uint64_t>(m.mesh->node_ids[i]);
      exact[2 * i] = testing::random_number(3, id) - 0.5;          // all modes
      exact[2 * i + 1] = std::sin(2 * m.mesh->coordinates[i][0]);  // smooth
    }
    m.mass.rows().multiply(exact, right, 2);
    m.mass.solve(right, solved, 2);
    double rough = 0, smooth = 0;
    ExactSum sum, sum_exact;
    const std::vector<double> volumes = item_volumes(*m.mesh, m.mesh->coordinates, Location::node);
    for (const LocalIndex n : m.mesh->owned_nodes) {
      const auto i = static_cast<std::size_t>(n);
      rough = std::max(rough, std::abs(solved[2 * i] - exact[2 * i]));
      smooth = std::max(smooth, std::abs(solved[2 * i + 1] - exact[2 * i + 1]));
      sum.add_product(volumes[i], solved[2 * i]);
      sum_exact.add_product(volumes[i], exact[2 * i]);
    }
    EXPECT_LT(m.mesh->comm.max(rough), 1.5e-2);
    EXPECT_LT(m.mesh->comm.max(smooth), 4e-3);
    EXPECT_NEAR(m.mesh->comm.sum(sum), m.mesh->comm.sum(sum_exact), 1e-7);  // single precision
  }
}

TEST(MassMatrix, IterationsFollowTheKindsOfElements) {
  EXPECT_EQ(Matrix(box(2)).mass.iterations(), 14);
  EXPECT_EQ(Matrix(box(2, {.tetrahedra = true})).mass.iterations(), 6);
}

TEST(Projection, AllocatesNothingWhenSteady) {
  const testing::MeshPointer source = distributed(box(3, {.distortion = 0.2})),
                             target = distributed(box(4, {.distortion = 0.2}), PartitionMethod::graph);
  const Items from = items_of(*source, Location::node), to = items_of(*target, Location::node);
  for (const bool bounded : {false, true}) {
    Sought sought;
    const Projection projection({*source, source->coordinates, Location::node, from, from},
                                {*target, target->coordinates, Location::node, to, to}, {}, {.bounded = bounded},
                                "test", sought);
    std::vector<double> values(3 * from.ids.size(), 1.0), result(3 * to.ids.size());
    for (int repeat = 0; repeat < 2; ++repeat) projection.apply(values, result, 3);
    const std::int64_t before = tenon::testing::allocations();
    for (int repeat = 0; repeat < 5; ++repeat) projection.apply(values, result, 3);
    EXPECT_EQ(tenon::testing::allocations(), before);
    EXPECT_GT(projection.memory(), 0);
  }
}

TEST(Projection, RefusesTargetsOfSecondOrder) {
  MeshData data = box(1);
  BlockData& block = data.blocks.front();
  block.kind = ElementKind::hex20;
  for (const auto& pair : middle_nodes(ElementKind::hex20)) {
    const auto corner = [&](int a) {
      return data.coordinates[static_cast<std::size_t>(block.connectivity[static_cast<std::size_t>(a)])];
    };
    const Vec3 middle = 0.5 * (corner(pair[0]) + corner(pair[1]));
    block.connectivity.push_back(static_cast<GlobalId>(data.coordinates.size()));
    data.coordinates.push_back(middle);
    data.node_labels.push_back(static_cast<std::int64_t>(data.coordinates.size()));
  }
  data.side_sets.clear();
  const testing::MeshPointer source = distributed(box(2)), target = distributed(std::move(data));
  const Items from = items_of(*source, Location::node), to = items_of(*target, Location::node);
  Sought sought;
  try {
    Projection({*source, source->coordinates, Location::node, from, from},
               {*target, target->coordinates, Location::node, to, to}, {}, {}, "heat", sought);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    EXPECT_NE(std::string(error.what()).find("transfer 'heat': block 'box'"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tenon::transfer

// SPDX-License-Identifier: BSD-3-Clause
// hex20 and tet10 as sources: quadratics are exact, linear fields also with curved edges, smooth ones of third order;
// no point of the element's bulges is lost.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "transfer_testing.hpp"

namespace tenon::transfer {
namespace {

using testing::box;
using testing::distributed;
using testing::Pair;

/// A mesh of hex8 or tet4 with middle nodes on its edges.
MeshData of_second_order(MeshData mesh) {
  for (BlockData& block : mesh.blocks) {
    const ElementKind kind = block.kind == ElementKind::hex8 ? ElementKind::hex20 : ElementKind::tet10;
    const auto corners = static_cast<std::size_t>(topology(block.kind).nodes);
    std::map<std::pair<GlobalId, GlobalId>, GlobalId> middles;
    std::vector<GlobalId> connectivity;
    for (std::size_t e = 0; e < block.size(); ++e) {
      const GlobalId* n = &block.connectivity[e * corners];
      connectivity.insert(connectivity.end(), n, n + corners);
      for (const auto& [a, b] : middle_nodes(kind)) {
        const auto next = static_cast<GlobalId>(mesh.coordinates.size());
        const auto [at, fresh] = middles.try_emplace(std::minmax(n[a], n[b]), next);
        connectivity.push_back(at->second);
        if (!fresh) continue;
        mesh.coordinates.push_back(0.5 * (mesh.coordinates[static_cast<std::size_t>(n[a])] +
                                          mesh.coordinates[static_cast<std::size_t>(n[b])]));
        mesh.node_labels.push_back(next + 1);
      }
    }
    block.kind = kind;
    block.connectivity = std::move(connectivity);
  }
  return mesh;
}

/// Bends the unit cube; smooth, its sides too.
MeshData bent(MeshData mesh, double amount) {
  for (Vec3& x : mesh.coordinates)
    x = x + amount * Vec3{std::sin(3 * x[1]), std::sin(2 * x[2]) * x[0], std::cos(2 * x[0]) * x[1]};
  return mesh;
}

double quadratic(const Vec3& x) {
  return 1 - x[0] + 2 * x[1] * x[1] - x[2] * x[0] + 3 * x[1] * x[2] + 0.5 * x[0] * x[0] - x[2] * x[2];
}

double error(MeshData source, MeshData target, const testing::Function& f, OutsidePolicy outside) {
  const Pair pair{distributed(std::move(source)), distributed(std::move(target))};
  const auto values = testing::sampled(*pair.source, Location::node, f);
  return testing::greatest_error(*pair.target, Location::node,
                                 testing::transferred(pair, FieldKind::point_value, values, {.outside = outside}), f);
}

TEST(SecondOrderSource, QuadraticsAreExact) {
  for (const bool tetrahedra : {false, true}) {
    MeshData source = of_second_order(box(3, {.tetrahedra = tetrahedra, .distortion = tetrahedra ? 0.2 : 0}));
    EXPECT_LT(error(std::move(source), box(5, {.distortion = 0.2, .seed = 4}), quadratic, OutsidePolicy::error), 1e-13)
        << (tetrahedra ? "tet10" : "hex20");
  }
}

TEST(SecondOrderSource, LinearFieldsAreExactInCurvedElements) {
  const auto linear = [](const Vec3& x) { return 2 * x[0] - x[1] + 4 * x[2]; };
  for (const bool tetrahedra : {false, true}) {
    const MeshData source = bent(of_second_order(box(4, {.tetrahedra = tetrahedra})), 0.08);
    EXPECT_LT(error(source, bent(box(7), 0.08), linear, OutsidePolicy::extrapolate), 1e-12)
        << (tetrahedra ? "tet10" : "hex20");
  }
}

TEST(SecondOrderSource, ErrorsFallWithTheThirdPower) {
  const auto smooth = [](const Vec3& x) { return std::sin(3 * x[0]) * std::cos(2 * x[1]) * std::exp(x[2]); };
  for (const bool tetrahedra : {false, true}) {
    const auto at = [&](int n) {
      const auto inner = testing::BoxOptions{.distortion = 0.2, .low = {0.1, 0.1, 0.1}, .high = {0.9, 0.9, 0.9}};
      return error(bent(of_second_order(box(n, {.tetrahedra = tetrahedra})), 0.05), box(11, inner), smooth,
                   OutsidePolicy::extrapolate);
    };
    const double order = std::log2(at(3) / at(6));
    EXPECT_NEAR(order, 3, 0.5) << (tetrahedra ? "tet10" : "hex20");
  }
}

TEST(SecondOrderSource, NodesOfBulgingSidesAreInside) {
  // The target's nodes lie on the source's curved skin: its own nodes, which a mesh of straight edges would miss.
  const MeshData source = bent(of_second_order(box(3)), 0.1);
  MeshData target = source;
  target.blocks[0].connectivity.clear();
  for (std::size_t e = 0; e < target.blocks[0].size(); ++e)
    target.blocks[0].connectivity.insert(
        target.blocks[0].connectivity.end(),
        source.blocks[0].connectivity.begin() + static_cast<std::ptrdiff_t>(20 * e),
        source.blocks[0].connectivity.begin() + static_cast<std::ptrdiff_t>(20 * e + 8));
  target.blocks[0].kind = ElementKind::hex8;
  EXPECT_LT(error(source, std::move(target), quadratic, OutsidePolicy::error), 1e-12);
}

}  // namespace
}  // namespace tenon::transfer

// SPDX-License-Identifier: BSD-3-Clause
// Dual graph of a whole mesh. Time and memory are linear in the size of the mesh.
#include "framework/mesh/dual_graph.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "framework/mesh/facets.hpp"

namespace tenon {

namespace {

void add_adjacency(const MeshData& mesh, PartitionGraph& graph) {
  std::vector<std::array<GlobalId, 2>> pairs;
  for_each_facet(mesh, FacetChoice::all, [&](std::span<const Facet> group) {
    for (std::size_t i = 1; i < group.size(); ++i)
      if (group[i - 1].element != group[i].element) pairs.push_back({group[i - 1].element, group[i].element});
  });
  std::vector<std::size_t> end(graph.ids.size() + 1, 0);
  for (const auto& [a, b] : pairs) ++end[static_cast<std::size_t>(a) + 1], ++end[static_cast<std::size_t>(b) + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  graph.offsets.assign(end.begin(), end.end());
  graph.adjacency.resize(end.back());
  for (const auto& [a, b] : pairs) {
    graph.adjacency[end[static_cast<std::size_t>(a)]++] = b;
    graph.adjacency[end[static_cast<std::size_t>(b)]++] = a;
  }
}

double checked_cost(const ElementCost& cost, const BlockData& block) {
  const double value = cost ? cost(block.name, block.kind) : 1.0;
  if (!(value > 0) || !std::isfinite(value))
    throw Error(ExitCode::usage, fmt::format("cost of an element of block \"{}\" is {}, but a number above 0 expected",
                                             block.name, value));
  return value;
}

}  // namespace

PartitionGraph dual_graph(const MeshData& mesh, const ElementCost& cost, bool adjacency) {
  PartitionGraph graph;
  const std::size_t count = mesh.elements();
  graph.ids.resize(count);
  std::iota(graph.ids.begin(), graph.ids.end(), GlobalId{0});
  graph.centroids.reserve(count);
  graph.weights.reserve(count);
  for (const BlockData& block : mesh.blocks) {
    const auto nodes = static_cast<std::size_t>(topology(block.kind).nodes);
    graph.weights.insert(graph.weights.end(), block.size(), checked_cost(cost, block));
    for (std::size_t e = 0; e < block.size(); ++e) {
      Vec3 sum{};
      for (std::size_t i = 0; i < nodes; ++i)
        sum = sum + mesh.coordinates[static_cast<std::size_t>(block.connectivity[e * nodes + i])];
      graph.centroids.push_back((1.0 / static_cast<double>(nodes)) * sum);
    }
  }
  graph.offsets.assign(count + 1, 0);
  if (adjacency) add_adjacency(mesh, graph);
  return graph;
}

}  // namespace tenon

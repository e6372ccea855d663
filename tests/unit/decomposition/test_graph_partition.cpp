// SPDX-License-Identifier: BSD-3-Clause
// Every element gets a part, parts are even and none is empty, cuts are short.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "framework/decomposition/graph_partition.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon {
namespace {

const Communicator& comm() {
  return testing::communicator();
}

constexpr PartitionMethod methods[] = {PartitionMethod::automatic, PartitionMethod::graph, PartitionMethod::rcb};

enum class Holder { all_in_turn, blocks, rank_zero };

bool holds(Holder holder, GlobalId id, GlobalId count) {
  switch (holder) {
    case Holder::all_in_turn:
      return id % comm().size() == comm().rank();
    case Holder::blocks:
      return id * comm().size() / count == comm().rank();
    case Holder::rank_zero:
      break;
  }
  return comm().rank() == 0;
}

/// Cells of an nx x ny x nz grid bent into a horseshoe; neighbours across faces.
PartitionGraph bent_grid(int nx, int ny, int nz, Holder holder, bool weighted) {
  PartitionGraph graph;
  graph.offsets = {0};
  const GlobalId count = GlobalId{nx} * ny * nz;
  const auto id_of = [&](int i, int j, int k) { return (GlobalId{k} * ny + j) * nx + i; };
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i) {
        const GlobalId id = id_of(i, j, k);
        if (!holds(holder, id, count)) continue;
        graph.ids.push_back(id);
        if (weighted) graph.weights.push_back(i < nx / 3 ? 3.0 : 1.0);
        const double angle = 4.5 * i / nx, radius = 2.0 + 1.0 * j / ny;
        graph.centroids.push_back({radius * std::cos(angle), radius * std::sin(angle), 1.0 * k / nz});
        if (i > 0) graph.adjacency.push_back(id_of(i - 1, j, k));
        if (i < nx - 1) graph.adjacency.push_back(id_of(i + 1, j, k));
        if (j > 0) graph.adjacency.push_back(id_of(i, j - 1, k));
        if (j < ny - 1) graph.adjacency.push_back(id_of(i, j + 1, k));
        if (k > 0) graph.adjacency.push_back(id_of(i, j, k - 1));
        if (k < nz - 1) graph.adjacency.push_back(id_of(i, j, k + 1));
        graph.offsets.push_back(static_cast<LocalIndex>(graph.adjacency.size()));
      }
  return graph;
}

// Part of every element, on every rank.
std::vector<int> gather_parts(const PartitionGraph& graph, const std::vector<int>& part, std::size_t count) {
  std::vector<std::int64_t> all(count, 0);
  for (std::size_t i = 0; i < part.size(); ++i) all[static_cast<std::size_t>(graph.ids[i])] = part[i];
  comm().sum(all);
  return {all.begin(), all.end()};
}

std::int64_t edge_cut(const PartitionGraph& graph, const std::vector<int>& all) {
  std::int64_t cut = 0;
  for (std::size_t i = 0; i < graph.ids.size(); ++i)
    for (LocalIndex e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e)
      cut += all[static_cast<std::size_t>(graph.ids[i])] !=
             all[static_cast<std::size_t>(graph.adjacency[static_cast<std::size_t>(e)])];
  return comm().sum(cut) / 2;
}

void expect_even_parts(Holder holder, bool weighted, int parts, PartitionMethod method, std::int64_t vertices_on_root) {
  SCOPED_TRACE(std::to_string(parts) + " parts, method " + std::to_string(static_cast<int>(method)));
  const PartitionGraph graph = bent_grid(60, 8, 6, holder, weighted);
  const std::vector<int> part = partition_graph(comm(), graph, parts, method, vertices_on_root);
  ASSERT_EQ(part.size(), graph.ids.size());
  std::vector<double> weight(static_cast<std::size_t>(parts), 0);
  double total = 0;
  const std::vector<int> all = gather_parts(graph, part, 60 * 8 * 6);
  for (std::size_t id = 0; id < all.size(); ++id) {
    ASSERT_TRUE(all[id] >= 0 && all[id] < parts);
    const double w = weighted && id % 60 < 20 ? 3.0 : 1.0;
    weight[static_cast<std::size_t>(all[id])] += w;
    total += w;
  }
  const auto [least, most] = std::minmax_element(weight.begin(), weight.end());
  EXPECT_LE(*most, 1.05 * total / parts);
  EXPECT_GT(*least, 0.8 * total / parts);
}

TEST(GraphPartition, PartsAreEvenAndNoneIsEmpty) {
  for (const PartitionMethod method : methods)
    for (const int parts : {1, 2, 7, 16}) {
      expect_even_parts(Holder::rank_zero, false, parts, method, 10000);
      expect_even_parts(Holder::blocks, true, parts, method, 10000);
    }
}

TEST(GraphPartition, PartsAreEvenIfAllRanksDivide) {
  for (const PartitionMethod method : {PartitionMethod::graph, PartitionMethod::rcb}) {
    expect_even_parts(Holder::rank_zero, true, 7, method, 0);
    expect_even_parts(Holder::blocks, false, 2, method, 0);
    expect_even_parts(Holder::all_in_turn, true, 16, method, 0);
  }
}

TEST(GraphPartition, AutomaticCutsNoMoreThanEither) {
  const PartitionGraph graph = bent_grid(100, 10, 4, Holder::blocks, false);
  for (const int parts : {2, 3, 7, 16}) {
    std::int64_t cut[3];
    for (int m = 0; m < 3; ++m)
      cut[m] = edge_cut(graph, gather_parts(graph, partition_graph(comm(), graph, parts, methods[m]), 4000));
    EXPECT_LE(cut[0], cut[2]) << parts;
    EXPECT_LE(cut[1], cut[2] * 3 / 2) << parts;
    EXPECT_LE(cut[0], 40 * 2 * parts) << "slices across the bar would cut 40 faces each";
  }
}

TEST(GraphPartition, SmallAndOddGraphs) {
  for (const int count : {0, 1, 2, 5, 16, 17}) {
    for (const Holder holder : {Holder::all_in_turn, Holder::rank_zero}) {
      const PartitionGraph graph = bent_grid(count, count > 0, count > 0, holder, false);
      for (const int parts : {1, 2, 5, 16})
        for (const PartitionMethod method : methods) {
          const std::vector<int> part = partition_graph(comm(), graph, parts, method);
          std::vector<std::int64_t> in(static_cast<std::size_t>(parts), 0);
          for (const int p : part) ++in[static_cast<std::size_t>(p)];
          comm().sum(in);
          const auto used = std::count_if(in.begin(), in.end(), [](std::int64_t n) { return n > 0; });
          EXPECT_EQ(used, std::min(count, parts)) << count << " elements, method " << static_cast<int>(method);
        }
    }
  }
}

TEST(GraphPartition, OneHeavyElementLeavesNoPartEmpty) {
  PartitionGraph graph = bent_grid(30, 4, 4, Holder::all_in_turn, true);
  for (std::size_t i = 0; i < graph.ids.size(); ++i)
    if (graph.ids[i] == 17) graph.weights[i] = 1e6;
  for (const PartitionMethod method : methods) {
    std::vector<std::int64_t> in(6, 0);
    for (const int p : partition_graph(comm(), graph, 6, method)) ++in[static_cast<std::size_t>(p)];
    comm().sum(in);
    EXPECT_GT(*std::min_element(in.begin(), in.end()), 0);
  }
}

TEST(GraphPartition, CoincidentCentroidsSeparateBodiesAndForeignNeighbours) {
  PartitionGraph graph = bent_grid(40, 5, 5, Holder::blocks, false);
  for (Vec3& x : graph.centroids) x = {1, 1, 1};
  for (GlobalId& id : graph.adjacency)
    if (id % 40 == 20) id = 5000;  // held by nobody
  for (std::size_t i = 0; i < graph.ids.size(); ++i)
    if (graph.ids[i] % 40 == 20)
      for (LocalIndex e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e)
        graph.adjacency[static_cast<std::size_t>(e)] = graph.ids[i];
  for (const PartitionMethod method : methods) {
    std::vector<std::int64_t> in(7, 0);
    for (const int p : partition_graph(comm(), graph, 7, method)) ++in[static_cast<std::size_t>(p)];
    comm().sum(in);
    EXPECT_LE(*std::max_element(in.begin(), in.end()), 1000 / 7 * 1.05 + 1);
    EXPECT_GT(*std::min_element(in.begin(), in.end()), 0);
  }
}

TEST(GraphPartition, ImbalanceIsGreatestOverMean) {
  EXPECT_EQ(imbalance(comm(), 0), 1);
  EXPECT_EQ(imbalance(comm(), 2.5), 1);
  EXPECT_EQ(imbalance(comm(), comm().rank() == 0 ? 3 : 0), comm().size());
}

}  // namespace
}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
#include "framework/decomposition/graph_partition.hpp"

#include <algorithm>
#include <numeric>

#include "framework/comm/directory.hpp"
#include "framework/decomposition/zoltan_partitioner.hpp"

namespace tenon {

namespace {

// Adjacency by rank and place; what no rank holds, and a vertex itself, is left out.
struct LocatedEdges {
  std::vector<LocalIndex> offsets{0};
  std::vector<int> rank;
  std::vector<LocalIndex> index;
};

LocatedEdges locate(const Communicator& comm, const PartitionGraph& graph) {
  std::vector<LocalIndex> index(graph.ids.size());
  std::iota(index.begin(), index.end(), LocalIndex{0});
  const auto entries = Directory(comm, graph.ids, index).find(graph.adjacency);
  LocatedEdges edges;
  for (std::size_t i = 0; i < graph.ids.size(); ++i) {
    for (LocalIndex e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e) {
      const auto edge = static_cast<std::size_t>(e);
      if (entries[edge].rank < 0 || graph.adjacency[edge] == graph.ids[i]) continue;
      edges.rank.push_back(entries[edge].rank);
      edges.index.push_back(entries[edge].index);
    }
    edges.offsets.push_back(static_cast<LocalIndex>(edges.rank.size()));
  }
  return edges;
}

std::vector<int> by_rcb(const Communicator& comm, const PartitionGraph& graph, int parts) {
  ZoltanPartitioner zoltan(comm, parts);
  zoltan.set("LB_METHOD", "RCB");
  zoltan.set("CHECK_GEOM", "0");
  return zoltan.partition({.coordinates = graph.centroids, .weights = graph.weights});
}

std::vector<int> by_graph(const Communicator& comm, const PartitionGraph& graph, int parts) {
  const LocatedEdges edges = locate(comm, graph);
  ZoltanPartitioner zoltan(comm, parts);
  zoltan.set("LB_METHOD", "GRAPH");
  zoltan.set("GRAPH_PACKAGE", "PHG");
  zoltan.set("LB_APPROACH", "PARTITION");
  zoltan.set("IMBALANCE_TOL", "1.03");
  zoltan.set("CHECK_GRAPH", "0");
  return zoltan.partition({.coordinates = graph.centroids,
                           .weights = graph.weights,
                           .offsets = edges.offsets,
                           .neighbour_rank = edges.rank,
                           .neighbour_index = edges.index});
}

}  // namespace

std::vector<int> partition_graph(const Communicator& comm, const PartitionGraph& graph, int parts,
                                 PartitionMethod method) {
  if (parts == 1 || !comm.any(!graph.ids.empty())) return std::vector<int>(graph.ids.size(), 0);
  return method == PartitionMethod::graph ? by_graph(comm, graph, parts) : by_rcb(comm, graph, parts);
}

double imbalance(const Communicator& comm, double mine) {
  ExactSum sum;
  sum.add(mine);
  const double total = comm.sum(sum);
  return total > 0 ? comm.max(mine) * comm.size() / total : 1;
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
#include "framework/decomposition/graph_partition.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "framework/comm/directory.hpp"
#include "framework/comm/exchange_plan.hpp"
#include "framework/decomposition/zoltan_partitioner.hpp"

namespace tenon {

namespace {

// Parts whose weights differ less than this count as equal; then the cut decides.
constexpr double accepted_imbalance = 1.05;
// Below so many vertices a part, multilevel methods have nothing to coarsen.
constexpr std::int64_t graph_vertices_per_part = 16;

// Adjacency by rank and place, each edge once. What no rank holds, and a vertex itself, is left out.
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
  std::vector<std::pair<int, LocalIndex>> neighbours;
  for (std::size_t i = 0; i < graph.ids.size(); ++i) {
    neighbours.clear();
    for (LocalIndex e = graph.offsets[i]; e < graph.offsets[i + 1]; ++e) {
      const auto edge = static_cast<std::size_t>(e);
      if (entries[edge].rank >= 0 && graph.adjacency[edge] != graph.ids[i])
        neighbours.emplace_back(entries[edge].rank, entries[edge].index);
    }
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    for (const auto& [rank, place] : neighbours) {
      edges.rank.push_back(rank);
      edges.index.push_back(place);
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

// PT-Scotch [CP08]: on irregular meshes its cuts are as short as those of Zoltan's own PHG, its parts are more even,
// and it takes less time.
std::vector<int> by_graph(const Communicator& comm, const PartitionGraph& graph, const LocatedEdges& edges, int parts) {
  ZoltanPartitioner zoltan(comm, parts);
  zoltan.set("LB_METHOD", "GRAPH");
  zoltan.set("GRAPH_PACKAGE", "SCOTCH");
  zoltan.set("LB_APPROACH", "PARTITION");
  zoltan.set("IMBALANCE_TOL", "1.02");
  zoltan.set("CHECK_GRAPH", "0");
  return zoltan.partition({.coordinates = graph.centroids,
                           .weights = graph.weights,
                           .offsets = edges.offsets,
                           .neighbour_rank = edges.rank,
                           .neighbour_index = edges.index});
}

std::vector<std::int64_t> vertices_of_parts(const Communicator& comm, std::span<const int> part, int parts) {
  std::vector<std::int64_t> count(static_cast<std::size_t>(parts), 0);
  for (const int p : part) ++count[static_cast<std::size_t>(p)];
  comm.sum(count);
  return count;
}

/// The less the better, in this order.
struct Quality {
  std::int64_t empty_parts;
  double imbalance;  // at least the accepted one
  std::int64_t cut;
  auto operator<=>(const Quality&) const = default;
};

Quality quality(const Communicator& comm, const PartitionGraph& graph, const LocatedEdges& edges,
                const std::vector<int>& part, int parts) {
  std::vector<ExactSum> weight_of_part(static_cast<std::size_t>(parts));
  for (std::size_t i = 0; i < part.size(); ++i)
    weight_of_part[static_cast<std::size_t>(part[i])].add(graph.weights.empty() ? 1.0 : graph.weights[i]);
  std::vector<double> weight(weight_of_part.size());
  comm.sum(weight_of_part, weight);
  const double mean = std::accumulate(weight.begin(), weight.end(), 0.0) / parts;

  std::vector<LocalIndex> place(edges.rank.size());
  std::iota(place.begin(), place.end(), LocalIndex{0});
  std::vector<int> neighbour_part(edges.rank.size());
  ExchangePlan::from_owners(comm, edges.rank, edges.index, place, "partition")
      .forward(std::span<const int>(part), std::span(neighbour_part));
  std::int64_t cut = 0;
  for (std::size_t i = 0; i < part.size(); ++i)
    for (LocalIndex e = edges.offsets[i]; e < edges.offsets[i + 1]; ++e)
      cut += part[i] != neighbour_part[static_cast<std::size_t>(e)];
  const std::vector<std::int64_t> vertices = vertices_of_parts(comm, part, parts);
  return {std::count(vertices.begin(), vertices.end(), 0),
          std::max(accepted_imbalance, *std::max_element(weight.begin(), weight.end()) / mean), comm.sum(cut)};
}

// Gives each empty part the vertex of least id of the part that has most; for weights and shapes that no cut divides.
void fill_empty_parts(const Communicator& comm, std::span<const GlobalId> ids, std::vector<int>& part, int parts) {
  std::vector<std::int64_t> vertices = vertices_of_parts(comm, part, parts);
  for (int empty = 0; empty < parts; ++empty) {
    if (vertices[static_cast<std::size_t>(empty)] > 0) continue;
    const auto most = std::max_element(vertices.begin(), vertices.end());
    if (*most < 2) return;
    const int donor = static_cast<int>(most - vertices.begin());
    std::int64_t least = std::numeric_limits<std::int64_t>::max();
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (part[i] == donor) least = std::min(least, ids[i]);
    least = comm.min(least);
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ids[i] == least) part[i] = empty;
    --*most;
    ++vertices[static_cast<std::size_t>(empty)];
  }
}

std::vector<int> divide(const Communicator& comm, const PartitionGraph& graph, std::int64_t vertices, int parts,
                        PartitionMethod method) {
  std::vector<int> part = by_rcb(comm, graph, parts);
  if (method != PartitionMethod::rcb && vertices >= graph_vertices_per_part * parts) {
    const LocatedEdges edges = locate(comm, graph);
    std::vector<int> other = by_graph(comm, graph, edges, parts);
    Quality of_rcb = quality(comm, graph, edges, part, parts);
    Quality of_graph = quality(comm, graph, edges, other, parts);
    if (method == PartitionMethod::graph) of_rcb.cut = of_graph.cut = 0;
    if (of_graph <= of_rcb) part = std::move(other);
  }
  fill_empty_parts(comm, graph.ids, part, parts);
  return part;
}

std::vector<int> divide_on_root(const Communicator& comm, const PartitionGraph& graph, std::int64_t vertices, int parts,
                                PartitionMethod method) {
  const bool weighted = comm.any(!graph.weights.empty());
  const ExchangePlan to_root = ExchangePlan::to_ranks(comm, std::vector<int>(graph.ids.size(), 0), "partition");
  const auto arriving = static_cast<std::size_t>(to_root.received());
  PartitionGraph whole;
  whole.ids.resize(arriving);
  whole.centroids.resize(arriving);
  to_root.forward(std::span<const GlobalId>(graph.ids), std::span(whole.ids));
  to_root.forward(std::span<const Vec3>(graph.centroids), std::span(whole.centroids));
  if (weighted) {
    whole.weights.resize(arriving);
    to_root.forward(std::span<const double>(graph.weights), std::span(whole.weights));
  }
  std::vector<LocalIndex> degree(graph.ids.size());
  for (std::size_t i = 0; i < degree.size(); ++i) degree[i] = graph.offsets[i + 1] - graph.offsets[i];
  auto adjacency =
      to_root.forward_varying(std::span<const LocalIndex>(degree), std::span<const GlobalId>(graph.adjacency));
  whole.adjacency = std::move(adjacency.values);
  whole.offsets.assign(arriving + 1, 0);
  std::inclusive_scan(adjacency.counts.begin(), adjacency.counts.end(), whole.offsets.begin() + 1);

  std::vector<int> part_of_all, part(graph.ids.size());
  comm.vote_on_root([&] { part_of_all = divide(Communicator::self(), whole, vertices, parts, method); });
  to_root.reverse(std::span<const int>(part_of_all), std::span(part));
  return part;
}

// A part so heavy that some ranks would be left without vertices half way through: Zoltan fails there.
bool is_lopsided(const Communicator& comm, const PartitionGraph& graph) {
  double greatest = 0;
  ExactSum sum;
  for (const double weight : graph.weights) {
    greatest = std::max(greatest, weight);
    sum.add(weight);
  }
  return comm.max(greatest) * 2 * comm.size() > comm.sum(sum);
}

}  // namespace

std::vector<int> partition_graph(const Communicator& comm, const PartitionGraph& graph, int parts,
                                 PartitionMethod method, std::int64_t vertices_on_root) {
  const std::int64_t vertices = comm.sum(static_cast<std::int64_t>(graph.ids.size()));
  if (parts == 1 || vertices == 0) return std::vector<int>(graph.ids.size(), 0);
  const bool lopsided = is_lopsided(comm, graph);
  if (comm.size() > 1 && (vertices <= vertices_on_root || lopsided))
    return divide_on_root(comm, graph, vertices, parts, method);
  return divide(comm, graph, vertices, parts, method);
}

double imbalance(const Communicator& comm, double mine) {
  ExactSum sum;
  sum.add(mine);
  const double total = comm.sum(sum);
  return total > 0 ? comm.max(mine) * comm.size() / total : 1;
}

}  // namespace tenon

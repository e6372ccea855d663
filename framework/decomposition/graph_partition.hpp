// SPDX-License-Identifier: BSD-3-Clause
// Static, weighted partition of elements, done once at set-up.
#pragma once

#include <span>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/comm/communicator.hpp"

namespace tenon {

/// How elements are divided. `automatic` takes of `graph` and `rcb` the one that cuts fewer faces between elements.
enum class PartitionMethod { automatic, graph, rcb };

/// Vertices (elements) of a graph held by this rank. Vertex i has the neighbours
/// `adjacency[offsets[i] .. offsets[i+1])` (global ids) and stands at `centroids[i]` (m).
struct PartitionGraph {
  std::vector<GlobalId> ids;
  std::vector<double> weights;  ///< relative cost; empty means equal
  std::vector<Vec3> centroids;
  std::vector<LocalIndex> offsets;
  std::vector<GlobalId> adjacency;
};

/// Collective. Part (0 .. parts-1) of each vertex of this rank. Through Zoltan. Ranks may hold no vertices. Every part
/// gets at least one vertex, if there are as many. The graph must be symmetric; neighbours that no rank holds are
/// passed over. Up to `vertices_on_root` vertices are divided by rank 0 alone: the parallel PT-Scotch sends many small
/// messages, and takes twice as long on two ranks as on one.
std::vector<int> partition_graph(const Communicator& comm, const PartitionGraph& graph, int parts,
                                 PartitionMethod method, std::int64_t vertices_on_root = 300'000);

/// Greatest over mean of a non-negative quantity over the ranks (1 = perfect). Collective.
double imbalance(const Communicator& comm, double mine);

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Static, weighted partition of elements, done once at set-up.
#pragma once

#include <span>
#include <vector>

#include "framework/base/types.hpp"
#include "framework/comm/communicator.hpp"

namespace tenon {

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

/// Collective. Part (0 .. parts-1) of each vertex of this rank. Through Zoltan. Ranks may hold no vertices.
std::vector<int> partition_graph(const Communicator& comm, const PartitionGraph& graph, int parts,
                                 PartitionMethod method);

/// Greatest over mean of a non-negative quantity over the ranks (1 = perfect). Collective.
double imbalance(const Communicator& comm, double mine);

}  // namespace tenon

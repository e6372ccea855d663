// SPDX-License-Identifier: BSD-3-Clause
// Elements as vertices of a graph, and who owns what once the graph is cut.
#pragma once

#include <vector>

#include "framework/decomposition/graph_partition.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon {

/// Elements with their costs and centroids; neighbours (when `adjacency` is asked for) share a face, or an edge if both
/// are surface elements. Where more than two meet, each is joined to the next.
PartitionGraph dual_graph(const MeshData& mesh, const ElementCost& cost, bool adjacency);

/// Owner of each node: one of the owners of the elements around it, which computes them all. Of the nodes between two
/// ranks each gets a half that hangs together, so that few elements are computed twice and both have as many more;
/// where several ranks meet, the one that has most of the elements already. Nodes without elements go to rank 0.
std::vector<int> node_owners(const MeshData& mesh, const std::vector<int>& element_owners);

}  // namespace tenon

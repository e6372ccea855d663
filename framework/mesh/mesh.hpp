// SPDX-License-Identifier: BSD-3-Clause
// The part of a mesh that one rank holds.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "framework/comm/exchange_plan.hpp"
#include "framework/decomposition/graph_partition.hpp"
#include "framework/mesh/mesh_data.hpp"

namespace tenon {

/// Elements of one block on this rank, ascending by global id, owned and ghost among each other.
struct ElementBlock {
  std::string name;
  ElementKind kind = ElementKind::hex8;
  std::vector<GlobalId> ids;
  std::vector<std::int64_t> labels;      ///< ids in the file, for messages
  std::vector<int> owners;               ///< rank that owns each
  std::vector<LocalIndex> connectivity;  ///< elements x nodes, local node indices
  GlobalId global_count = 0;
  GlobalId first_id = 0;  ///< global ids of the block: first_id .. first_id + global_count - 1
  LocalIndex size() const { return static_cast<LocalIndex>(ids.size()); }
  std::span<const LocalIndex> nodes(LocalIndex element) const {
    const auto n = static_cast<std::size_t>(topology(kind).nodes);
    return {connectivity.data() + static_cast<std::size_t>(element) * n, n};
  }
};

struct NodeSet {
  std::string name;
  std::vector<LocalIndex> nodes;  ///< ascending, owned and ghost
  GlobalId global_count = 0;
};

struct Side {
  LocalIndex block, element;  ///< element within the block
  int side;
};
struct SideSet {
  std::string name;
  std::vector<Side> sides;  ///< ascending; of owned and ghost elements
  GlobalId global_count = 0;
};

/// A distributed mesh: every element that this rank owns and every element (ghost) that touches a node which this
/// rank owns. So a sum over the elements around an owned node, taken in the order of storage, has all its terms in
/// ascending global order on every number of ranks: the same bits (DESIGN: canonical order). Nodes are ascending by
/// global id, owned and ghost among each other. Immutable.
class Mesh {
 public:
  Mesh(Communicator communicator) : comm(std::move(communicator)) {}

  Communicator comm;
  std::string source;
  GlobalId global_nodes = 0, global_elements = 0;

  std::vector<GlobalId> node_ids;         ///< ascending
  std::vector<std::int64_t> node_labels;  ///< ids in the file, for messages
  std::vector<int> node_owners;
  std::vector<Vec3> coordinates;        ///< reference coordinates, m
  std::vector<double> volumes;          ///< of nodes that are particles, as in MeshData; empty: none are
  std::vector<LocalIndex> owned_nodes;  ///< local indices of owned nodes, ascending
  std::vector<ElementBlock> blocks;
  std::vector<NodeSet> node_sets;
  std::vector<SideSet> side_sets;

  /// Refreshes ghost nodes from their owners: pull form, in place on an array of nodes() x components.
  ExchangePlan node_halo;

  LocalIndex nodes() const { return static_cast<LocalIndex>(node_ids.size()); }
  LocalIndex elements() const;  ///< of all blocks, owned and ghost
  bool owns_node(LocalIndex n) const { return node_owners[static_cast<std::size_t>(n)] == comm.rank(); }

  /// By name; nullptr if there is none.
  const ElementBlock* find_block(std::string_view name) const;
  const NodeSet* find_node_set(std::string_view name) const;
  const SideSet* find_side_set(std::string_view name) const;
};

/// Elements of the block that `rank` owns, ascending.
std::vector<LocalIndex> owned_elements(const ElementBlock& block, int rank);

/// Collective. The summary that rank 0 holds, on all ranks.
MeshSummary broadcast_summary(const Communicator& comm, const MeshSummary& summary);

/// Relative cost of an element, for the partition; by block.
using ElementCost = std::function<double(const std::string& block, ElementKind kind)>;

struct DistributeOptions {
  ElementCost cost;  ///< empty means equal
  PartitionMethod method = PartitionMethod::automatic;
  std::string name = "mesh";  ///< of the exchanges in the report: "mesh halo", "mesh set-up"
};

/// Collective. Distributes `mesh` (which only rank 0 need hold; it is released as it goes) over the ranks of `comm`.
/// Ranks may end up with nothing.
std::shared_ptr<const Mesh> distribute(const Communicator& comm, MeshData&& mesh, const DistributeOptions& options);

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Last steps of making a distributed mesh: who keeps a node where, and where the ghosts come from.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "framework/mesh/mesh.hpp"

namespace tenon {

/// One of `ranks` (ascending, distinct, not empty), chosen by a hash of the node's number so that no rank is favoured.
int node_owner(GlobalId node, std::span<const int> ranks);

/// Collective. The place of each id among the ascending `local_ids` of its owner, who must have it.
std::vector<LocalIndex> places_at_owners(const Communicator& comm, std::span<const int> owners,
                                         std::span<const GlobalId> ids, std::span<const GlobalId> local_ids,
                                         const std::string& name);

/// Collective. Fills owned_nodes and node_halo from node_ids and node_owners.
void connect_halo(Mesh& mesh, const std::string& name);

}  // namespace tenon

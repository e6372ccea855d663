// SPDX-License-Identifier: BSD-3-Clause
#include "framework/mesh/halo.hpp"

#include <algorithm>

namespace tenon {

int node_owner(GlobalId node, std::span<const int> ranks) {
  // Fibonacci hashing: neighbouring numbers scatter.
  const std::uint64_t hash = (static_cast<std::uint64_t>(node) * 0x9E3779B97F4A7C15ULL) >> 32;
  return ranks[hash % ranks.size()];
}

std::vector<LocalIndex> places_at_owners(const Communicator& comm, std::span<const int> owners,
                                         std::span<const GlobalId> ids, std::span<const GlobalId> local_ids,
                                         const std::string& name) {
  const ExchangePlan question = ExchangePlan::to_ranks(comm, owners, name + " set-up");
  std::vector<GlobalId> asked(static_cast<std::size_t>(question.received()));
  question.forward(ids, std::span(asked));
  std::vector<LocalIndex> answer;
  answer.reserve(asked.size());
  for (const GlobalId id : asked)
    answer.push_back(
        static_cast<LocalIndex>(std::lower_bound(local_ids.begin(), local_ids.end(), id) - local_ids.begin()));
  std::vector<LocalIndex> places(ids.size());
  question.reverse(std::span<const LocalIndex>(answer), std::span(places));
  return places;
}

void connect_halo(Mesh& mesh, const std::string& name) {
  std::vector<int> owner;
  std::vector<GlobalId> id;
  std::vector<LocalIndex> into;
  for (LocalIndex n = 0; n < mesh.nodes(); ++n) {
    const auto i = static_cast<std::size_t>(n);
    if (mesh.owns_node(n)) {
      mesh.owned_nodes.push_back(n);
      continue;
    }
    owner.push_back(mesh.node_owners[i]);
    id.push_back(mesh.node_ids[i]);
    into.push_back(n);
  }
  const std::vector<LocalIndex> index = places_at_owners(mesh.comm, owner, id, mesh.node_ids, name);
  mesh.node_halo = ExchangePlan::from_owners(mesh.comm, owner, index, into, name + " halo");
}

}  // namespace tenon

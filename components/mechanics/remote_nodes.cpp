// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/remote_nodes.hpp"

#include <numeric>

#include "framework/comm/directory.hpp"

namespace tenon {

RemoteNodes::RemoteNodes(const Mesh& mesh, std::span<const GlobalId> wanted, std::string name) {
  std::vector<GlobalId> ids;
  for (const LocalIndex n : mesh.owned_nodes) ids.push_back(mesh.node_ids[static_cast<std::size_t>(n)]);
  const Directory directory(mesh.comm, ids, mesh.owned_nodes);
  std::vector<int> owner;
  std::vector<LocalIndex> index, into(wanted.size());
  for (const DirectoryEntry& entry : directory.find(wanted)) owner.push_back(entry.rank), index.push_back(entry.index);
  std::iota(into.begin(), into.end(), LocalIndex{0});
  plan_ = ExchangePlan::from_owners(mesh.comm, owner, index, into, std::move(name));
}

}  // namespace tenon

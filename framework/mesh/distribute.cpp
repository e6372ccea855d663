// SPDX-License-Identifier: BSD-3-Clause
// From a whole mesh on rank 0 to parts with ghosts. Blocks are pushed to the ranks that need them, one by one, and
// released; then each rank pulls the nodes of its elements.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "framework/mesh/dual_graph.hpp"
#include "framework/mesh/facets.hpp"
#include "framework/mesh/halo.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon {

namespace {

template <typename T>
ExchangeItem travelling(const std::vector<T>& from, std::vector<T>& to, std::size_t components = 1) {
  return {reinterpret_cast<const std::byte*>(from.data()), reinterpret_cast<std::byte*>(to.data()),
          components * sizeof(T)};
}

/// What rank 0 knows of owners; empty elsewhere.
struct Owners {
  std::vector<int> elements, nodes;
};

/// Refuses what the exchanges below could not address. On rank 0.
void check_addresses(const MeshData& mesh) {
  constexpr std::size_t most = std::numeric_limits<LocalIndex>::max();
  if (mesh.coordinates.size() > most || mesh.elements() > most)
    throw Error(ExitCode::file, fmt::format("{}: {} nodes and {} elements, but one rank can read at most {} of each",
                                            mesh.source, mesh.coordinates.size(), mesh.elements(), most));
  const auto nodes = static_cast<GlobalId>(mesh.coordinates.size());
  for (const BlockData& block : mesh.blocks)
    for (const GlobalId n : block.connectivity)
      if (n < 0 || n >= nodes)
        throw Error(ExitCode::file, fmt::format("{}: block \"{}\" refers to node number {} of {}", mesh.source,
                                                block.name, n + 1, nodes));
}

Owners divide(const Communicator& comm, const MeshData& mesh, const DistributeOptions& options) {
  Owners owners;
  if (comm.size() == 1) {
    owners.elements.assign(mesh.elements(), 0);
  } else {
    PartitionGraph graph{.ids = {}, .weights = {}, .centroids = {}, .offsets = {0}, .adjacency = {}};
    comm.vote_on_root([&] { graph = dual_graph(mesh, options.cost, options.method != PartitionMethod::rcb); });
    owners.elements = partition_graph(comm, graph, comm.size(), options.method);
  }
  if (comm.rank() == 0) owners.nodes = node_owners(mesh, owners.elements);
  return owners;
}

/// Elements of one block in the order of sending: each to its owner and to the owners of its nodes.
struct Sending {
  std::vector<int> rank;
  std::vector<LocalIndex> element;
};

Sending receivers(const BlockData& block, const int* element_owner, const std::vector<int>& node_owner) {
  Sending sending;
  const auto nodes = static_cast<std::size_t>(topology(block.kind).nodes);
  std::array<int, max_element_nodes + 1> ranks;
  for (std::size_t e = 0; e < block.size(); ++e) {
    std::size_t count = 0;
    ranks[count++] = element_owner[e];
    for (std::size_t i = 0; i < nodes; ++i) {
      const int owner = node_owner[static_cast<std::size_t>(block.connectivity[e * nodes + i])];
      if (owner == ranks[count - 1]) continue;
      const auto end = ranks.begin() + static_cast<std::ptrdiff_t>(count);
      if (std::find(ranks.begin(), end, owner) == end) ranks[count++] = owner;
    }
    sending.rank.insert(sending.rank.end(), ranks.begin(), ranks.begin() + static_cast<std::ptrdiff_t>(count));
    sending.element.insert(sending.element.end(), count, static_cast<LocalIndex>(e));
  }
  return sending;
}

/// A side of some set, as it travels with its element.
struct SideMark {
  std::int32_t set, side;
};

/// Values that belong to items: `counts[i]` of item i, one after the other.
template <typename T>
struct Lists {
  std::vector<LocalIndex> counts;
  std::vector<T> values;
};

/// Lists by item of (item, value) pairs; the order within an item is that of the pairs.
template <typename T>
Lists<T> by_item(std::size_t items, const std::vector<std::pair<LocalIndex, T>>& pairs) {
  Lists<T> lists{std::vector<LocalIndex>(items, 0), std::vector<T>(pairs.size())};
  for (const auto& [item, value] : pairs) ++lists.counts[static_cast<std::size_t>(item)];
  std::vector<std::size_t> next(items + 1, 0);
  for (std::size_t i = 0; i < items; ++i) next[i + 1] = next[i] + static_cast<std::size_t>(lists.counts[i]);
  for (const auto& [item, value] : pairs) lists.values[next[static_cast<std::size_t>(item)]++] = value;
  return lists;
}

Lists<SideMark> side_marks(const MeshData& mesh, GlobalId first, std::size_t count) {
  std::vector<std::pair<LocalIndex, SideMark>> pairs;
  for (std::size_t s = 0; s < mesh.side_sets.size(); ++s) {
    const std::vector<SideData>& sides = mesh.side_sets[s].sides;
    auto it = std::lower_bound(sides.begin(), sides.end(), first,
                               [](const SideData& side, GlobalId element) { return side.element < element; });
    for (; it != sides.end() && it->element < first + static_cast<GlobalId>(count); ++it)
      pairs.push_back({static_cast<LocalIndex>(it->element - first), {static_cast<std::int32_t>(s), it->side}});
  }
  return by_item(count, pairs);
}

Lists<std::int32_t> node_marks(const MeshData& mesh) {
  std::vector<std::pair<LocalIndex, std::int32_t>> pairs;
  for (std::size_t s = 0; s < mesh.node_sets.size(); ++s)
    for (const GlobalId n : mesh.node_sets[s].nodes)
      pairs.push_back({static_cast<LocalIndex>(n), static_cast<std::int32_t>(s)});
  return by_item(mesh.coordinates.size(), pairs);
}

/// A block on its way: its connectivity still holds global node ids.
struct Arrived {
  std::vector<GlobalId> connectivity;
  Lists<SideMark> sides;
};

/// Collective. Sends block `b` of rank 0's mesh, and releases it there.
Arrived send_block(const Communicator& comm, MeshData& mesh, std::size_t b, const Owners& owners,
                   const std::string& name, ElementBlock& block) {
  Sending sending;
  std::vector<GlobalId> ids;
  std::vector<int> element_owners;
  Lists<SideMark> marks;
  BlockData data;
  if (comm.rank() == 0) {
    data = std::move(mesh.blocks[b]);
    const int* owner = owners.elements.data() + block.first_id;
    element_owners.assign(owner, owner + data.size());
    ids.resize(data.size());
    std::iota(ids.begin(), ids.end(), block.first_id);
    sending = receivers(data, owner, owners.nodes);
    marks = side_marks(mesh, block.first_id, data.size());
  }
  const ExchangePlan plan = ExchangePlan::to_ranks(comm, sending.rank, sending.element, name);
  const auto nodes = static_cast<std::size_t>(topology(block.kind).nodes);
  const auto count = static_cast<std::size_t>(plan.received());
  Arrived arrived;
  block.ids.resize(count);
  block.labels.resize(count);
  block.owners.resize(count);
  arrived.connectivity.resize(count * nodes);
  const std::array<ExchangeItem, 4> arrays{travelling(ids, block.ids), travelling(data.labels, block.labels),
                                           travelling(element_owners, block.owners),
                                           travelling(data.connectivity, arrived.connectivity, nodes)};
  plan.forward(arrays);
  auto received =
      plan.forward_varying(std::span<const LocalIndex>(marks.counts), std::span<const SideMark>(marks.values));
  arrived.sides = {std::move(received.counts), std::move(received.values)};
  return arrived;
}

/// Global ids of the nodes of all elements here, and on rank 0 those without elements, ascending.
std::vector<GlobalId> needed_nodes(const std::vector<Arrived>& arrived, std::vector<GlobalId> orphans) {
  std::vector<GlobalId> ids = std::move(orphans);
  for (const Arrived& a : arrived) ids.insert(ids.end(), a.connectivity.begin(), a.connectivity.end());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  ids.shrink_to_fit();
  return ids;
}

/// Nodes that no element touches. On rank 0, before the blocks are sent.
std::vector<GlobalId> nodes_without_elements(const MeshData& mesh) {
  std::vector<char> touched(mesh.coordinates.size(), 0);
  for (const BlockData& block : mesh.blocks)
    for (const GlobalId n : block.connectivity) touched[static_cast<std::size_t>(n)] = 1;
  std::vector<GlobalId> orphans;
  for (std::size_t n = 0; n < touched.size(); ++n)
    if (!touched[n]) orphans.push_back(static_cast<GlobalId>(n));
  return orphans;
}

/// Collective. Pulls the nodes that `mesh.node_ids` names, and their sets, from rank 0.
void pull_nodes(const Communicator& comm, const MeshData& data, const Owners& owners, const std::string& name,
                Mesh& mesh) {
  const std::size_t count = mesh.node_ids.size();
  const std::vector<int> root(count, 0);
  std::vector<LocalIndex> index(mesh.node_ids.begin(), mesh.node_ids.end()), into(count);
  std::iota(into.begin(), into.end(), 0);
  const ExchangePlan plan = ExchangePlan::from_owners(comm, root, index, into, name);
  mesh.node_labels.resize(count);
  mesh.node_owners.resize(count);
  mesh.coordinates.resize(count);
  const std::array<ExchangeItem, 3> arrays{travelling(data.coordinates, mesh.coordinates),
                                           travelling(data.node_labels, mesh.node_labels),
                                           travelling(owners.nodes, mesh.node_owners)};
  plan.forward(arrays);
  if (comm.any(!data.volumes.empty())) {
    mesh.volumes.resize(count);
    plan.forward(std::span<const double>(data.volumes), std::span(mesh.volumes));
  }

  Lists<std::int32_t> marks;
  if (comm.rank() == 0) marks = node_marks(data);
  const auto received =
      plan.forward_varying(std::span<const LocalIndex>(marks.counts), std::span<const std::int32_t>(marks.values));
  std::size_t at = 0;
  for (std::size_t n = 0; n < count; ++n)
    for (LocalIndex k = 0; k < received.counts[n]; ++k)
      mesh.node_sets[static_cast<std::size_t>(received.values[at++])].nodes.push_back(static_cast<LocalIndex>(n));
}

/// Replaces global node ids by local indices, and enters the sides that travelled along in their sets.
void settle(Mesh& mesh, std::vector<Arrived>&& arrived) {
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    std::vector<LocalIndex>& connectivity = mesh.blocks[b].connectivity;
    connectivity.reserve(arrived[b].connectivity.size());
    for (const GlobalId id : arrived[b].connectivity) {
      const auto place = std::lower_bound(mesh.node_ids.begin(), mesh.node_ids.end(), id);
      connectivity.push_back(static_cast<LocalIndex>(place - mesh.node_ids.begin()));
    }
    std::size_t at = 0;
    const std::vector<LocalIndex>& counts = arrived[b].sides.counts;
    for (std::size_t e = 0; e < counts.size(); ++e)
      for (LocalIndex k = 0; k < counts[e]; ++k) {
        const SideMark mark = arrived[b].sides.values[at++];
        mesh.side_sets[static_cast<std::size_t>(mark.set)].sides.push_back(
            {static_cast<LocalIndex>(b), static_cast<LocalIndex>(e), mark.side});
      }
    arrived[b] = {};
  }
}

/// Names and sizes, the same on every rank.
void describe(const MeshSummary& summary, Mesh& mesh) {
  mesh.source = summary.source;
  mesh.global_nodes = summary.nodes;
  mesh.global_elements = summary.elements;
  GlobalId first = 0;
  for (const MeshSummary::Entry& e : summary.blocks) {
    ElementBlock block;
    block.name = e.name, block.kind = e.kind, block.global_count = e.count, block.first_id = first;
    mesh.blocks.push_back(std::move(block));
    first += e.count;
  }
  for (const MeshSummary::Entry& e : summary.node_sets) mesh.node_sets.push_back({e.name, {}, e.count});
  for (const MeshSummary::Entry& e : summary.side_sets) mesh.side_sets.push_back({e.name, {}, e.count});
}

}  // namespace

std::shared_ptr<const Mesh> distribute(const Communicator& comm, MeshData&& mesh, const DistributeOptions& options) {
  MeshData data = std::move(mesh);
  mesh = {};
  if (comm.rank() != 0) data = {};
  comm.vote_on_root([&] { check_addresses(data); });
  auto result = std::make_shared<Mesh>(comm);
  describe(broadcast_summary(comm, comm.rank() == 0 ? summarise(data) : MeshSummary{}), *result);

  const Owners owners = divide(comm, data, options);
  std::vector<GlobalId> orphans = nodes_without_elements(data);
  std::vector<Arrived> arrived;
  for (std::size_t b = 0; b < result->blocks.size(); ++b)
    arrived.push_back(send_block(comm, data, b, owners, options.name + " set-up", result->blocks[b]));
  result->node_ids = needed_nodes(arrived, std::move(orphans));
  pull_nodes(comm, data, owners, options.name + " set-up", *result);
  data = {};
  settle(*result, std::move(arrived));
  connect_halo(*result, options.name);
  return result;
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Look-ups by name, and the summary that all ranks know.
#include "framework/mesh/mesh.hpp"

#include <algorithm>

namespace tenon {

namespace {

template <typename Named>
const Named* find_named(const std::vector<Named>& all, std::string_view name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

/// Entries without their names, which travel as text.
struct EntryNumbers {
  std::int64_t label, count;
  ElementKind kind;
};

void broadcast_entries(const Communicator& comm, std::vector<MeshSummary::Entry>& entries) {
  std::vector<EntryNumbers> numbers;
  std::vector<std::int64_t> lengths;
  std::string names;
  for (const MeshSummary::Entry& e : entries) {
    numbers.push_back({e.label, e.count, e.kind});
    lengths.push_back(static_cast<std::int64_t>(e.name.size()));
    names += e.name;
  }
  comm.broadcast(numbers);
  comm.broadcast(lengths);
  comm.broadcast(names);
  entries.resize(numbers.size());
  std::size_t at = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto length = static_cast<std::size_t>(lengths[i]);
    entries[i] = {names.substr(at, length), numbers[i].label, numbers[i].count, numbers[i].kind};
    at += length;
  }
}

}  // namespace

LocalIndex Mesh::elements() const {
  LocalIndex n = 0;
  for (const ElementBlock& b : blocks) n += b.size();
  return n;
}

const ElementBlock* Mesh::find_block(std::string_view name) const {
  return find_named(blocks, name);
}

const NodeSet* Mesh::find_node_set(std::string_view name) const {
  return find_named(node_sets, name);
}

const SideSet* Mesh::find_side_set(std::string_view name) const {
  return find_named(side_sets, name);
}

std::vector<LocalIndex> owned_elements(const ElementBlock& block, int rank) {
  std::vector<LocalIndex> owned;
  for (LocalIndex e = 0; e < block.size(); ++e)
    if (block.owners[static_cast<std::size_t>(e)] == rank) owned.push_back(e);
  return owned;
}

MeshSummary broadcast_summary(const Communicator& comm, const MeshSummary& summary) {
  MeshSummary same = summary;
  comm.broadcast(same.source);
  std::vector<std::int64_t> counts{same.nodes, same.elements};
  std::vector<Vec3> corners{same.low, same.high};
  comm.broadcast(counts);
  comm.broadcast(corners);
  same.nodes = counts[0], same.elements = counts[1];
  same.low = corners[0], same.high = corners[1];
  broadcast_entries(comm, same.blocks);
  broadcast_entries(comm, same.node_sets);
  broadcast_entries(comm, same.side_sets);
  return same;
}

}  // namespace tenon

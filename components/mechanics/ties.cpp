// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/ties.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "framework/comm/directory.hpp"

namespace tenon {

Ties::Ties(const Mesh& mesh, const std::vector<TiedSet>& sets) {
  if (sets.empty()) return;
  std::vector<Record> mine;
  for (const TiedSet& set : sets) {
    const std::vector<Record> found = find(mesh, set);
    mine.insert(mine.end(), found.begin(), found.end());
  }
  // A node that several sets name stays with the first.
  std::ranges::stable_sort(mine, {}, &Record::node);
  const auto again = std::ranges::unique(mine, {}, &Record::node);
  mine.erase(again.begin(), again.end());
  count_ = mesh.comm.sum(static_cast<std::int64_t>(mine.size()));
  refuse_chains(mesh, mine);
  std::vector<GlobalId> corners;
  for (const Record& record : mine) {
    nodes_.push_back(
        static_cast<LocalIndex>(std::ranges::lower_bound(mesh.node_ids, record.node) - mesh.node_ids.begin()));
    weights_.push_back(record.weight);
    for (std::size_t a = 0; a < max_side_nodes; ++a)
      corners.push_back(record.corner[a < static_cast<std::size_t>(record.corners) ? a : 0]);
  }
  corners_ = RemoteNodes(mesh, corners, "tied nodes: velocities");
  corner_velocity_.resize(corners.size());
  send_records(mesh, mine);
}

// Every rank that owns a node of a face gets the records of what is tied to it.
void Ties::send_records(const Mesh& mesh, const std::vector<Record>& mine) {
  std::vector<GlobalId> owned, corners;
  for (const LocalIndex n : mesh.owned_nodes) owned.push_back(mesh.node_ids[static_cast<std::size_t>(n)]);
  for (const Record& record : mine)
    corners.insert(corners.end(), record.corner.begin(), record.corner.begin() + record.corners);
  const std::vector<DirectoryEntry> entries = Directory(mesh.comm, owned, mesh.owned_nodes).find(corners);
  std::vector<int> ranks;
  std::vector<LocalIndex> items;
  std::size_t next = 0;
  for (std::size_t i = 0; i < mine.size(); ++i) {
    std::vector<int> to;
    for (int a = 0; a < mine[i].corners; ++a) to.push_back(entries[next++].rank);
    std::ranges::sort(to);
    to.erase(std::unique(to.begin(), to.end()), to.end());
    for (const int rank : to) ranks.push_back(rank), items.push_back(static_cast<LocalIndex>(i));
  }
  const ExchangePlan plan = ExchangePlan::to_ranks(mesh.comm, ranks, items, "tied nodes: set-up");
  std::vector<Record> records(static_cast<std::size_t>(plan.received()));
  plan.forward<Record>(mine, records);
  std::ranges::sort(records, {}, &Record::node);
  std::vector<GlobalId> tied;
  for (const Record& record : records) {
    for (std::size_t a = 0; a < static_cast<std::size_t>(record.corners); ++a) {
      const auto found = std::ranges::lower_bound(mesh.node_ids, record.corner[a]);
      const auto n = static_cast<LocalIndex>(found - mesh.node_ids.begin());
      if (found == mesh.node_ids.end() || *found != record.corner[a] || !mesh.owns_node(n)) continue;
      shares_.push_back({n, static_cast<std::int32_t>(tied.size()), record.weight[a]});
    }
    tied.push_back(record.node);
  }
  tied_ = RemoteNodes(mesh, tied, "tied nodes: forces");
  force_.resize(tied.size()), vector_.resize(tied.size());
}

void Ties::refuse_chains(const Mesh& mesh, const std::vector<Record>& mine) const {
  std::vector<GlobalId> ids, corners;
  std::vector<LocalIndex> index;
  for (const Record& record : mine) {
    ids.push_back(record.node), index.push_back(static_cast<LocalIndex>(index.size()));
    corners.insert(corners.end(), record.corner.begin(), record.corner.begin() + record.corners);
  }
  const std::vector<DirectoryEntry> entries = Directory(mesh.comm, ids, index).find(corners);
  std::optional<Error> error;
  for (std::size_t i = 0; i < entries.size() && !error; ++i)
    if (entries[i].rank >= 0)
      error = Error(ExitCode::usage,
                    fmt::format("tied: a node (global {}) is tied to a face and also belongs to a face that others are "
                                "tied to; swap the sets of one of the ties",
                                corners[i]));
  mesh.comm.throw_if_any(error);
}

std::vector<LocalIndex> Ties::face_nodes() const {
  std::vector<LocalIndex> nodes;
  for (const Share& share : shares_) nodes.push_back(share.to);
  return nodes;
}

void Ties::move_mass(NodalState& nodes) const {
  std::vector<double> mass(force_.size());
  tied_.pull<double>(nodes.mass, mass);
  for (const Share& share : shares_)
    nodes.mass[static_cast<std::size_t>(share.to)] += share.weight * mass[static_cast<std::size_t>(share.from)];
  for (const Share& share : shares_) {
    const auto n = static_cast<std::size_t>(share.to);
    nodes.inverse_mass[n] = 1 / nodes.mass[n];
  }
  for (const LocalIndex n : nodes_)
    nodes.mass[static_cast<std::size_t>(n)] = nodes.inverse_mass[static_cast<std::size_t>(n)] = 0;
}

void Ties::gather(NodalState& nodes) const {
  tied_.pull<ForceRow>(nodes.force, force_);
  for (const Share& share : shares_)
    for (int c = 0; c < 3; ++c)
      nodes.force[static_cast<std::size_t>(share.to)].v[c] +=
          share.weight * force_[static_cast<std::size_t>(share.from)].v[c];
  for (const LocalIndex n : nodes_) nodes.force[static_cast<std::size_t>(n)] = {};
}

std::int32_t Ties::index_of(LocalIndex node) const {
  const auto found = std::ranges::lower_bound(nodes_, node);
  return found != nodes_.end() && *found == node ? static_cast<std::int32_t>(found - nodes_.begin()) : -1;
}

std::vector<double> Ties::compliance(std::span<const double> values) const {
  std::vector<double> corner(corner_velocity_.size()), result(nodes_.size());
  corners_.pull<double>(values, corner);
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    for (std::size_t a = 0; a < max_side_nodes; ++a)
      result[i] += weights_[i][a] * weights_[i][a] * corner[max_side_nodes * i + a];
  return result;
}

void Ties::follow(NodalState& nodes) const {
  corners_.pull<Vec3>(nodes.velocity(), corner_velocity_);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Vec3 v{};
    for (std::size_t a = 0; a < max_side_nodes; ++a) v = v + weights_[i][a] * corner_velocity_[max_side_nodes * i + a];
    nodes.velocity()[static_cast<std::size_t>(nodes_[i])] = v;
  }
}

}  // namespace tenon

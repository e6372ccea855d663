// SPDX-License-Identifier: BSD-3-Clause
// Which nodes a connector joins; the same on any number of ranks.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "components/mechanics/connectors.hpp"
#include "framework/comm/directory.hpp"
#include "framework/search/distributed_search.hpp"

namespace tenon {

namespace {

using Ends = Connector::Ends;

struct Node {
  GlobalId id;
  Vec3 place;
};

/// What all ranks have, on all ranks, ascending by id.
std::vector<Node> everywhere(const Communicator& comm, const std::vector<Node>& mine) {
  std::vector<Node> all = comm.gather<Node>(mine);
  comm.broadcast(all);
  std::ranges::sort(all, {}, &Node::id);
  return all;
}

Node node_of(const Mesh& mesh, LocalIndex n) {
  return {mesh.node_ids[static_cast<std::size_t>(n)], mesh.coordinates[static_cast<std::size_t>(n)]};
}

std::vector<Node> owned_of_sets(const Mesh& mesh, const std::vector<std::string>& sets, const std::string& label) {
  std::vector<Node> nodes;
  for (const LocalIndex n : nodes_of_sets(mesh, sets, label))
    if (mesh.owns_node(n)) nodes.push_back(node_of(mesh, n));
  return nodes;
}

/// The nearest one; ties go to the smallest id, as `nodes` ascend.
const Node* nearest(const std::vector<Node>& nodes, const Vec3& place) {
  const Node* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Node& node : nodes) {
    const Vec3 d = node.place - place;
    if (dot(d, d) < least) least = dot(d, d), best = &node;
  }
  return best;
}

Node labelled(const Mesh& mesh, std::int64_t wanted, const std::string& label) {
  std::vector<Node> mine;
  for (const LocalIndex n : mesh.owned_nodes)
    if (mesh.node_labels[static_cast<std::size_t>(n)] == wanted) mine.push_back(node_of(mesh, n));
  const std::vector<Node> all = everywhere(mesh.comm, mine);
  if (all.empty()) throw Error(ExitCode::usage, fmt::format("{}: the mesh has no node {}", label, wanted));
  return all.front();
}

Node at_place(const Mesh& mesh, const Vec3& place, const std::string& label) {
  std::vector<Node> mine;
  for (const LocalIndex n : mesh.owned_nodes) mine.push_back(node_of(mesh, n));
  const Node* best = nearest(mine, place);
  const std::vector<Node> all = everywhere(mesh.comm, best ? std::vector{*best} : std::vector<Node>{});
  if (all.empty()) throw Error(ExitCode::usage, label + ": the mesh has no nodes");
  return *nearest(all, place);
}

/// A node that was found, and how far it is.
struct Found {
  GlobalId id = -1;
  Vec3 place{};
  double squared = std::numeric_limits<double>::infinity();
};

double extent(const Communicator& comm, std::span<const Node> a, std::span<const Node> b) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, 6> ends;
  ends.fill(-infinity);
  for (const std::span<const Node> nodes : {a, b})
    for (const Node& node : nodes)
      for (std::size_t c = 0; c < 3; ++c)
        ends[c] = std::max(ends[c], node.place[c]), ends[c + 3] = std::max(ends[c + 3], -node.place[c]);
  comm.max(std::span<double>(ends));
  return std::hypot(ends[0] + ends[3], ends[1] + ends[4], ends[2] + ends[5]);
}

/// Collective. The nearest of `others` (of all ranks) within reach of each of `firsts`, or id -1; of several at one
/// distance that of the smallest id.
std::vector<Found> nearest_within(const Communicator& comm, const std::vector<Node>& firsts,
                                  const std::vector<Node>& others, double reach) {
  std::vector<Box> boxes(others.size());
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < others.size(); ++i) boxes[i].add(others[i].place);
  for (const Node& node : firsts) points.push_back(node.place);
  const DistributedSearch search(comm, boxes, points, reach, "connectors: search");
  std::vector<Node> sent, arrived(static_cast<std::size_t>(search.boxes().received()));
  for (const LocalIndex box : search.box_of_send()) sent.push_back(others[static_cast<std::size_t>(box)]);
  search.boxes().forward<Node>(sent, arrived);
  std::vector<Found> there(search.arrived_points().size()), result(firsts.size());
  for (std::size_t i = 0; i < there.size(); ++i) {
    const Vec3& point = search.arrived_points()[i];
    search.tree().nearest(point, reach, [&](LocalIndex index) {
      const Node& node = arrived[static_cast<std::size_t>(index)];
      const Vec3 d = node.place - point;
      const double squared = dot(d, d);
      const bool better = std::tuple(squared, node.id) < std::tuple(there[i].squared, there[i].id);
      if (norm(d) <= reach && better) there[i] = {node.id, node.place, squared};
      return norm(d);
    });
  }
  search.points().reverse<Found>(there, result);
  return result;
}

/// Collective. Links to where the other end lives too; ascending by the first node.
std::vector<Link> at_both_ends(const Mesh& mesh, std::vector<Link> links) {
  std::vector<GlobalId> owned, ends;
  for (const LocalIndex n : mesh.owned_nodes) owned.push_back(mesh.node_ids[static_cast<std::size_t>(n)]);
  for (const Link& link : links) ends.push_back(link.second);
  const std::vector<DirectoryEntry> entries = Directory(mesh.comm, owned, mesh.owned_nodes).find(ends);
  std::vector<int> ranks;
  std::vector<LocalIndex> items;
  for (std::size_t i = 0; i < links.size(); ++i)
    if (entries[i].rank != mesh.comm.rank())
      ranks.push_back(entries[i].rank), items.push_back(static_cast<LocalIndex>(i));
  const ExchangePlan plan = ExchangePlan::to_ranks(mesh.comm, ranks, items, "connectors: set-up");
  std::vector<Link> more(static_cast<std::size_t>(plan.received()));
  plan.forward<Link>(links, more);
  links.insert(links.end(), more.begin(), more.end());
  std::ranges::sort(links, {}, &Link::first);
  return links;
}

std::vector<Link> links_between_sets(const Mesh& mesh, const Connector& connector) {
  const std::vector<Node> others = owned_of_sets(mesh, connector.other_sets, connector.label);
  std::vector<Node> firsts = owned_of_sets(mesh, connector.node_sets, connector.label);
  const std::int64_t count = mesh.comm.sum(static_cast<std::int64_t>(others.size()));
  if (count == 0 || mesh.comm.sum(static_cast<std::int64_t>(firsts.size())) == 0)
    throw Error(ExitCode::usage, connector.label + ": a node set is empty; expected at least one node in each");
  std::vector<Link> links;
  // As far as nodes are apart that fill the space of both sets, then twice as far for those that found none.
  double reach = extent(mesh.comm, firsts, others) / std::cbrt(static_cast<double>(count));
  for (; mesh.comm.any(!firsts.empty()); reach *= 2) {
    const std::vector<Found> found = nearest_within(mesh.comm, firsts, others, reach);
    std::vector<Node> left;
    for (std::size_t i = 0; i < firsts.size(); ++i)
      if (found[i].id >= 0)
        links.push_back({firsts[i].id, found[i].id, firsts[i].place, found[i].place});
      else
        left.push_back(firsts[i]);
    firsts = std::move(left);
  }
  return at_both_ends(mesh, std::move(links));
}

}  // namespace

std::vector<Link> find_links(const Mesh& mesh, const Connector& connector) {
  std::vector<Link> links;
  if (connector.ends == Ends::ground) {
    for (const Node& n : owned_of_sets(mesh, connector.node_sets, connector.label))
      links.push_back({n.id, -1, n.place, n.place});
    if (mesh.comm.sum(static_cast<std::int64_t>(links.size())) == 0)
      throw Error(ExitCode::usage, connector.label + ": the node sets are empty; expected at least one node");
    return links;
  }
  if (connector.ends == Ends::sets) {
    links = links_between_sets(mesh, connector);
  } else {
    const auto end = [&](std::size_t i) {
      return connector.ends == Ends::labels ? labelled(mesh, connector.node_labels[i], connector.label)
                                            : at_place(mesh, connector.place[i], connector.label);
    };
    const Node first = end(0), second = end(1);
    links.push_back({first.id, second.id, first.place, second.place});
  }
  std::optional<Error> error;
  for (const Link& link : links) {
    const Vec3& at = link.first_place;
    if (link.first == link.second)
      error = Error(ExitCode::usage,
                    fmt::format("{}: both ends are the node at ({:.6g}, {:.6g}, {:.6g}); expected two nodes",
                                connector.label, at[0], at[1], at[2]));
    else if (!connector.direction && norm(link.second_place - link.first_place) == 0)
      error = Error(ExitCode::usage, fmt::format("{}: two nodes at ({:.6g}, {:.6g}, {:.6g}) have no line between them; "
                                                 "give a direction",
                                                 connector.label, at[0], at[1], at[2]));
    if (error) break;
  }
  mesh.comm.throw_if_any(error);
  std::erase_if(links, [&](const Link& link) {
    const auto owned = [&](GlobalId id) {
      const auto found = std::ranges::lower_bound(mesh.node_ids, id);
      return found != mesh.node_ids.end() && *found == id &&
             mesh.owns_node(static_cast<LocalIndex>(found - mesh.node_ids.begin()));
    };
    return !owned(link.first) && !owned(link.second);
  });
  return links;
}

}  // namespace tenon

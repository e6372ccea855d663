// SPDX-License-Identifier: BSD-3-Clause
// Which nodes a connector joins; the same on any number of ranks.
#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "components/mechanics/connectors.hpp"

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

std::vector<Link> links_between_sets(const Mesh& mesh, const Connector& connector) {
  const std::vector<Node> others = everywhere(mesh.comm, owned_of_sets(mesh, connector.other_sets, connector.label));
  const std::vector<Node> firsts = everywhere(mesh.comm, owned_of_sets(mesh, connector.node_sets, connector.label));
  if (others.empty() || firsts.empty())
    throw Error(ExitCode::usage, connector.label + ": a node set is empty; expected at least one node in each");
  std::vector<Link> links;
  for (const Node& first : firsts) {
    const Node* second = nearest(others, first.place);
    links.push_back({first.id, second->id, first.place, second->place});
  }
  return links;
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
  for (const Link& link : links) {
    if (link.first == link.second)
      throw Error(ExitCode::usage,
                  fmt::format("{}: both ends are the node at ({:.6g}, {:.6g}, {:.6g}); expected two nodes",
                              connector.label, link.first_place[0], link.first_place[1], link.first_place[2]));
    if (!connector.direction && norm(link.second_place - link.first_place) == 0)
      throw Error(ExitCode::usage,
                  fmt::format("{}: two nodes at ({:.6g}, {:.6g}, {:.6g}) have no line between them; give "
                              "a direction",
                              connector.label, link.first_place[0], link.first_place[1], link.first_place[2]));
  }
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

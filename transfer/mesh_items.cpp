// SPDX-License-Identifier: BSD-3-Clause
#include "transfer/mesh_items.hpp"

#include <numeric>

namespace tenon::transfer {

namespace {

Items node_items(const Mesh& mesh) {
  Items items;
  items.ids = mesh.node_ids;
  items.owners = mesh.node_owners;
  items.own_at_owner.resize(mesh.node_ids.size());
  std::iota(items.own_at_owner.begin(), items.own_at_owner.end(), LocalIndex{0});
  // Every owned node says where it stands; the halo brings that to its ghosts.
  if (mesh.comm.size() > 1)
    mesh.node_halo.forward(std::span<const LocalIndex>(items.own_at_owner), std::span<LocalIndex>(items.own_at_owner));
  items.at_owner = items.own_at_owner;
  items.owned = mesh.owned_nodes;
  return items;
}

Items element_items(const Mesh& mesh) {
  Items items;
  for_each_element(mesh, [&](LocalIndex item, const ElementBlock& block, LocalIndex e) {
    const int owner = block.owners[static_cast<std::size_t>(e)];
    const bool mine = owner == mesh.comm.rank();
    items.own_ids.push_back(block.ids[static_cast<std::size_t>(e)]);
    items.own_owners.push_back(owner);
    items.own_at_owner.push_back(mine ? item : no_index);
    if (mine) items.own_owned.push_back(item);
  });
  items.ids = items.own_ids, items.owners = items.own_owners;
  items.at_owner = items.own_at_owner, items.owned = items.own_owned;
  return items;
}

}  // namespace

Items items_of(const Mesh& mesh, Location location) {
  return location == Location::node ? node_items(mesh) : element_items(mesh);
}

Items items_of(const PointCloud& cloud) {
  Items items;
  items.ids = cloud.ids;
  items.own_owners.assign(cloud.ids.size(), cloud.comm.rank());
  items.own_owned.resize(cloud.ids.size());
  std::iota(items.own_owned.begin(), items.own_owned.end(), LocalIndex{0});
  items.owners = items.own_owners;
  items.at_owner = items.owned = items.own_owned;
  return items;
}

std::int64_t Items::memory() const {
  return static_cast<std::int64_t>(own_ids.capacity() * sizeof(GlobalId) + own_owners.capacity() * sizeof(int) +
                                   (own_at_owner.capacity() + own_owned.capacity()) * sizeof(LocalIndex));
}

LocalIndex item_count(const Mesh& mesh, Location location) {
  return location == Location::node ? mesh.nodes() : mesh.elements();
}

Corners corners_of(const ElementBlock& block, LocalIndex element, std::span<const Vec3> coordinates) {
  Corners corners{};
  const auto nodes = block.nodes(element);
  for (std::size_t a = 0; a < nodes.size(); ++a) corners[a] = coordinates[static_cast<std::size_t>(nodes[a])];
  return corners;
}

Vec3 centre_of(ElementKind kind, const Corners& corners) {
  const int nodes = topology(kind).nodes;
  Vec3 sum{};
  for (int a = 0; a < nodes; ++a) sum = sum + corners[static_cast<std::size_t>(a)];
  return 1.0 / nodes * sum;
}

}  // namespace tenon::transfer

// SPDX-License-Identifier: BSD-3-Clause
// Summary, skin and derived sets of a whole mesh.
#include "framework/mesh/mesh_data.hpp"

#include <algorithm>

#include "framework/base/box.hpp"
#include "framework/mesh/facets.hpp"

namespace tenon {

namespace {

/// Nodes of the sides, ascending and unique.
std::vector<GlobalId> nodes_of(const MeshData& mesh, const std::vector<SideData>& sides) {
  const std::vector<GlobalId> first = first_elements(mesh);
  std::vector<GlobalId> nodes;
  for (const SideData& side : sides) {
    const auto after = std::upper_bound(first.begin(), first.end(), side.element);
    const auto b = static_cast<std::size_t>(after - first.begin()) - 1;
    const BlockData& block = mesh.blocks[b];
    const Topology& t = topology(block.kind);
    const auto at = static_cast<std::size_t>(side.element - first[b]) * static_cast<std::size_t>(t.nodes);
    const auto s = static_cast<std::size_t>(side.side);
    const auto count = static_cast<std::size_t>(t.side_nodes[s]);
    for (std::size_t i = 0; i < count; ++i) {
      nodes.push_back(block.connectivity[at + static_cast<std::size_t>(t.side[s][i])]);
      if (const int middle = middle_node(block.kind, t.side[s][i], t.side[s][(i + 1) % count]); middle >= 0)
        nodes.push_back(block.connectivity[at + static_cast<std::size_t>(middle)]);
    }
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

template <typename Set>
bool named(const std::vector<Set>& sets, const std::string& name) {
  return std::any_of(sets.begin(), sets.end(), [&](const Set& s) { return s.name == name; });
}

}  // namespace

MeshSummary summarise(const MeshData& mesh) {
  MeshSummary summary;
  summary.source = mesh.source;
  summary.nodes = static_cast<std::int64_t>(mesh.coordinates.size());
  summary.elements = static_cast<std::int64_t>(mesh.elements());
  Box box;
  for (const Vec3& x : mesh.coordinates) box.add(x);
  if (!box.empty()) summary.low = box.low, summary.high = box.high;
  for (const BlockData& b : mesh.blocks)
    summary.blocks.push_back({b.name, b.label, static_cast<std::int64_t>(b.size()), b.kind});
  for (const NodeSetData& s : mesh.node_sets)
    summary.node_sets.push_back({s.name, s.label, static_cast<std::int64_t>(s.nodes.size()), {}});
  for (const SideSetData& s : mesh.side_sets)
    summary.side_sets.push_back({s.name, s.label, static_cast<std::int64_t>(s.sides.size()), {}});
  return summary;
}

std::vector<SideData> skin(const MeshData& mesh) {
  std::vector<SideData> sides;
  for_each_facet(mesh, FacetChoice::solid_sides, [&](std::span<const Facet> group) {
    if (group.size() == 1) sides.push_back({group[0].element, group[0].side});
  });
  GlobalId element = 0;
  for (const BlockData& block : mesh.blocks) {
    const bool surface = topology(block.kind).dimension == 2;
    for (std::size_t e = 0; e < block.size(); ++e, ++element)
      if (surface) sides.push_back({element, 0});
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

void add_derived_sets(MeshData& mesh) {
  if (!named(mesh.side_sets, "skin")) {
    SideSetData all{"skin", 0, skin(mesh)};
    for (const SideSetData& s : mesh.side_sets) all.label = std::max(all.label, s.label);
    ++all.label;
    mesh.side_sets.push_back(std::move(all));
  }
  std::int64_t label = 0;
  for (const NodeSetData& s : mesh.node_sets) label = std::max(label, s.label);
  for (const SideSetData& s : mesh.side_sets)
    if (!named(mesh.node_sets, s.name)) mesh.node_sets.push_back({s.name, ++label, nodes_of(mesh, s.sides)});
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Finds the side of an element on which a boundary element of a Gmsh file lies.
#include "framework/mesh_files/gmsh_sets.hpp"

#include <algorithm>
#include <tuple>

namespace tenon::mesh_file {
namespace {

/// Whether two lists of the same nodes go round in the same sense.
bool same_sense(std::span<const GlobalId> a, std::span<const GlobalId> b) {
  if (a.size() < 3) return true;
  const auto start = std::find(b.begin(), b.end(), a[0]);
  const auto next = std::next(start) == b.end() ? b.begin() : std::next(start);
  return *next == a[1];
}

}  // namespace

SideFinder::SideFinder(const MeshData& mesh, int dimension, const std::vector<bool>& wanted) {
  GlobalId element = 0;
  for (const BlockData& block : mesh.blocks) {
    const Topology& shape = topology(block.kind);
    const auto nodes_each = static_cast<std::size_t>(shape.nodes);
    for (std::size_t e = 0; e < block.size(); ++e, ++element) {
      if (shape.dimension != dimension + 1) continue;
      const GlobalId* nodes = &block.connectivity[e * nodes_each];
      for (int s = 0; s < shape.sides; ++s) {
        const auto at = static_cast<std::size_t>(s);
        const auto count = static_cast<std::size_t>(shape.side_nodes[at]);
        if (dimension == 1 && count != 2) continue;  // a face of a surface element, not an edge
        Entry entry{{no_id, no_id, no_id, no_id}, {element, s}, {no_id, no_id, no_id, no_id}};
        bool all = true;
        for (std::size_t i = 0; i < count; ++i) {
          entry.ordered[i] = nodes[shape.side[at][i]];
          all = all && wanted[static_cast<std::size_t>(entry.ordered[i])];
        }
        if (!all) continue;
        entry.sorted = entry.ordered;
        std::sort(entry.sorted.begin(), entry.sorted.end());
        entries_.push_back(entry);
      }
    }
  }
  std::sort(entries_.begin(), entries_.end(),
            [](const Entry& a, const Entry& b) { return std::tie(a.sorted, a.side) < std::tie(b.sorted, b.side); });
}

std::optional<SideData> SideFinder::find(std::span<const GlobalId> nodes) const {
  Nodes key{no_id, no_id, no_id, no_id};
  std::copy(nodes.begin(), nodes.end(), key.begin());
  std::sort(key.begin(), key.end());
  const auto first = std::lower_bound(entries_.begin(), entries_.end(), key,
                                      [](const Entry& entry, const Nodes& k) { return entry.sorted < k; });
  if (first == entries_.end() || first->sorted != key) return std::nullopt;
  for (auto it = first; it != entries_.end() && it->sorted == key; ++it)
    if (same_sense(nodes, std::span(it->ordered).first(nodes.size()))) return it->side;
  return first->side;
}

}  // namespace tenon::mesh_file

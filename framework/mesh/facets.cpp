// SPDX-License-Identifier: BSD-3-Clause
// Facets are sorted into buckets by their least node; within the few of a bucket, equal ones are found by sorting.
#include "framework/mesh/facets.hpp"

#include <algorithm>
#include <array>

namespace tenon {

namespace {

using Key = std::array<GlobalId, max_side_nodes>;  // node numbers, ascending, padded with no_id at the end

struct KeyedFacet {
  Key key;
  Facet facet;
};

Key key_of(const Topology& t, const GlobalId* nodes, int side) {
  const auto s = static_cast<std::size_t>(side);
  const auto count = static_cast<std::size_t>(t.side_nodes[s]);
  Key key;
  key.fill(no_id);
  for (std::size_t i = 0; i < count; ++i) key[i] = nodes[t.side[s][i]];
  sort_few(std::span(key).first(count));
  return key;
}

/// Calls `work(facet, topology, nodes)` for every facet chosen, ascending.
template <typename Work>
void each(const MeshData& mesh, FacetChoice choice, const Work& work) {
  GlobalId element = 0;
  for (const BlockData& block : mesh.blocks) {
    const Topology& t = topology(block.kind);
    const bool surface = t.dimension == 2;
    const auto nodes = static_cast<std::size_t>(t.nodes);
    for (std::size_t e = 0; e < block.size(); ++e, ++element) {
      if (surface && choice == FacetChoice::solid_sides) continue;
      for (int s = 0; s < t.sides; ++s)
        if (!surface || s != 1) work(Facet{element, static_cast<std::int8_t>(s)}, t, &block.connectivity[e * nodes]);
    }
  }
}

}  // namespace

std::vector<GlobalId> first_elements(const MeshData& mesh) {
  std::vector<GlobalId> first{0};
  for (const BlockData& b : mesh.blocks) first.push_back(first.back() + static_cast<GlobalId>(b.size()));
  return first;
}

void for_each_facet(const MeshData& mesh, FacetChoice choice,
                    const std::function<void(std::span<const Facet>)>& visit) {
  const auto least_node = [](const Facet& f, const Topology& t, const GlobalId* nodes) {
    const auto s = static_cast<std::size_t>(f.side);
    GlobalId least = nodes[t.side[s][0]];
    for (int i = 1; i < t.side_nodes[s]; ++i) least = std::min(least, nodes[t.side[s][static_cast<std::size_t>(i)]]);
    return static_cast<std::size_t>(least);
  };
  std::vector<std::size_t> end(mesh.coordinates.size() + 1, 0);  // after filling: end of each bucket
  each(mesh, choice, [&](const Facet& f, const Topology& t, const GlobalId* n) { ++end[least_node(f, t, n) + 1]; });
  for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
  std::vector<Facet> facets(end.back());
  each(mesh, choice,
       [&](const Facet& f, const Topology& t, const GlobalId* n) { facets[end[least_node(f, t, n)]++] = f; });

  const std::vector<GlobalId> first = first_elements(mesh);
  std::vector<KeyedFacet> bucket;
  std::vector<Facet> group;
  std::size_t begin = 0;
  for (std::size_t node = 0; node + 1 < end.size(); begin = end[node++]) {
    bucket.clear();
    for (std::size_t i = begin; i < end[node]; ++i) {
      const auto after = std::upper_bound(first.begin(), first.end(), facets[i].element);
      const auto b = static_cast<std::size_t>(after - first.begin()) - 1;
      const Topology& t = topology(mesh.blocks[b].kind);
      const auto e = static_cast<std::size_t>(facets[i].element - first[b]) * static_cast<std::size_t>(t.nodes);
      bucket.push_back({key_of(t, &mesh.blocks[b].connectivity[e], facets[i].side), facets[i]});
    }
    std::stable_sort(bucket.begin(), bucket.end(),
                     [](const KeyedFacet& a, const KeyedFacet& b) { return a.key < b.key; });
    for (std::size_t i = 0; i < bucket.size();) {
      group.clear();
      const std::size_t start = i;
      for (; i < bucket.size() && bucket[i].key == bucket[start].key; ++i) group.push_back(bucket[i].facet);
      visit(group);
    }
  }
}

}  // namespace tenon

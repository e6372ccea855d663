// SPDX-License-Identifier: BSD-3-Clause
// Cuts a mesh into simplices that fit each other, whatever way the elements are turned.
#include <algorithm>
#include <array>

#include "framework/base/error.hpp"
#include "framework/mesh/facets.hpp"
#include "framework/mesh/generators.hpp"

namespace tenon {

namespace {

using Simplex = std::array<std::int8_t, 4>;  // positions of its nodes in the old element; -1 pads a triangle
constexpr std::size_t most_pieces = 6;

/// The pieces of one element.
struct Pieces {
  std::array<Simplex, most_pieces> piece;
  std::size_t count = 0;
};

/// Position among the nodes of a side that bears the least node number.
std::size_t least_of(std::span<const std::int8_t> side, const GlobalId* nodes) {
  const auto least =
      std::min_element(side.begin(), side.end(), [&](std::int8_t a, std::int8_t b) { return nodes[a] < nodes[b]; });
  return static_cast<std::size_t>(least - side.begin());
}

/// Triangles of a side of three or four nodes: the fan from its least node.
template <typename Visit>
void each_triangle(std::span<const std::int8_t> side, const GlobalId* nodes, const Visit& visit) {
  const std::size_t n = side.size(), first = least_of(side, nodes);
  for (std::size_t i = 1; i + 1 < n; ++i) visit(side[first], side[(first + i) % n], side[(first + i + 1) % n]);
}

Pieces cut(const Topology& t, const GlobalId* nodes) {
  Pieces pieces;
  if (t.dimension == 2) {
    each_triangle(std::span(t.side[0]).first(static_cast<std::size_t>(t.nodes)), nodes,
                  [&](std::int8_t a, std::int8_t b, std::int8_t c) {
                    pieces.piece[pieces.count++] = {a, b, c, -1};
                  });
    return pieces;
  }
  if (t.kind == ElementKind::tet4) return {{{{0, 1, 2, 3}}}, 1};
  const auto apex = static_cast<std::int8_t>(std::min_element(nodes, nodes + t.nodes) - nodes);
  for (std::size_t s = 0; s < static_cast<std::size_t>(t.sides); ++s) {
    const auto side = std::span(t.side[s]).first(static_cast<std::size_t>(t.side_nodes[s]));
    if (std::find(side.begin(), side.end(), apex) != side.end()) continue;
    // The side is seen counterclockwise from outside, so the cone from within is positive.
    each_triangle(side, nodes, [&](std::int8_t a, std::int8_t b, std::int8_t c) {
      pieces.piece[pieces.count++] = {apex, a, b, c};
    });
  }
  return pieces;
}

/// Whether every node of side `s` of the new element is one of `old_side`.
bool lies_on(const Topology& t, std::size_t s, const Simplex& piece, std::span<const std::int8_t> old_side) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(t.side_nodes[s]); ++i) {
    const std::int8_t node = piece[static_cast<std::size_t>(t.side[s][i])];
    if (std::find(old_side.begin(), old_side.end(), node) == old_side.end()) return false;
  }
  return true;
}

/// The sides of the pieces that make up side `side` of the old element.
template <typename Visit>
void each_new_side(const Topology& from, const Topology& to, const Pieces& pieces, int side, const Visit& visit) {
  const auto s = static_cast<std::size_t>(side);
  const auto old_side = std::span(from.side[s]).first(static_cast<std::size_t>(from.side_nodes[s]));
  for (std::size_t p = 0; p < pieces.count; ++p) {
    if (from.dimension == 2 && side < 2) {  // the two faces of a surface element stay what they are
      visit(p, side);
      continue;
    }
    for (int n = from.dimension == 2 ? 2 : 0; n < to.sides; ++n)
      if (lies_on(to, static_cast<std::size_t>(n), pieces.piece[p], old_side)) visit(p, n);
  }
}

const Topology& simplex_of(const Topology& t) {
  return topology(t.dimension == 3 ? ElementKind::tet4 : ElementKind::tri3);
}

BlockData cut_block(const BlockData& block, std::int64_t& label, GlobalId& element,
                    std::vector<GlobalId>& first_piece) {
  const Topology& from = topology(block.kind);
  const Topology& to = simplex_of(from);
  BlockData result{block.name, block.label, to.kind, {}, {}};
  for (std::size_t e = 0; e < block.size(); ++e) {
    const GlobalId* nodes = &block.connectivity[e * static_cast<std::size_t>(from.nodes)];
    const Pieces pieces = cut(from, nodes);
    first_piece.push_back(element);
    element += static_cast<GlobalId>(pieces.count);
    for (std::size_t p = 0; p < pieces.count; ++p) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(to.nodes); ++i)
        result.connectivity.push_back(nodes[pieces.piece[p][i]]);
      result.labels.push_back(label++);
    }
  }
  return result;
}

}  // namespace

MeshData tetrahedralise(const MeshData& mesh) {
  for (const BlockData& block : mesh.blocks)
    if (!middle_nodes(block.kind).empty())
      throw Error(ExitCode::usage, mesh.source + ": block '" + block.name + "' consists of " +
                                       std::string(topology(block.kind).name) +
                                       "; only linear elements are cut into tetrahedra");
  MeshData result = mesh;
  result.blocks.clear();
  result.side_sets.clear();
  std::vector<GlobalId> first_piece;  // of each old element, the number of its first new one
  std::int64_t label = 1;
  GlobalId element = 0;
  for (const BlockData& block : mesh.blocks) result.blocks.push_back(cut_block(block, label, element, first_piece));

  const std::vector<GlobalId> first = first_elements(mesh);
  for (const SideSetData& set : mesh.side_sets) {
    SideSetData sides{set.name, set.label, {}};
    for (const SideData& side : set.sides) {
      const auto after = std::upper_bound(first.begin(), first.end(), side.element);
      const auto b = static_cast<std::size_t>(after - first.begin()) - 1;
      const Topology& from = topology(mesh.blocks[b].kind);
      const auto at = static_cast<std::size_t>(side.element - first[b]) * static_cast<std::size_t>(from.nodes);
      const Pieces pieces = cut(from, &mesh.blocks[b].connectivity[at]);
      const GlobalId start = first_piece[static_cast<std::size_t>(side.element)];
      each_new_side(from, simplex_of(from), pieces, side.side, [&](std::size_t p, int n) {
        sides.sides.push_back({start + static_cast<GlobalId>(p), n});
      });
    }
    std::sort(sides.sides.begin(), sides.sides.end());
    result.side_sets.push_back(std::move(sides));
  }
  return result;
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Node and side tables of the element kinds, and their names in the file formats.
#include "framework/mesh/topology.hpp"

#include <string>

namespace tenon {

namespace {

// Side tables: Exodus II manual [SY94], section 4.8, minus one. Sides 0 and 1 of surface elements are their faces.
constexpr std::array<Topology, element_kinds> topologies{{
    {ElementKind::hex8,
     "hex8",
     3,
     8,
     6,
     {4, 4, 4, 4, 4, 4},
     {{{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {0, 3, 2, 1}, {4, 5, 6, 7}}},
     12,
     5,
     "hex hex8 hexahedron hexa"},
    {ElementKind::tet4,
     "tet4",
     3,
     4,
     4,
     {3, 3, 3, 3},
     {{{0, 1, 3, -1}, {1, 2, 3, -1}, {0, 3, 2, -1}, {0, 2, 1, -1}}},
     10,
     4,
     "tet tet4 tetra tetra4 tetrahedron"},
    {ElementKind::wedge6,
     "wedge6",
     3,
     6,
     5,
     {4, 4, 4, 3, 3},
     {{{0, 1, 4, 3}, {1, 2, 5, 4}, {0, 3, 5, 2}, {0, 2, 1, -1}, {3, 4, 5, -1}}},
     13,
     6,
     "wedge wedge6 prism penta"},
    {ElementKind::pyramid5,
     "pyramid5",
     3,
     5,
     5,
     {3, 3, 3, 3, 4},
     {{{0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {0, 4, 3, -1}, {0, 3, 2, 1}}},
     14,
     7,
     "pyramid pyramid5 pyra"},
    {ElementKind::quad4,
     "quad4",
     2,
     4,
     6,
     {4, 4, 2, 2, 2, 2},
     {{{0, 1, 2, 3}, {0, 3, 2, 1}, {0, 1, -1, -1}, {1, 2, -1, -1}, {2, 3, -1, -1}, {3, 0, -1, -1}}},
     9,
     3,
     "quad quad4 quadrilateral shell shell4"},
    {ElementKind::tri3,
     "tri3",
     2,
     3,
     5,
     {3, 3, 2, 2, 2},
     {{{0, 1, 2, -1}, {0, 2, 1, -1}, {0, 1, -1, -1}, {1, 2, -1, -1}, {2, 0, -1, -1}}},
     5,
     2,
     "tri tri3 triangle trishell trishell3 shell shell3"},
    {ElementKind::hex20,
     "hex20",
     3,
     20,
     6,
     {4, 4, 4, 4, 4, 4},
     {{{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 4, 7, 3}, {0, 3, 2, 1}, {4, 5, 6, 7}}},
     25,
     17,
     "hex hex20 hexahedron hexa"},
    {ElementKind::tet10,
     "tet10",
     3,
     10,
     4,
     {3, 3, 3, 3},
     {{{0, 1, 3, -1}, {1, 2, 3, -1}, {0, 3, 2, -1}, {0, 2, 1, -1}}},
     24,
     11,
     "tet tet10 tetra tetra10 tetrahedron"},
    {ElementKind::particle, "particle", 0, 1, 0, {}, {}, 1, 15, "sphere circle particle"},
}};

constexpr std::array<CornerPair, 12> hex_edges{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
constexpr std::array<CornerPair, 6> tet_edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

// Exodus [SY94] has the upright edges of a hex20 before those of its top; Gmsh [GR09] goes round corner by corner, and
// exchanges the last two nodes of a tet10.
constexpr std::array<std::int8_t, 20> exodus_hex20{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,
                                                   10, 11, 16, 17, 18, 19, 12, 13, 14, 15};
constexpr std::array<std::int8_t, 20> gmsh_hex20{0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15};
constexpr std::array<std::int8_t, 10> gmsh_tet10{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};

/// Whether `word` is one of the space-separated words of `list`.
bool among(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    const std::size_t end = list.find(' ');
    if (list.substr(0, end) == word) return true;
    list = end == std::string_view::npos ? std::string_view{} : list.substr(end + 1);
  }
  return false;
}

}  // namespace

const Topology& topology(ElementKind kind) {
  return topologies[static_cast<std::size_t>(kind)];
}

std::span<const CornerPair> middle_nodes(ElementKind kind) {
  if (kind == ElementKind::hex20) return hex_edges;
  if (kind == ElementKind::tet10) return tet_edges;
  return {};
}

int corner_count(ElementKind kind) {
  return topology(kind).nodes - static_cast<int>(middle_nodes(kind).size());
}

int middle_node(ElementKind kind, int corner_a, int corner_b) {
  int node = corner_count(kind);
  for (const CornerPair& edge : middle_nodes(kind)) {
    if ((edge[0] == corner_a && edge[1] == corner_b) || (edge[0] == corner_b && edge[1] == corner_a)) return node;
    ++node;
  }
  return -1;
}

std::span<const std::int8_t> exodus_node_order(ElementKind kind) {
  if (kind == ElementKind::hex20) return exodus_hex20;
  return {};
}

std::span<const std::int8_t> gmsh_node_order(ElementKind kind) {
  if (kind == ElementKind::hex20) return gmsh_hex20;
  if (kind == ElementKind::tet10) return gmsh_tet10;
  return {};
}

std::optional<ElementKind> kind_of_exodus(std::string_view type, int nodes) {
  std::string lower;
  for (const char c : type) lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  for (const Topology& t : topologies)
    if (t.nodes == nodes && among(t.exodus_names, lower)) return t.kind;
  return std::nullopt;
}

std::optional<ElementKind> kind_of_gmsh(int type) {
  for (const Topology& t : topologies)
    if (t.gmsh_type == type) return t.kind;
  return std::nullopt;
}

std::optional<ElementKind> kind_of_vtk(int type) {
  for (const Topology& t : topologies)
    if (t.vtk_type == type) return t.kind;
  return std::nullopt;
}

}  // namespace tenon

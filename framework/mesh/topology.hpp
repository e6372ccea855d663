// SPDX-License-Identifier: BSD-3-Clause
// What each kind of element looks like: nodes, sides, names in the file formats.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace tenon {

/// A particle is an element of one node, without sides.
enum class ElementKind : std::uint8_t { hex8, tet4, wedge6, pyramid5, quad4, tri3, hex20, tet10, particle };
inline constexpr int element_kinds = 9;
inline constexpr int max_element_nodes = 20;
inline constexpr int max_linear_nodes = 8;  ///< of elements with nodes at their corners only
inline constexpr int max_sides = 6;
inline constexpr int max_side_nodes = 4;

/// Node order is that of VTK, and of Exodus but for hex20; side order that of Exodus (0-based), with nodes ordered so
/// that the right-hand normal points out. The sides of quad4 and tri3 are first the two faces (1: right-hand normal, 2:
/// the reverse), then the edges, as in Exodus shells. The sides of hex20 and tet10 list their corners only.
struct Topology {
  ElementKind kind;
  std::string_view name;  ///< "hex8"
  int dimension;          ///< of the element itself: 3 solid, 2 surface, 0 particle
  int nodes;
  int sides;
  std::array<std::int8_t, max_sides> side_nodes;  ///< nodes of each side
  std::array<std::array<std::int8_t, max_side_nodes>, max_sides> side;
  int vtk_type;
  int gmsh_type;
  std::string_view exodus_names;  ///< spellings of the type in Exodus files, lower case, separated by spaces
};

const Topology& topology(ElementKind kind);

/// The two corners that each middle node lies between, in VTK's order of the middle nodes, which stand behind the
/// corners; empty for linear kinds.
using CornerPair = std::array<std::int8_t, 2>;
std::span<const CornerPair> middle_nodes(ElementKind kind);
/// Nodes at corners.
int corner_count(ElementKind kind);
/// The middle node between two corners; -1 if there is none.
int middle_node(ElementKind kind, int corner_a, int corner_b);

/// Where node i of an element stands in a file of that format; empty where the order is ours, which is VTK's.
std::span<const std::int8_t> exodus_node_order(ElementKind kind);
std::span<const std::int8_t> gmsh_node_order(ElementKind kind);

/// The kind of that many-noded Exodus type ("HEX", 8); empty if there is none.
std::optional<ElementKind> kind_of_exodus(std::string_view type, int nodes);
std::optional<ElementKind> kind_of_gmsh(int type);
std::optional<ElementKind> kind_of_vtk(int type);

}  // namespace tenon

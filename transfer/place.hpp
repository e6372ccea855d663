// SPDX-License-Identifier: BSD-3-Clause
// The serial heart of every transfer: which of some elements holds a point, and with which shape weights.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "framework/base/box.hpp"
#include "framework/mesh/topology.hpp"
#include "framework/search/box_tree.hpp"
#include "transfer/mesh_items.hpp"

namespace tenon::transfer {

/// An element as it travels: all that is needed to place points in it, bit for bit as its owner has it.
struct ElementPacket {
  Corners corners{};  ///< m
  GlobalId id = no_id;
  double size = 0;             ///< diagonal of its box, m
  LocalIndex item = no_index;  ///< place among all elements of its owner
  int owner = -1;
  ElementKind kind = ElementKind::hex8;

  std::span<const Vec3> corner_span() const { return {corners.data(), static_cast<std::size_t>(topology(kind).nodes)}; }
};

/// Where a point lies.
struct Placement {
  GlobalId element = no_id;                 ///< that contains it, or the nearest one; no_id: nothing within reach
  double distance = 0;                      ///< from that element, m; 0 inside
  std::array<double, max_nodes> weights{};  ///< of the element's nodes; their sum is 1
  LocalIndex item = no_index;               ///< the element's place at its owner
  int owner = -1;
  ElementKind kind = ElementKind::hex8;
  bool outside = false;
};

/// How points are placed.
struct PlaceRules {
  double tolerance = 1e-9;   ///< points nearer than this fraction of the element's size count as inside
  bool extrapolate = false;  ///< weights outside: linear-exact instead of those of the nearest point (which are >= 0)
};

/// Of the candidates (indices into `elements`, which are put in order of id) the one that contains the point: the
/// smallest id of those that contain it to round-off, else the one that it oversteps least within the tolerance. No
/// element if there is none. Depends on nothing but the set of candidates.
Placement place_inside(std::span<const ElementPacket> elements, std::span<LocalIndex> candidates, const Vec3& point,
                       const PlaceRules& rules);

/// Whether a point that oversteps an element by so many half widths needs to look no further.
bool ends_search(double overshoot, const PlaceRules& rules);
/// A placement there, without weights.
Placement in_element(const ElementPacket& element);
/// Weights of a point at local coordinates xi of the element, which are put within it; exactly one corner if it is that
/// corner.
void set_weights_at(Placement& place, const ElementPacket& element, const Vec3& point, const Vec3& xi);

/// The nearest of all elements whose boxes are in the tree, at most `reach` away; ties go to the smallest id. No
/// element if there is none. `tree` holds boxes in the order of `elements`, each a little larger than its element.
Placement place_nearest(std::span<const ElementPacket> elements, const BoxTree& tree, const Vec3& point, double reach,
                        const PlaceRules& rules);

/// Makes the sum of the weights 1 to within an ulp, dropping what is round-off.
void make_partition_of_unity(std::span<double> weights);

}  // namespace tenon::transfer

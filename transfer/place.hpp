// SPDX-License-Identifier: BSD-3-Clause
// The serial heart of every transfer: which of some elements holds a point, and where in it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "framework/search/box_tree.hpp"
#include "transfer/element_set.hpp"

namespace tenon::transfer {

enum class PlaceState : std::uint8_t {
  inside,    ///< within the element, or beside it by less than the tolerance; xi is within
  outside,   ///< xi is the nearest point's
  extended,  ///< outside, and the shape functions are evaluated there: xi is where the point is
  linear     ///< outside, and the shape functions are extended linearly from the element's centre to xi
};

/// Where a point lies.
struct Placement {
  GlobalId element = no_id;        ///< that contains it, or the nearest one; no_id: nothing within reach
  double distance = 0;             ///< from that element, m; 0 inside
  Vec3 xi{};                       ///< local coordinates
  LocalIndex item = no_index;      ///< the element's place among all elements of its owner's mesh
  LocalIndex at_owner = no_index;  ///< the element's place in its owner's ElementSet
  LocalIndex here = no_index;      ///< and in that in which it was found
  std::int32_t owner = -1;
  ElementKind kind = ElementKind::hex8;
  PlaceState state = PlaceState::inside;
  std::uint8_t work = 0;  ///< elements that were tried, up to 255: how costly the point is

  bool found() const { return element != no_id; }
  bool is_outside() const { return state != PlaceState::inside; }
  std::size_t nodes() const { return static_cast<std::size_t>(topology(kind).nodes); }
};

/// Shape functions of the placement, in the order of the element's nodes (as many): they reproduce linear fields, add
/// up to 1 to within an ulp, and are exactly 0 or 1 at a corner; inside and outside, linear kinds have none below 0.
void shape_weights(const Placement& place, std::span<double> weights);

/// How points are placed.
struct PlaceRules {
  double tolerance = 1e-9;   ///< points nearer than this fraction of the element's size count as inside
  bool extrapolate = false;  ///< outside: linear-exact instead of the value at the nearest point
};

/// Of the candidates (which are put in order of id) the one that contains the point: the smallest id of those that
/// contain it to round-off, else the one that it oversteps least within the tolerance. No element if there is none.
/// Depends on nothing but the set of candidates. Surface elements contain nothing.
Placement place_inside(const ElementSet& elements, std::span<LocalIndex> candidates, const Vec3& point,
                       const PlaceRules& rules);

/// Whether a point that oversteps an element by so many half widths needs to look no further.
bool ends_search(double overshoot, const PlaceRules& rules);
/// A placement in element e, at xi put within it; exactly a corner's if the point is that corner.
Placement in_element(const ElementSet& elements, LocalIndex e, const Vec3& point, const Vec3& xi);

/// The nearest of all elements whose boxes are in the tree, at most `reach` away; ties go to the smallest id. No
/// element if there is none. `tree` holds `elements.boxes`.
Placement place_nearest(const ElementSet& elements, const BoxTree& tree, const Vec3& point, double reach,
                        const PlaceRules& rules);

/// The nearest local coordinates within the reference element.
Vec3 clamped(ElementKind kind, Vec3 xi);

/// How deep inside the reference element xi is, in local coordinates; below 0 outside. Solids of first order.
double depth(ElementKind kind, const Vec3& xi);

/// Makes the sum of the weights 1 to within an ulp, dropping what is round-off.
void make_partition_of_unity(std::span<double> weights);

}  // namespace tenon::transfer

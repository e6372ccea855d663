// SPDX-License-Identifier: BSD-3-Clause
// What two moving edges may do to each other in one step.
#pragma once

#include <array>

#include "framework/base/types.hpp"

namespace tenon::contact {

struct EdgeShape {
  std::array<Vec3, 2> x;  ///< m
};

/// A constraint for one step: normal . (place on first - place on second) >= clearance at its end.
struct EdgeTouch {
  double first, second;  ///< 0..1 along each
  Vec3 normal;           ///< unit, from the second edge to the first
  double gap, end_gap;   ///< m, at start and end of the step, for this normal and these places, less the clearance
};

/// False if the edges cannot touch in this step between their ends (contact at an end belongs to node and face), or are
/// within a degree of parallel.
///
/// outward: of each edge at the start, HALF THE SUM of the unit outward normals of the two faces beside it, not brought
/// to unit length, so that its length tells how sharp the edge is; zero for rims of shells and for edges that have no
/// outside. Only convex edges may have one. A direction of contact must lie between the normals of the two faces; an
/// edge between faces that are flat to each other (length over 0.999) touches nothing, its faces do. clearance, depth,
/// margin: as for touch_face.
bool touch_edges(const EdgeShape& first0, const EdgeShape& first1, const EdgeShape& second0, const EdgeShape& second1,
                 const Vec3& outward_first, const Vec3& outward_second, double clearance, double depth, double margin,
                 EdgeTouch& touch);

}  // namespace tenon::contact

// SPDX-License-Identifier: BSD-3-Clause
// What lies opposite to points of one surface on another one, across all ranks.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "framework/mesh/mesh.hpp"

namespace tenon::thermal {

/// Corners of a side in order, so that the right-hand normal points out of the body.
struct SideCorners {
  std::array<LocalIndex, max_side_nodes> nodes{};
  std::size_t count = 0;
  ElementKind kind() const { return count == 3 ? ElementKind::tri3 : ElementKind::quad4; }
};
SideCorners side_corners(const Mesh& mesh, const Side& side);

/// Unit normal of a flat side, mean normal of a warped one.
Vec3 side_normal(std::span<const Vec3> corners);

/// A point that looks along the normal of its own surface.
struct Looker {
  Vec3 place, normal;  ///< m, unit vector
  double touch = 0;    ///< m; up to here the direction of what lies opposite does not matter
  double reach = 0;    ///< m; farther away is nothing
};

struct Opposite {
  std::array<GlobalId, max_side_nodes> nodes{no_id, no_id, no_id, no_id};
  std::array<double, max_side_nodes> weights{};  ///< shape functions at the nearest point
  int count = 0;                                 ///< corners; 0 where nothing lies opposite
  double gap = 0;                                ///< m; 0 where the surfaces overlap
};

/// Collective. The nearest point of the sides of `surface` whose normals face that of the looker within 60 degrees.
/// Beyond `touch` it must lie within 45 degrees of the looker's normal, so that what ends beside a gap is not across
/// it. Among equally near sides the one of the least global number. The same bits on any number of ranks. `reach` is
/// the greatest of all lookers, the same on every rank.
std::vector<Opposite> opposite_points(const Mesh& mesh, const SideSet& surface, std::span<const Vec3> coordinates,
                                      std::span<const Looker> lookers, double reach, const std::string& name);

}  // namespace tenon::thermal

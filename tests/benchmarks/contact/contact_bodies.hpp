// SPDX-License-Identifier: BSD-3-Clause
// Bodies whose steps with contact are timed.
#pragma once

#include "components/mechanics/mechanics.hpp"
#include "framework/mesh/mesh_data.hpp"

namespace tenon::bench {

/// A can (diameter 1 m) that an inclined wall crushes from above: section 4.1 of [APHDB97]. So that a few hundred
/// steps show it fold, its upper half comes as bellows of straight flanks and round crests, a gap of one and a half
/// wall thicknesses between the flanks; only the crushing is left to do. Lengths follow from the number of elements:
/// the sides of the wall's elements are as long as the wall is thick.
struct CrushedCan {
  std::int64_t elements = 100'000;  ///< about
  int layers = 2;                   ///< hexahedra through the wall; 0: shells
  double speed = 130;               ///< m/s, of the wall
  double tilt = 5;                  ///< degrees

  double size() const;  ///< m, of the sides of elements
};
/// Blocks "can" and "wall"; node set "rim" where the can stands.
MeshData make_mesh(const CrushedCan& can);
/// Both perfectly plastic, of the properties of steel.
MechanicsOptions options_of(const CrushedCan& can);

/// Two elastic blocks "left" and "right" of n x n x n/2 hexahedra, a length of theirs apart.
MeshData two_blocks(int n);
MechanicsOptions options_of_blocks();

}  // namespace tenon::bench

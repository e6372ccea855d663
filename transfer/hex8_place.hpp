// SPDX-License-Identifier: BSD-3-Clause
// Several points at once in as many trilinear hexahedra: local coordinates by Newton's method.
#pragma once

#include <array>
#include <cstddef>

#include "framework/base/pack.hpp"
#include "framework/base/types.hpp"

namespace tenon::transfer {

/// Points that are worked on side by side: as many as a register holds.
#ifdef __AVX512F__
inline constexpr std::size_t hex_lanes = 8;
#else
inline constexpr std::size_t hex_lanes = 4;
#endif

/// A point and the corners of an element: x[nodes[a]]. One more double may be read behind each.
struct HexTask {
  const LocalIndex* nodes;
  const Vec3* point;
};

struct HexPlaces {
  std::array<Vec3, hex_lanes> xi;           ///< put within the element; exactly a corner's if the point is that corner
  std::array<double, hex_lanes> overshoot;  ///< how far outside it is, in half widths; 0 inside
  /// Newton has reached round-off where the map keeps its orientation. Others need more care.
  std::array<bool, hex_lanes> converged;
  std::array<double, hex_lanes> depth;  ///< how deep inside, in half widths; below 0 outside
};

/// Newton from the centre, with steps no longer than the way from the centre plus 1, as inverse_map goes; a point is
/// left where its own last step was below 1e-8, whatever the others do. Those whose residual doubles, that are not
/// there after 14 steps, or that end where the map is folded have not converged. Each point by itself: the same bits in
/// any company (there is one copy of the code, which may contract products and sums).
void place_in_hexahedra(const Vec3* x, const std::array<HexTask, hex_lanes>& tasks, HexPlaces& places);

}  // namespace tenon::transfer

// SPDX-License-Identifier: BSD-3-Clause
// Principal values and directions of eight symmetric tensors.
#pragma once

#include <cmath>

#include "components/materials/lane_root.hpp"

namespace tenon {

/// `value[i]` belongs to the unit vector `axis[i][0..2]`; in no particular order.
struct PrincipalLanes {
  LaneValues value[3], axis[3][3];
};

/// Cyclic Jacobi rotations, [GV13] ch. 8.5: accurate for any tensor, equal and zero values included. An off-diagonal
/// value that is negligible is not rotated away, so that a lane that is done stands still while others go on.
inline PrincipalLanes principal(const Batch<6>& s) {
  constexpr int budget = 12;
  constexpr double negligible = 1e-18;
  constexpr int pairs[3][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}};
  PrincipalLanes p;
  LaneValues off[3];  // xy yz zx: between 0 and 1, 1 and 2, 2 and 0
  for (int i = 0; i < 3; ++i)
#pragma GCC ivdep
    for (int l = 0; l < lanes; ++l) {
      p.value[i][l] = s.v[i][l], off[i][l] = s.v[i + 3][l];
      for (int j = 0; j < 3; ++j) p.axis[i][j][l] = i == j ? 1 : 0;
    }
  LaneValues turned;
  for (int sweep = 0; sweep < budget; ++sweep) {
#pragma GCC ivdep
    for (int l = 0; l < lanes; ++l) turned[l] = 0;
    for (const auto& [a, b, c] : pairs) {
      LaneValues &between = off[a], &b_to_c = off[b], &c_to_a = off[c];
#pragma GCC ivdep
      for (int l = 0; l < lanes; ++l) {
        const double aa = p.value[a][l], bb = p.value[b][l], ab = between[l];
        const double large = std::abs(ab) > negligible * (std::abs(aa) + std::abs(bb)) ? 1.0 : 0.0;
        const double theta = 0.5 * (bb - aa) / (large > 0 ? ab : 1.0);
        const double tangent = 1 / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double t = large > 0 ? std::copysign(tangent, theta) : 0.0;
        const double cosine = 1 / std::sqrt(t * t + 1), sine = t * cosine;
        turned[l] += large;
        p.value[a][l] = aa - t * ab;
        p.value[b][l] = bb + t * ab;
        between[l] = large > 0 ? 0.0 : ab;
        const double bc = b_to_c[l], ca = c_to_a[l];
        c_to_a[l] = cosine * ca - sine * bc;
        b_to_c[l] = sine * ca + cosine * bc;
        for (int j = 0; j < 3; ++j) {
          const double na = p.axis[a][j][l], nb = p.axis[b][j][l];
          p.axis[a][j][l] = cosine * na - sine * nb;
          p.axis[b][j][l] = sine * na + cosine * nb;
        }
      }
    }
    LaneValues any;
#pragma GCC ivdep
    for (int l = 0; l < lanes; ++l) any[l] = turned[l] > 0 ? 1.0 : 0.0;
    if (!any_lane(any)) break;
  }
  return p;
}

}  // namespace tenon

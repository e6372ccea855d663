// SPDX-License-Identifier: BSD-3-Clause
// The point of a face that is closest to a point in space.
#pragma once

#include <array>

#include "framework/base/types.hpp"

namespace tenon::contact {

/// Three or four corners, outward by the right-hand rule. Four corners span a bilinear patch, which may be warped.
struct FaceShape {
  int corners;
  std::array<Vec3, 4> x;  ///< m
};

struct ClosestPoint {
  Vec3 point;                     ///< m
  std::array<double, 4> weights;  ///< of the corners, sum 1, none negative
  double distance;                ///< m
  bool inside;                    ///< in the face's interior, not on its rim
  int feature;                    ///< on the rim: edge k from corner k to the next is k, corner k is 4 + k; inside: -1
};

/// The global minimum of the distance over the face, also where the patch is warped, folded, a sliver or collapsed to a
/// line or a point. Of points at the same distance that of the edge with the smallest number.
ClosestPoint closest_point(const FaceShape& face, const Vec3& x);

/// Unit normal of the face where its corners have these weights; the zero vector where the face has no area.
Vec3 face_normal(const FaceShape& face, const std::array<double, 4>& weights);

}  // namespace tenon::contact

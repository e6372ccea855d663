// SPDX-License-Identifier: BSD-3-Clause
// What a moving node and a moving face may do to each other in one step.
#pragma once

#include "components/contact_geometry/closest_point.hpp"

namespace tenon::contact {

/// A constraint for one step: normal . (node - sum of weights x corners) >= clearance at its end. Positions move in
/// straight lines during the step; "start" and "end" are its two configurations.
struct Touch {
  std::array<double, 4> weights;  ///< where on the face
  Vec3 normal;                    ///< unit, from the face to the node (side included)
  double gap;                     ///< m, at the start, for this normal and these weights, less the clearance
  double end_gap;                 ///< m, the same at the end
  bool inside;                    ///< the foot is in the face's interior
  double time;                    ///< share of the step after which the node crosses the face; 1 if it does not
  // For the choice among neighbouring faces [choose_touches.hpp]:
  bool beyond_rim;   ///< behind a solid's face and beside its rim without having crossed it
  Vec3 face_normal;  ///< unit normal of the face at the place, towards the node's side
  Vec3 from, to;     ///< m, the node relative to the place on the face, at start and end
  Vec3 centre;       ///< m, mean of the face's corners relative to the node, at the end
};

/// False if node and face cannot touch in this step: farther apart than `margin` beyond the clearance at its end, and
/// no crossing. Also false for faces without area and for positions that are not finite.
///
/// clearance (m, >= 0): distance to be kept between node and face. depth (m): solids only, how far a node may start
/// behind the face and still belong to it. two_sided: shells; the side is that of the start, for a node on the very
/// surface the one opposite to its relative motion.
///
/// Slow (relative travel small against the face): the foot is that of the end position. Fast: where the node first
/// crosses the face [first_crossing.hpp]. On a rim the normal turns with the direction from the foot to the node.
/// Depends on relative motion only.
///
/// A node that is stopped by one face slides on along it and may then meet another that its predicted motion did not.
/// Where the motion is slow against the faces, neighbours across a fold are found all the same (beyond_rim). Where it
/// is fast (a touch with time < 1), look again for the motion from the start to the constrained end, and keep what is
/// found.
bool touch_face(const Vec3& node0, const Vec3& node1, const FaceShape& face0, const FaceShape& face1, double clearance,
                double depth, bool two_sided, double margin, Touch& touch);

}  // namespace tenon::contact

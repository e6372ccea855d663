// SPDX-License-Identifier: BSD-3-Clause
// The first time at which a moving face passes through a point (continuous collision detection).
#pragma once

#include "components/contact_geometry/patch.hpp"

namespace tenon::contact {

/// Where and when a patch passes through the origin: F(xi, eta, t) = (1 - t) start(xi, eta) + t end(xi, eta) = 0.
struct Crossing {
  double xi, eta;
  double time;  ///< 0 at the start of the step, 1 at its end
};

/// First crossing of the origin by a patch whose corners move in straight lines; false if there is none. The rim and
/// both ends of the step belong to the patch, with a tolerance of some 1e-9 of its size, so that neighbours leave no
/// gap. `outside_only`: crossings that the origin makes against the patch's normal alone (from outside of a solid).
///
/// F is linear in each of its three unknowns. Boxes of them are cut down by interval Newton iteration, which excludes
/// boxes rigorously and converges quadratically, and halved where that does not help, the earlier half first [MKC09,
/// WFS21].
bool first_crossing(const Patch& start, const Patch& end, bool outside_only, Crossing& crossing);

}  // namespace tenon::contact

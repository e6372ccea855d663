// SPDX-License-Identifier: BSD-3-Clause
// Which of the faces that a node may touch it has to keep away from.
#pragma once

#include <span>

#include "components/contact_geometry/face_touch.hpp"

namespace tenon::contact {

inline constexpr int most_touches = 4;
/// Of more candidates the later ones (in ascending id) are not looked at.
inline constexpr int most_candidates = 64;

struct Choice {
  int candidate;  ///< index in the lists given
  Touch touch;
};

/// Chooses among the touches of one node; `face_ids` ascending, `face_nodes` the ids of the corners (of a triangle the
/// last is no_id or repeats another). Faces that share no corner are all kept. Of those that do:
///  - a foot on a rim that the other face shares is that face's affair, but in a concave fold, where it takes the
///  normal
///    of its own face: there is nothing round which it could turn;
///  - round a convex edge only one is kept: the space outside is that of either face. The one that was crossed last,
///    for a node behind both the one that it is behind least;
///  - in a concave fold both are kept, but of nearly parallel ones (15 degrees) only that which is violated most;
///  - what is beyond a rim counts beside a touch of the neighbour alone, and after any that is not;
///  - faces taken from opposite sides: the one that is crossed first.
/// At most four, those of the smallest end_gap, in ascending order of face ids. Returns how many.
int choose_touches(std::span<const Touch> touches, std::span<const std::array<GlobalId, 4>> face_nodes,
                   std::span<const GlobalId> face_ids, std::span<Choice> chosen);

}  // namespace tenon::contact

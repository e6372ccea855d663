// SPDX-License-Identifier: BSD-3-Clause
// Bodies that are inside each other before the first step, deeper than contact of surfaces can see.
#pragma once

#include <functional>
#include <vector>

#include "components/contact/contact_surfaces.hpp"

namespace tenon::contact {

/// A place of one body that is inside an element of another, or on a shell that coincides with another.
struct Buried {
  std::int32_t first, second;  ///< surfaces, ascending
  Vec3 place;                  ///< m
};

/// Whether two surfaces may be inside each other.
using Allowed = std::function<bool(std::int32_t, std::int32_t)>;

/// Collective. Nodes of surfaces (but those marked in `known`, as ContactSurfaces::nodes(); empty: none) and middles of
/// solid elements at surfaces that are inside an element with which they share no node, by more than a hundredth of it,
/// and middles of shells on those of parallel ones that share no node with them. Ascending; all of them on rank 0.
std::vector<Buried> find_buried(const Communicator& comm, const ContactSurfaces& surfaces, SearchDecomposition how,
                                std::span<const char> known, const Allowed& allowed);

}  // namespace tenon::contact

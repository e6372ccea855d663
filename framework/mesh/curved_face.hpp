// SPDX-License-Identifier: BSD-3-Clause
// The nearest point of the sides of an element of second order. Private to the room.
#pragma once

#include <span>

#include "framework/mesh/shape_functions.hpp"

namespace tenon {

/// Of a hex20 or tet10, for a point outside of it. Ties go to the first side of the topology's table.
NearestPoint nearest_on_curved_sides(ElementKind kind, std::span<const Vec3> nodes, const Vec3& point);

}  // namespace tenon

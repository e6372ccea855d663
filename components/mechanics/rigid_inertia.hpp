// SPDX-License-Identifier: BSD-3-Clause
// Mass properties of rigid blocks.
#pragma once

#include "components/mechanics/load.hpp"

namespace tenon {

/// Visits points of an element with their mass so that mass, centre and moments of inertia are exact: visit(weight kg,
/// place, shape function values of the nodes). Solids by 27 Gauss points on the hexahedron whose nodes fall together
/// (exact for trilinear geometry); shells whose middle surface holds the nodes by the rule of their surface and two
/// points through the thickness.
void for_mass_points(const ElementGroup& group, LocalIndex element, std::span<const Vec3> coordinates,
                     const std::function<void(double, const Vec3&, std::span<const double>)>& visit);

/// Adds int rho N_a dV to the nodes, kg: unlike equal shares, these keep the centre of mass of the body.
void add_consistent_masses(const ElementGroup& group, std::span<const Vec3> coordinates, std::span<double> mass);

}  // namespace tenon

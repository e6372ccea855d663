// SPDX-License-Identifier: BSD-3-Clause
// Added mass for small elements, and stress that is there at the start.
#pragma once

#include "components/mechanics/load.hpp"
#include "components/mechanics/load_options.hpp"

namespace tenon {

/// kg, all ranks.
struct AddedMass {
  double added = 0, before = 0;
  std::int64_t elements = 0;
};

/// Collective. Raises the density of elements until each allows `time_step`/`scale` by itself in the present geometry:
/// the step goes with the root of the mass. Throws Error(usage), naming the share, if that takes more than the limit.
AddedMass scale_masses(const Mesh& mesh, const MassScaling& options, double scale, const ElementGroups& groups,
                       NodalState& nodes);

/// Sets the stress of all points of the blocks. Throws Error(usage) for unknown blocks and for materials whose stress
/// follows from the deformation alone.
void set_initial_stress(const Mesh& mesh, const InitialStress& initial, const ElementGroups& groups);

}  // namespace tenon

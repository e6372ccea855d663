// SPDX-License-Identifier: BSD-3-Clause
// Boundaries that let waves out.
#pragma once

#include "components/mechanics/load.hpp"
#include "components/mechanics/load_options.hpp"
#include "components/mechanics/nodal_damping.hpp"

namespace tenon {

/// Collective. Adds int N_a (rho c_p n n + rho c_s (1 - n n)) dA of the undeformed sides to the absorbing part of their
/// nodes [LK69]: exact for plane waves along the normal, and for shear waves along it. kg/s.
void add_non_reflecting(const Mesh& mesh, const NonReflecting& boundary, const ElementGroups& groups,
                        std::span<SymmetricTensor<double>> absorbing);

}  // namespace tenon

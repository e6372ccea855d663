// SPDX-License-Identifier: BSD-3-Clause
// What an element costs relative to others, for the partition.
#pragma once

#include "components/mechanics/mechanics_options.hpp"
#include "framework/mesh/mesh.hpp"

namespace tenon {

/// Seconds of one element-step in units of those of a linear elastic hexahedron, as measured (docs/performance.md).
double element_cost(const MaterialDescription& material);

/// The same by block.
ElementCost mechanics_cost(const MechanicsOptions& options);

}  // namespace tenon

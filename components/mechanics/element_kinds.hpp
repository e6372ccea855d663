// SPDX-License-Identifier: BSD-3-Clause
// Which kinds of elements mechanics computes, and by which formulation.
#pragma once

#include <memory>
#include <string>

#include "components/mechanics/element_group.hpp"

namespace tenon {

/// Chosen by kind, material and options, once. Throws Error(usage) if they do not fit.
std::unique_ptr<ElementGroup> make_element_group(std::size_t block, const ElementBlock& elements,
                                                 std::span<const Vec3> coordinates,
                                                 const MechanicsOptions::Block& description,
                                                 const MechanicsOptions& options);

}  // namespace tenon

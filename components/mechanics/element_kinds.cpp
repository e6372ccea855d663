// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/element_kinds.hpp"

#include <fmt/core.h>

#include "components/mechanics/hex8_group.hpp"
#include "components/mechanics/shell4_group.hpp"
#include "components/mechanics/solid_group.hpp"

namespace tenon {

namespace {

std::unique_ptr<ElementGroup> make_group(std::size_t block, const ElementBlock& elements,
                                         std::span<const Vec3> coordinates, const MechanicsOptions::Block& description,
                                         const MechanicsOptions& options) {
  using Formulation = MechanicsOptions::Formulation;
  if (!middle_nodes(elements.kind).empty())
    throw Error(ExitCode::usage, fmt::format("mechanics: block '{}' consists of {}; expected elements of first order: "
                                             "hex8, tet4, wedge6, pyramid5, quad4 or tri3",
                                             elements.name, topology(elements.kind).name));
  if (topology(elements.kind).dimension == 2)
    return make_shell_group(block, elements, coordinates, description.material, description.shell, options.viscosity);
  if (elements.kind == ElementKind::hex8 && description.formulation != Formulation::full)
    return make_hex8_group(block, elements, coordinates, description.material, options.hourglass, options.viscosity);
  return make_solid_group(block, elements, coordinates, description.material, options.viscosity,
                          description.formulation != Formulation::full);
}

}  // namespace

std::unique_ptr<ElementGroup> make_element_group(std::size_t block, const ElementBlock& elements,
                                                 std::span<const Vec3> coordinates,
                                                 const MechanicsOptions::Block& description,
                                                 const MechanicsOptions& options) {
  std::unique_ptr<ElementGroup> group = make_group(block, elements, coordinates, description, options);
  if (options.erosion.takes_elements()) group->erode(options.erosion);
  return group;
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
#include "components/mechanics/element_kinds.hpp"

#include <fmt/core.h>

#include "components/mechanics/hex8_group.hpp"

namespace tenon {

std::string refusal(ElementKind kind) {
  if (kind == ElementKind::hex8) return {};
  return fmt::format("consists of {}; mechanics computes hex8", topology(kind).name);
}

std::unique_ptr<ElementGroup> make_element_group(std::size_t block, const Mesh& mesh,
                                                 const MechanicsOptions::Block& description,
                                                 const MechanicsOptions& options) {
  const ElementBlock& elements = mesh.blocks[block];
  const std::string refused = refusal(elements.kind);
  if (!refused.empty()) throw Error(ExitCode::usage, fmt::format("block '{}' {}", elements.name, refused));
  return make_hex8_group(block, elements, mesh.coordinates, description.material, options.hourglass, options.viscosity);
}

}  // namespace tenon

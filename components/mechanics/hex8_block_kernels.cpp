// SPDX-License-Identifier: BSD-3-Clause
// The element loops of all materials and hourglass forms. The only file that is compiled with contraction to fused
// multiply-adds; nothing that other files compute as well belongs here.
#include "components/mechanics/hex8_block_of.hpp"

namespace tenon {

std::unique_ptr<Hex8Block> make_hex8_block(const ElementBlock& block, std::span<const Vec3> coordinates,
                                           const MaterialDescription& material, const HourglassOptions& hourglass,
                                           const BulkViscosity& viscosity) {
  const auto with = [&](const auto& form) {
    return std::visit(
        [&](const auto& law) -> std::unique_ptr<Hex8Block> {
          using Block = Hex8BlockOf<std::decay_t<decltype(law)>, std::decay_t<decltype(form)>>;
          return std::make_unique<Block>(block, coordinates, material, law, form, viscosity);
        },
        make_material(material));
  };
  switch (hourglass.form) {
    case HourglassOptions::Form::stiffness:
      return with(StiffnessHourglass{hourglass.coefficient});
    case HourglassOptions::Form::none:
      return with(NoHourglass{});
    case HourglassOptions::Form::viscous:
      break;
  }
  return with(ViscousHourglass{hourglass.coefficient});
}

}  // namespace tenon

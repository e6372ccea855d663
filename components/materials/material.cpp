// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/material.hpp"

#include "components/materials/material_model.hpp"

#include "framework/base/error.hpp"

namespace tenon {

AnyMaterial make_material(const MaterialDescription& description) {
  if (!description.elastic)
    throw Error(ExitCode::usage, "material '" + description.name +
                                     "' has no elastic constants, which mechanics needs: give it an 'elastic' block");
  if (const auto* linear = std::get_if<LinearHardeningParameters>(&description.plasticity))
    return J2LinearHardening{*description.elastic, linear->yield_stress, linear->hardening_modulus};
  if (const auto* flow = std::get_if<JohnsonCookParameters>(&description.plasticity))
    return JohnsonCook{*description.elastic, *flow};
  return LinearElastic{*description.elastic};
}

std::shared_ptr<const MaterialModel> make_material_model(const MaterialDescription& description) {
  return std::visit(
      [&](const auto& material) -> std::shared_ptr<const MaterialModel> {
        return std::make_shared<MaterialModelOf<std::decay_t<decltype(material)>>>(material, description.failure);
      },
      make_material(description));
}

int state_size(const AnyMaterial& material) {
  return std::visit([](const auto& m) { return m.state_size; }, material);
}

std::string state_name(const AnyMaterial& material, int i) {
  return std::visit([i](const auto& m) { return std::string(m.state_names.at(static_cast<std::size_t>(i))); },
                    material);
}

}  // namespace tenon

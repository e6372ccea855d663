// SPDX-License-Identifier: BSD-3-Clause
// What a constitutive model is: a struct with a pure update of a batch of points.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string_view>

#include "components/materials/batch.hpp"
#include "components/materials/elasticity.hpp"

namespace tenon {

/// What happens to eight points in one step. Symmetric tensors are xx yy zz xy yz zx with TENSOR shear components, in
/// the frame to which the caller has already rotated the stress (and what else turns) of the step's start.
struct UpdateInput {
  const Batch<6>& strain_increment;       ///< total, thermal strain included
  const Batch<1>& temperature;            ///< K, at the end of the step
  const Batch<1>& temperature_increment;  ///< K, over the step; expands the material
  double dt;                              ///< s, positive
  // Only for materials that ask for them; null otherwise.
  const Batch<9>* deformation_gradient = nullptr;  ///< F at the end of the step, rows
  const Batch<1>* volume_ratio = nullptr;          ///< V/V0 at the end of the step
  const Batch<1>* added_heat = nullptr;            ///< J per m^3 of undeformed volume, taken up by artificial viscosity
                                                   ///< since the last update: heats what has an equation of state
};

/// History of the points of a material; a dummy value where the material has none.
template <typename M>
using StateBatch = Batch<(M::state_size > 0 ? M::state_size : 1)>;

/// A constitutive model. `state_size` history values per point, zero in the virgin state unless it says otherwise; the
/// equivalent plastic strain `eqps` first if the material is plastic. `update` advances the Cauchy stress (Pa) and the
/// history and gives the increment of plastic work per current volume (J/m^3, never negative). It must be pure, and the
/// result in a lane must not depend, bit for bit, on the other lanes. What a model may have beyond this is listed in
/// `material_model.hpp`.
template <typename M>
concept Material = requires(const M material, const UpdateInput& input, Batch<6>& stress, StateBatch<M>& state,
                            Batch<1>& plastic_work) {
  { M::state_size } -> std::convertible_to<int>;
  { M::state_names } -> std::convertible_to<std::array<std::string_view, static_cast<std::size_t>(M::state_size)>>;
  { material.elasticity } -> std::convertible_to<Elasticity>;
  { material.update(input, stress, state, plastic_work) } -> std::same_as<void>;
};

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// The mechanical law of a material in a scene file: its blocks, one by one.
#pragma once

#include "components/materials/material.hpp"
#include "framework/scene/schema.hpp"
#include "framework/scene/value.hpp"

namespace tenon {

/// Adds the keys of plasticity, the laws that are whole by themselves, the equation of state and failure.
void add_plasticity(scene::Schema& material);
void add_whole_laws(scene::Schema& material);
void add_equation_of_state(scene::Schema& material);
void add_failure(scene::Schema& material);

/// Turn what a validated material block says of them into parameters; what the schema cannot see goes to `diagnostics`.
PlasticityParameters read_plasticity(const scene::Value& material, scene::Diagnostics& diagnostics);
/// `elastic`: the constants of the material if it has any.
WholeLawParameters read_whole_law(const scene::Value& material, const std::optional<Elasticity>& elastic,
                                  scene::Diagnostics& diagnostics);
std::optional<EquationOfState> read_equation_of_state(const scene::Value& material, double density,
                                                      scene::Diagnostics& diagnostics);
std::optional<FailureCriterion> read_failure(const scene::Value& material, scene::Diagnostics& diagnostics);

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// Von Mises plasticity with any isotropic hardening curve, and rate hardening if asked for.
#pragma once

#include <array>
#include <string_view>

#include "components/materials/flow_curves.hpp"
#include "components/materials/material_concept.hpp"

namespace tenon {

/// Associated flow, radial return [SH98] box 3.1; the flow stress at the end of the step, with the rate of the step, is
/// met to round-off. Plastic work is the trapezium of the flow stress over the plastic strain of the step, at its rate.
/// Exact at any step for proportional loading without rate hardening; else of first order in the step.
template <typename Curve>
struct J2Hardening {
  static constexpr int state_size = 1;
  static constexpr std::array<std::string_view, 1> state_names{"eqps"};

  Elasticity elasticity;
  Curve curve;
  CowperSymonds rate{};

  void update(const UpdateInput& input, Batch<6>& stress, Batch<1>& state, Batch<1>& plastic_work) const;
};

extern template struct J2Hardening<LinearFlow>;
extern template struct J2Hardening<VoceFlow>;
extern template struct J2Hardening<TableFlow>;

}  // namespace tenon

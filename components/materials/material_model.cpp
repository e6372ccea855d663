// SPDX-License-Identifier: BSD-3-Clause
#include "components/materials/material_model.hpp"

#include <variant>

#include "components/materials/crushable_foam.hpp"
#include "components/materials/j2_hardening.hpp"
#include "components/materials/j2_linear_hardening.hpp"
#include "components/materials/linear_elastic.hpp"
#include "components/materials/material.hpp"
#include "components/materials/soil.hpp"
#include "components/materials/with_equation_of_state.hpp"
#include "framework/base/error.hpp"

namespace tenon {
namespace {

using Model = std::shared_ptr<const MaterialModel>;

template <Material M>
Model model_of(const M& material, const MaterialDescription& description) {
  return std::make_shared<MaterialModelOf<M>>(material, description.failure);
}

/// A law with isotropic elasticity, under its own pressure or that of an equation of state.
struct WithPressure {
  const MaterialDescription& description;
  const Elasticity& elastic;

  template <Material M>
  Model model(const M& strength) const {
    if (description.equation_of_state && !(description.equation_of_state->bulk_modulus() > 0))
      throw Error(ExitCode::usage, "material '" + description.name +
                                       "' has no stiffness at the start, which mechanics needs: give its "
                                       "equation_of_state an initial_energy");
    if (description.equation_of_state)
      return model_of(WithEquationOfState<M>(strength, *description.equation_of_state), description);
    return model_of(strength, description);
  }
  Model operator()(std::monostate) const { return model(LinearElastic{elastic}); }
  Model operator()(const LinearHardeningParameters& p) const {
    if (p.rate.active()) return model(J2Hardening<LinearFlow>{elastic, {p.yield_stress, p.hardening_modulus}, p.rate});
    return model(J2LinearHardening{elastic, p.yield_stress, p.hardening_modulus});
  }
  Model operator()(const JohnsonCookParameters& p) const { return model(JohnsonCook{elastic, p}); }
  Model operator()(const VoceHardeningParameters& p) const {
    return model(J2Hardening<VoceFlow>{elastic, p.flow, p.rate});
  }
  Model operator()(const TableHardeningParameters& p) const {
    return model(J2Hardening<TableFlow>{elastic, {{p.flow_stress, PiecewiseLinear::End::hold}}, p.rate});
  }
  Model operator()(const KinematicHardeningParameters& p) const { return model(J2Kinematic{elastic, p}); }
};

struct Choice {
  const MaterialDescription& description;

  const Elasticity& elastic() const {
    if (!description.elastic)
      throw Error(ExitCode::usage, "material '" + description.name +
                                       "' has no elastic constants, which mechanics needs: give it an 'elastic' block");
    return *description.elastic;
  }
  double expansion() const { return description.elastic ? description.elastic->expansion : 0; }

  Model operator()(std::monostate) const {
    return std::visit(WithPressure{description, elastic()}, description.plasticity);
  }
  Model operator()(const MooneyRivlinParameters& p) const {
    return model_of(MooneyRivlin{MooneyRivlin::small_strain(p, expansion()), p}, description);
  }
  Model operator()(const OrthotropicParameters& p) const {
    return model_of(OrthotropicElastic(p, expansion()), description);
  }
  Model operator()(const FoamParameters& p) const {
    const PiecewiseLinear strength(p.yield_stress, PiecewiseLinear::End::continue_slope);
    return model_of(CrushableFoam{elastic(), strength, p.tension_cutoff}, description);
  }
  Model operator()(const SoilParameters& p) const {
    const PiecewiseLinear pressure(p.pressure, PiecewiseLinear::End::continue_slope);
    return model_of(Soil{elastic(), pressure, p.a0, p.a1, p.a2, p.tension_cutoff}, description);
  }
};

}  // namespace

std::shared_ptr<const MaterialModel> make_material_model(const MaterialDescription& description) {
  return std::visit(Choice{description}, description.whole_law);
}

}  // namespace tenon

// SPDX-License-Identifier: BSD-3-Clause
// The concept accepts every material and a minimal one, and refuses what lacks a part. Checked by the compiler.
#include <gtest/gtest.h>

#include "components/materials/crushable_foam.hpp"
#include "components/materials/hyperelastic.hpp"
#include "components/materials/j2_hardening.hpp"
#include "components/materials/j2_kinematic.hpp"
#include "components/materials/j2_linear_hardening.hpp"
#include "components/materials/johnson_cook.hpp"
#include "components/materials/linear_elastic.hpp"
#include "components/materials/orthotropic_elastic.hpp"
#include "components/materials/soil.hpp"
#include "components/materials/with_equation_of_state.hpp"

namespace tenon {
namespace {

struct Minimal {
  static constexpr int state_size = 0;
  static constexpr std::array<std::string_view, 0> state_names{};
  Elasticity elasticity;
  void update(const UpdateInput&, Batch<6>&, Batch<1>&, Batch<1>&) const {}
};
struct NotPure : Minimal {
  void update(const UpdateInput&, Batch<6>&, Batch<1>&, Batch<1>&) {}
};
struct WrongNames : Minimal {
  static constexpr int state_size = 2;
};

static_assert(Material<LinearElastic> && Material<J2LinearHardening> && Material<JohnsonCook> && Material<Minimal>);
static_assert(!Material<NotPure> && !Material<WrongNames> && !Material<Elasticity>);
static_assert(sizeof(Batch<6>) == 6 * lanes * sizeof(double) && alignof(Batch<1>) == 64);

static_assert(Material<J2Hardening<LinearFlow>> && Material<J2Hardening<VoceFlow>> && Material<J2Hardening<TableFlow>>);
static_assert(Material<J2Kinematic> && Material<MooneyRivlin> && Material<OrthotropicElastic>);
static_assert(Material<CrushableFoam> && Material<Soil> && Material<WithEquationOfState<JohnsonCook>>);

TEST(MaterialConcept, PlasticMaterialsHaveEqpsFirst) {
  EXPECT_EQ(J2LinearHardening::state_names[0], "eqps");
  EXPECT_EQ(JohnsonCook::state_names[0], "eqps");
  EXPECT_EQ(J2Kinematic::state_names[0], "eqps");
  EXPECT_EQ(WithEquationOfState<JohnsonCook>::state_names[0], "eqps");
}

}  // namespace
}  // namespace tenon

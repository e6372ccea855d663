// SPDX-License-Identifier: BSD-3-Clause
// The concept accepts every material and a minimal one, and refuses what lacks a part. Checked by the compiler.
#include <gtest/gtest.h>

#include <type_traits>
#include <variant>

#include "components/materials/material.hpp"

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

template <typename>
struct AllAreMaterials;
template <typename... M>
struct AllAreMaterials<std::variant<M...>> : std::bool_constant<(Material<M> && ...)> {};

TEST(MaterialConcept, HoldsForEveryAlternative) {
  EXPECT_TRUE(AllAreMaterials<AnyMaterial>::value);
}

TEST(MaterialConcept, PlasticMaterialsHaveEqpsFirst) {
  EXPECT_EQ(J2LinearHardening::state_names[0], "eqps");
  EXPECT_EQ(JohnsonCook::state_names[0], "eqps");
}

}  // namespace
}  // namespace tenon

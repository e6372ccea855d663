// SPDX-License-Identifier: BSD-3-Clause
// The same impact on all ranks and on one that has everything: the same bits.
#include "solid_meshes.hpp"

namespace tenon::testing {
namespace {

MechanicsOptions impact() {
  MechanicsOptions options;
  options.heat = HeatMode::adiabatic;
  options.initial_velocities.push_back({"", "", {3, -5, -227}, {}, {}});
  options.walls.push_back({{0, 0, 0}, {0, 0, 1}, TimeFunction::constant(0), {}, "wall"});
  return options;
}

MaterialDescription johnson_cook_copper() {
  MaterialDescription m = copper();
  m.plasticity = JohnsonCookParameters{90e6, 292e6, 0.31, 0.025, 1.09, 1, 293.15, 1356};
  m.elastic->expansion = 17e-6;
  return m;
}

CylinderShape cylinder() {
  CylinderShape c;
  c.radius = 3.2e-3, c.length = 8e-3;
  c.core = 4, c.shell = 2, c.axial = 6;
  return c;
}

void check(const MaterialDescription& material, HourglassOptions::Form form, int steps) {
  MechanicsOptions options = impact();
  options.hourglass.form = form;
  const auto shared = body(shared_mesh(on_root(cylinder())), material, options);
  const auto whole = body(whole_mesh(on_root(cylinder())), material, options);
  shared->initialize();
  whole->initialize();
  for (int s = 0; s < steps; ++s) {
    ASSERT_EQ(shared->time_step(), whole->time_step()) << "step " << s;
    shared->advance(shared->time_step());
    whole->advance(whole->time_step());
  }
  for (const char* name : {"displacement", "velocity", "stress", "eqps", "temperature"})
    expect_same_bits(in_global_order(*shared, name), in_global_order(*whole, name), name);
  EXPECT_EQ(energy_rows(*shared), energy_rows(*whole));
  EXPECT_EQ(shared->limiter().reason, whole->limiter().reason);
}

TEST(RankInvariance, LinearHardeningViscousHourglass) {
  check(copper(), HourglassOptions::Form::viscous, 120);
}

TEST(RankInvariance, JohnsonCookStiffnessHourglass) {
  check(johnson_cook_copper(), HourglassOptions::Form::stiffness, 60);
}

TEST(RankInvariance, JohnsonCookPhysicalHourglass) {
  check(johnson_cook_copper(), HourglassOptions::Form::physical, 60);
}

/// Every other kind of solid, distorted, with plastic flow and failure.
TEST(RankInvariance, OtherSolids) {
  using Formulation = MechanicsOptions::Formulation;
  BoxShape box;
  box.high = {0.02, 0.01, 0.01};
  box.elements = {5, 3, 2};
  box.distortion = 0.2;
  MaterialDescription material = copper();
  material.failure.emplace().plastic_strain = 0.25;
  for (const auto& [kind, formulation] :
       {std::pair{ElementKind::tet4, Formulation::automatic}, std::pair{ElementKind::tet4, Formulation::full},
        std::pair{ElementKind::wedge6, Formulation::automatic},
        std::pair{ElementKind::pyramid5, Formulation::automatic}, std::pair{ElementKind::hex8, Formulation::full},
        std::pair{ElementKind::hex8, Formulation::automatic}}) {
    const auto shared = solid_body(shared_mesh(solid_box(box, kind)), material, formulation, impact());
    const auto whole = solid_body(whole_mesh(solid_box(box, kind)), material, formulation, impact());
    shared->initialize();
    whole->initialize();
    for (int s = 0; s < 60; ++s) {
      ASSERT_EQ(shared->time_step(), whole->time_step()) << topology(kind).name << " step " << s;
      shared->advance(shared->time_step());
      whole->advance(whole->time_step());
    }
    for (const char* name : {"displacement", "velocity", "stress", "eqps", "damage"})
      expect_same_bits(in_global_order(*shared, name), in_global_order(*whole, name), name);
    EXPECT_EQ(energy_rows(*shared), energy_rows(*whole)) << topology(kind).name;
  }
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// The scene block of particles: the formulation that suits the materials, and what is refused with its place.
#include <gtest/gtest.h>

#include "components/sph/scene_block.hpp"

namespace tenon {
namespace {

struct Read {
  SphOptions options;
  std::vector<std::string> errors;
};

MaterialDescription with(const std::optional<EquationOfState>& state, bool elastic) {
  MaterialDescription m;
  m.name = "stuff", m.density = 1000;
  m.equation_of_state = state;
  if (elastic) m.elastic = Elasticity{1e9, 0.3};
  return m;
}

Read read(const MaterialDescription& material, const std::string& rest = "") {
  MeshSummary mesh;
  mesh.source = "particles";
  mesh.blocks = {{"body", 1, 10, ElementKind::particle}};
  scene::Diagnostics diagnostics;
  const scene::Value value =
      parse_scene("mesh: body\nmaterial: stuff\n" + rest, "scene.yaml", {}, sph_schema(), diagnostics);
  Read result;
  if (!diagnostics.any()) result.options = read_sph(value, mesh, 3, {{"stuff", material}}, diagnostics);
  result.errors = diagnostics.errors();
  return result;
}

const EquationOfState water{TaitState{1000, 1500}}, hot_gas{IdealGas{1.4, 2.5e5}}, cold_gas{IdealGas{1.4, 0}};
const EquationOfState metal{Gruneisen{2700, 5300, 1.3, 0, 0, 2}}, cold_metal{Gruneisen{2700, 5300, 1.3}};
const EquationOfState explosive{JwlState{6e11, 1e10, 4.5, 1.2, 0.3, 9e9}};

TEST(SphScene, TheFormulationSuitsTheMaterials) {
  const struct {
    MaterialDescription material;
    SphFormulation suits;
  } cases[] = {{with(water, false), SphFormulation::fluid},
               {with(cold_metal, false), SphFormulation::fluid},  // its pressure does not depend on the energy
               {with(metal, false), SphFormulation::gas},
               {with(hot_gas, false), SphFormulation::gas},
               {with(explosive, false), SphFormulation::gas},
               {with(metal, true), SphFormulation::solid},
               {with({}, true), SphFormulation::total_lagrangian}};
  for (std::size_t i = 0; i < std::size(cases); ++i) {
    SCOPED_TRACE(i);
    const auto& [material, suits] = cases[i];
    const Read r = read(material);
    EXPECT_EQ(r.errors, std::vector<std::string>{});
    EXPECT_EQ(r.options.formulation, suits);
  }
  EXPECT_EQ(read(with(water, false), "formulation: gas").options.formulation, SphFormulation::gas);
  EXPECT_EQ(read(with({}, true), "formulation: solid").options.formulation, SphFormulation::solid);
}

TEST(SphScene, MaterialsWithoutThePressureOfTheFormulationAreRefused) {
  const auto only = [](const Read& r, const std::string& text) {
    ASSERT_EQ(r.errors.size(), 1u);
    EXPECT_EQ(r.errors[0].find("scene.yaml:"), 0u) << r.errors[0];
    EXPECT_NE(r.errors[0].find(text), std::string::npos) << r.errors[0];
  };
  only(read(with({}, false)), "no equation_of_state");
  only(read(with({}, true), "formulation: gas"), "no equation_of_state");
  only(read(with(cold_gas, false), "formulation: fluid"), "say `formulation: gas`");
  only(read(with(water, false), "gas: {density: continuity}"), "gas: the formulation is 'fluid'");
  only(read(with(water, false), "artificial_conduction: 0.5"), "for `formulation: gas` only");
}

}  // namespace
}  // namespace tenon

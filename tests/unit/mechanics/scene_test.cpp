// SPDX-License-Identifier: BSD-3-Clause
// The scene block: everything that can be said arrives, and names are checked against the mesh.
#include "components/mechanics/scene_block.hpp"
#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

const char* const everything = R"(
mesh: bar
material: steel
blocks:
  box: {material: copper}
hourglass: {form: stiffness}
bulk_viscosity: {linear: 0.1, quadratic: 2}
time_step: {scale: 0.8, maximum: 1 us}
heat: exported
initial_temperature: 20 degC
initial_velocity: [0, 0, -227 m/s]
initial_velocities:
  - {node_set: x_min, velocity: [1, 2, 3], gradient: [1, 0, 0, 0, 1, 0, 0, 0, 1], centre: [1 mm, 0, 0]}
fixed:
  - {node_sets: x_max, components: [x, z]}
prescribed_displacements:
  - {node_sets: [y_min, y_max], y: {table: [[0, 0], [1 ms, 2 mm]]}}
prescribed_velocities:
  - {node_sets: z_max, z: 3 m/s}
prescribed_gradients:
  - {node_sets: x_min, gradient: [0, 1, 0, 0, 0, 0, 0, 0, 0], factor: 2}
prescribed_rotations:
  - {node_sets: x_min, axis: [0, 0, 1], angle: 0.5}
symmetry_planes:
  - {node_sets: y_min, normal: [0, 1, 0]}
rigid_walls:
  - {point: [0, 0, 0], normal: [0, 0, 1]}
  - {point: [0, 0, 0], normal: [0, 0, 1], node_sets: z_min, bilateral: true}
)";

MeshSummary summary() {
  MeshSummary mesh = communicator().rank() == 0 ? summarise(generate(BoxShape{})) : MeshSummary{};
  return broadcast_summary(communicator(), mesh);
}

std::map<std::string, MaterialDescription> materials() {
  MaterialDescription loose = steel();
  loose.elastic.reset();
  return {{"steel", steel()}, {"copper", copper()}, {"loose", loose}};
}

MechanicsOptions read(const std::string& text, scene::Diagnostics& diagnostics) {
  const scene::Value value = scene::parse_scene(text, "test.yaml", {}, mechanics_schema(), diagnostics);
  if (diagnostics.any()) return {};
  return read_mechanics(value, summary(), materials(), diagnostics);
}

std::string complaints(const std::string& text) {
  scene::Diagnostics diagnostics;
  read(text, diagnostics);
  std::string all;
  for (const std::string& e : diagnostics.errors()) all += e + "\n";
  return all;
}

TEST(MechanicsScene, EverythingArrives) {
  scene::Diagnostics diagnostics;
  const MechanicsOptions o = read(everything, diagnostics);
  ASSERT_TRUE(diagnostics.errors().empty()) << diagnostics.errors().front();
  ASSERT_EQ(o.blocks.size(), 1u);
  EXPECT_EQ(o.blocks[0].name, "box");
  EXPECT_EQ(o.blocks[0].material.density, 8930);
  EXPECT_EQ(o.hourglass.form, HourglassOptions::Form::stiffness);
  EXPECT_EQ(o.hourglass.coefficient, 0.05);
  EXPECT_EQ(o.viscosity.linear, 0.1);
  EXPECT_EQ(o.viscosity.quadratic, 2);
  EXPECT_EQ(o.time_step.scale, 0.8);
  EXPECT_NEAR(*o.time_step.maximum, 1e-6, 1e-20);
  EXPECT_EQ(o.heat, HeatMode::exported);
  EXPECT_NEAR(*o.initial_temperature, 293.15, 1e-12);
  ASSERT_EQ(o.initial_velocities.size(), 2u);
  EXPECT_EQ(o.initial_velocities[0].velocity[2], -227);
  EXPECT_EQ(o.initial_velocities[1].node_set, "x_min");
  EXPECT_EQ(o.initial_velocities[1].gradient[4], 1);
  ASSERT_EQ(o.motions.size(), 7u);
  EXPECT_EQ(o.motions[0].kind, Kind::fixed);
  EXPECT_EQ(o.motions[0].components, (std::array<bool, 3>{true, false, true}));
  EXPECT_EQ(o.motions[1].node_sets.size(), 2u);
  EXPECT_EQ(o.motions[1].components, (std::array<bool, 3>{false, true, false}));
  EXPECT_NEAR(o.motions[1].value[1](5e-4), 1e-3, 1e-15);
  EXPECT_EQ(o.motions[2].kind, Kind::velocity);
  EXPECT_EQ(o.motions[3].gradient[1], 1);
  EXPECT_EQ(o.motions[4].kind, Kind::rotation);
  EXPECT_EQ(o.motions[5].normal[1], 1);
  EXPECT_EQ(o.motions[6].kind, Kind::wall);
  ASSERT_EQ(o.walls.size(), 1u);
}

TEST(MechanicsScene, DefaultsAreThoseOfTheOptions) {
  scene::Diagnostics diagnostics;
  const MechanicsOptions o = read("mesh: bar\nmaterial: steel\n", diagnostics), standard;
  ASSERT_FALSE(diagnostics.any());
  EXPECT_EQ(o.hourglass.coefficient, standard.hourglass.coefficient);
  EXPECT_EQ(o.viscosity.linear, standard.viscosity.linear);
  EXPECT_EQ(o.time_step.scale, standard.time_step.scale);
  EXPECT_EQ(o.heat, HeatMode::none);
}

TEST(MechanicsScene, WrongNamesGetASuggestion) {
  EXPECT_NE(complaints("mesh: bar\nmaterial: stel\n").find("steel"), std::string::npos);
  EXPECT_NE(complaints("mesh: bar\nmaterial: loose\n").find("elastic"), std::string::npos);
  EXPECT_NE(complaints("mesh: bar\nblocks: {bux: {material: steel}}\n").find("box"), std::string::npos);
  EXPECT_NE(complaints("mesh: bar\nmaterial: steel\nfixed: [{node_sets: x_mni}]\n").find("x_min"), std::string::npos);
  EXPECT_NE(complaints("mesh: bar\nmaterial: steel\nfixed: [{node_sets: x_min, components: [q]}]\n").find("x, y, z"),
            std::string::npos);
  EXPECT_NE(complaints("mesh: bar\nmaterial: steel\nrigid_walls: [{point: [0, 0, 0], normal: [0, 0, 0]}]\n")
                .find("no length"),
            std::string::npos);
  EXPECT_NE(
      complaints("mesh: bar\nmaterial: steel\nprescribed_velocities: [{node_sets: x_min}]\n").find("at least one"),
      std::string::npos);
}

TEST(MechanicsScene, RefusesElementsOfSecondOrderByName) {
  for (const ElementKind kind : {ElementKind::hex20, ElementKind::tet10}) {
    MeshSummary mesh = summary();
    mesh.blocks[0].kind = kind;
    scene::Diagnostics diagnostics;
    const scene::Value value = parse_scene("mesh: m\nmaterial: steel\n", "s.yaml", {}, mechanics_schema(), diagnostics);
    ASSERT_FALSE(diagnostics.any());
    read_mechanics(value, mesh, materials(), diagnostics);
    ASSERT_TRUE(diagnostics.any());
    const std::string error = diagnostics.errors().front();
    EXPECT_NE(error.find("'" + mesh.blocks[0].name + "'"), std::string::npos) << error;
    EXPECT_NE(error.find(topology(kind).name), std::string::npos) << error;
    EXPECT_NE(error.find("mesh the body with hex8"), std::string::npos) << error;
  }
}

}  // namespace
}  // namespace tenon::testing

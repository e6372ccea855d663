// SPDX-License-Identifier: BSD-3-Clause
// Keys of loads and constraints: everything arrives, and mistakes are named.
#include "components/mechanics/scene_block.hpp"
#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

const char* const everything = R"(
mesh: bar
material: steel
gravity: [0, 0, -9.81]
body_forces:
  - {blocks: box, x: {expression: "2*t + x"}}
nodal_forces:
  - {node_sets: [x_min, x_max], y: 3 kN, shared: true}
pressures:
  - {side_sets: z_max, pressure: 2 MPa}
tractions:
  - {side_sets: x_max, x: 1 kPa, per: current}
  - {side_sets: x_max, z: {table: [[0, 0], [1, 5]]}}
prescribed_accelerations:
  - {node_sets: x_min, x: 5}
damping: {mass: 20, stiffness: 1 us}
dynamic_relaxation: {tolerance: 1e-5, after: 1 ms}
springs:
  - {node_sets: x_min, stiffness: 2 kN/mm, direction: [0, 0, 2]}
  - {from: [0, 0, 0], to: [1, 1, 1], table: [[-1, -2], [1, 4]]}
dashpots:
  - {nodes: [1, 8], coefficient: 3}
  - {node_sets: x_min, other_sets: x_max, coefficient: 3}
tied:
  - {node_sets: x_min, side_sets: [x_max, y_max], tolerance: 1 mm}
non_reflecting:
  - {side_sets: y_min}
initial_stresses:
  - {xx: 3 MPa, zx: {expression: "x"}}
mass_scaling: {time_step: 1 us, limit: 10 %}
)";

const char* const bodies = R"(
mesh: bar
material: steel
rigid_bodies:
  - {blocks: box, velocity: [1, 2, 3], spin: [0, 0, 4], fixed: [x], velocity_z: 5}
  - {blocks: box, joint: [1, 1, 1], rotation: hinge, axis: [0, 0, 3]}
  - {blocks: box, rotation: prescribed, axis: [1, 0, 0], angle: 2}
)";

MechanicsOptions read(const std::string& text, scene::Diagnostics& diagnostics) {
  MeshSummary mesh = communicator().rank() == 0 ? summarise(generate(BoxShape{})) : MeshSummary{};
  mesh = broadcast_summary(communicator(), mesh);
  const scene::Value value = scene::parse_scene(text, "test.yaml", {}, mechanics_schema(), diagnostics);
  if (diagnostics.any()) return {};
  return read_mechanics(value, mesh, {{"steel", steel()}}, diagnostics);
}

LoadOptions loads_of(const std::string& text) {
  scene::Diagnostics diagnostics;
  const MechanicsOptions options = read(text, diagnostics);
  for (const std::string& error : diagnostics.errors()) ADD_FAILURE() << error;
  return options.loads;
}

TEST(LoadsScene, LoadsArrive) {
  const LoadOptions l = loads_of(everything);
  ASSERT_EQ(l.body_forces.size(), 2u);
  EXPECT_EQ(l.body_forces[0].acceleration[2](0, {}), -9.81);
  EXPECT_EQ(l.body_forces[1].acceleration[0](3, {4, 0, 0}), 10);
  ASSERT_EQ(l.nodal_forces.size(), 1u);
  EXPECT_EQ(l.nodal_forces[0].force[1](0, {}), 3000);
  EXPECT_TRUE(l.nodal_forces[0].shared);
  ASSERT_EQ(l.surface_loads.size(), 3u);
  EXPECT_EQ(l.surface_loads[0].value[0](0, {}), 2e6);
  EXPECT_EQ(l.surface_loads[1].kind, SurfaceLoad::Kind::current_traction);
  EXPECT_EQ(l.surface_loads[2].kind, SurfaceLoad::Kind::reference_traction);
  EXPECT_EQ(l.surface_loads[2].value[2](0.5, {}), 2.5);
  EXPECT_EQ(l.damping.mass, 20);
  EXPECT_NEAR(l.damping.stiffness, 1e-6, 1e-20);
  ASSERT_TRUE(l.relaxation);
  EXPECT_EQ(l.relaxation->tolerance, 1e-5);
  EXPECT_EQ(l.relaxation->after, 1e-3);
}

TEST(LoadsScene, ConnectorsAndTheRestArrive) {
  const LoadOptions l = loads_of(everything);
  ASSERT_EQ(l.connectors.size(), 4u);
  EXPECT_EQ(l.connectors[0].ends, Connector::Ends::ground);
  EXPECT_EQ(l.connectors[0].law[1].second, 2e6);
  EXPECT_EQ((*l.connectors[0].direction)[2], 1);
  EXPECT_EQ(l.connectors[1].ends, Connector::Ends::places);
  EXPECT_EQ(l.connectors[1].law[1].second, 4);
  EXPECT_EQ(l.connectors[2].ends, Connector::Ends::labels);
  EXPECT_EQ(l.connectors[2].node_labels[1], 8);
  EXPECT_EQ(l.connectors[3].ends, Connector::Ends::sets);
  ASSERT_EQ(l.ties.size(), 1u);
  EXPECT_EQ(l.ties[0].side_sets.size(), 2u);
  EXPECT_EQ(*l.ties[0].tolerance, 1e-3);
  EXPECT_EQ(l.non_reflecting.size(), 1u);
  ASSERT_EQ(l.initial_stresses.size(), 1u);
  EXPECT_EQ(l.initial_stresses[0].stress[5](0, {7, 0, 0}), 7);
  ASSERT_TRUE(l.mass_scaling);
  EXPECT_NEAR(l.mass_scaling->limit, 0.1, 1e-15);
}

TEST(LoadsScene, RigidBodiesArrive) {
  const LoadOptions l = loads_of(bodies);
  ASSERT_EQ(l.rigid_bodies.size(), 3u);
  EXPECT_EQ((*l.rigid_bodies[0].velocity)[2], 3);
  EXPECT_TRUE(l.rigid_bodies[0].prescribed_velocity[0]);
  EXPECT_FALSE(l.rigid_bodies[0].prescribed_velocity[1]);
  EXPECT_EQ((*l.rigid_bodies[0].prescribed_velocity[2])(0), 5);
  EXPECT_EQ(l.rigid_bodies[1].rotation, RigidBody::Rotation::hinge);
  EXPECT_TRUE(l.rigid_bodies[1].joint);
  EXPECT_EQ(l.rigid_bodies[2].angle(0), 2);
}

TEST(LoadsScene, MistakesAreNamed) {
  const auto complaint = [](const std::string& keys) {
    scene::Diagnostics diagnostics;
    read("mesh: bar\nmaterial: steel\n" + keys, diagnostics);
    std::string all;
    for (const std::string& e : diagnostics.errors()) all += e + "\n";
    return all;
  };
  EXPECT_NE(complaint("pressures: [{side_sets: z_mx, pressure: 1}]").find("no side set 'z_mx', did you mean 'z_max'"),
            std::string::npos);
  EXPECT_NE(complaint("nodal_forces: [{node_sets: x_min}]").find("expected at least one of x, y, z"),
            std::string::npos);
  EXPECT_NE(complaint("springs: [{node_sets: x_min, table: [[0, 0], [1, 2]]}]").find("needs a direction"),
            std::string::npos);
  EXPECT_NE(complaint("springs: [{from: [0, 0, 0], stiffness: 1}]").find("from and to belong together"),
            std::string::npos);
  EXPECT_NE(complaint("dashpots: [{nodes: [1.5, 2], coefficient: 1}]").find("1.5 is not the id of a node"),
            std::string::npos);
  EXPECT_NE(complaint("springs: [{nodes: [1, 1e17], stiffness: 1}]").find("is not the id of a node"),
            std::string::npos);
  EXPECT_NE(complaint("rigid_bodies: [{blocks: bx}]").find("no block 'bx'"), std::string::npos);
  EXPECT_NE(complaint("rigid_bodies: [{blocks: box, rotation: hinge}]").find("needs an axis"), std::string::npos);
}

}  // namespace
}  // namespace tenon::testing

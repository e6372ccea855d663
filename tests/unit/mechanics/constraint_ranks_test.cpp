// SPDX-License-Identifier: BSD-3-Clause
// Every load and constraint at once: the same bits on any number of ranks, and after a restart.
#include <filesystem>

#include "constraints_case.hpp"

namespace tenon::testing {
namespace {

MeshData bodies() {
  return joined({{"a", box({0, 0, 0}, {1, 1, 1.2}, {3, 3, 4}, 0.2), 1},
                 {"b", box({1, 0, 0}, {2, 1, 1}, {2, 4, 4}, 0.2)},
                 {"c", box({3, 0, 0}, {4, 1, 1}, {2, 2, 2}, 0.2)}});
}

MechanicsOptions everything() {
  MechanicsOptions o;
  o.initial_velocities = {{"", "", {1, 2, 3}, {0, -30, 0, 30, 0, 0, 0, 0, 0}, {}}};
  LoadOptions& l = o.loads;
  l.body_forces.push_back({{}, {always(0), always(5), always(-9.81)}, "gravity"});
  l.nodal_forces.push_back({{"c_x_max"}, {always(1e6), always(0), always(2e5)}, true, "force"});
  l.surface_loads.push_back({SurfaceLoad::Kind::pressure, {"a_x_min", "a_y_min"}, {always(1e6)}, "pressure"});
  l.surface_loads.push_back(
      {SurfaceLoad::Kind::current_traction, {"b_z_max"}, {always(1e5), always(2e5), always(0)}, "traction"});
  l.damping = {100, 1e-7};
  l.non_reflecting = {{{"b_y_max"}, "non_reflecting"}};
  Connector spring;
  spring.ends = Connector::Ends::sets;
  spring.node_sets = {"c_x_min"}, spring.other_sets = {"b_x_max"};
  spring.law = {{-1, -2e8}, {0, 0}, {1, 1e8}};
  spring.label = "spring";
  Connector damper = spring;
  damper.kind = Connector::Kind::dashpot;
  damper.law = {{0, 0}, {1, 1e4}};
  Connector ground = damper;
  ground.ends = Connector::Ends::ground;
  ground.node_sets = {"c_z_min"}, ground.other_sets = {};
  l.connectors = {spring, damper, ground};
  RigidBody top;
  top.blocks = {"a_top"};
  top.label = "rigid body";
  l.rigid_bodies = {top};
  l.ties = {{{"b_x_min"}, {"a_x_max"}, 0.05, "tied"}};
  InitialStress initial{{"c"}, {}, "initial stress"};
  initial.stress[2] = always(1e6);
  l.initial_stresses = {initial};
  return o;
}

MechanicsOptions relaxing() {
  MechanicsOptions o;
  o.motions = {motion(PrescribedMotion::Kind::fixed, {"x_min"})};
  o.loads.surface_loads.push_back({SurfaceLoad::Kind::pressure, {"z_max"}, {always(1e6)}, "pressure"});
  o.loads.relaxation = RelaxationOptions{1e-6, 0};
  return o;
}

void compare(Mechanics& a, Mechanics& b) {
  for (const char* name : {"displacement", "velocity", "stress"})
    expect_same_bits(in_global_order(a, name), in_global_order(b, name), name);
  EXPECT_EQ(energy_rows(a), energy_rows(b));
}

void check_ranks(const MeshData& data, const MechanicsOptions& options, int steps) {
  MeshData copy = data;
  const auto shared = body(shared_mesh(std::move(copy)), steel(), options);
  const auto whole = body(whole_mesh(data), steel(), options);
  shared->initialize(), whole->initialize();
  for (int s = 0; s < steps; ++s) {
    ASSERT_EQ(shared->time_step(), whole->time_step()) << "step " << s;
    shared->advance(shared->time_step()), whole->advance(whole->time_step());
  }
  compare(*shared, *whole);
  EXPECT_EQ(shared->ending(), whole->ending());
}

void check_restart(const MeshData& data, const MechanicsOptions& options, const std::string& name) {
  const std::string file = "mechanics_" + name + "_" + std::to_string(communicator().size()) + ".h5";
  const auto make = [&] {
    MeshData copy = data;
    return body(shared_mesh(std::move(copy)), steel(), options);
  };
  const auto whole = make();
  whole->initialize();
  for (int s = 0; s < 20; ++s) whole->advance(whole->time_step());
  {
    CheckpointWriter writer(communicator(), file);
    whole->save(writer);
    writer.finish();
  }
  const auto continued = make();
  {
    const CheckpointReader reader(communicator(), file);
    continued->set_clock(whole->time());
    continued->load(reader);
  }
  continued->initialize();
  ASSERT_EQ(continued->time_step(), whole->time_step());
  for (int s = 0; s < 20; ++s) whole->advance(whole->time_step()), continued->advance(continued->time_step());
  compare(*whole, *continued);
  communicator().barrier();
  if (communicator().rank() == 0) std::filesystem::remove(file);
}

TEST(ConstraintRanks, EveryLoadAndConstraint) {
  check_ranks(bodies(), everything(), 25);
}

TEST(ConstraintRanks, DynamicRelaxation) {
  check_ranks(on_root(box({0, 0, 0}, {3, 1, 1}, {4, 2, 2}, 0.2)), relaxing(), 60);
}

TEST(ConstraintRestart, EveryLoadAndConstraint) {
  check_restart(bodies(), everything(), "constraints");
}

TEST(ConstraintRestart, DynamicRelaxation) {
  check_restart(on_root(box({0, 0, 0}, {3, 1, 1}, {4, 2, 2}, 0.2)), relaxing(), "relaxation");
}

}  // namespace
}  // namespace tenon::testing

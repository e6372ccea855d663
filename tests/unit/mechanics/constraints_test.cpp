// SPDX-License-Identifier: BSD-3-Clause
// Rigid bodies, ties, springs, dashpots, damping, initial stress and mass scaling in a body: closed forms, momentum and
// the ledger.
#include "components/mechanics/surface_load.hpp"
#include "constraints_case.hpp"
#include "framework/mesh/shape_functions.hpp"

namespace tenon::testing {
namespace {

double sum_over_nodes(Mechanics& b, const std::function<double(std::size_t)>& value) {
  ExactSum sum;
  for (const LocalIndex n : b.mesh().owned_nodes) sum.add(value(static_cast<std::size_t>(n)));
  return b.mesh().comm.sum(sum);
}

RigidBody rigid(std::vector<std::string> blocks) {
  RigidBody body;
  body.blocks = std::move(blocks);
  body.label = "rigid body";
  return body;
}

std::unique_ptr<Mechanics> alone(const RigidBody& options, const BoxShape& shape) {
  MechanicsOptions o;
  o.loads.rigid_bodies = {options};
  return body(shared_mesh(joined({{"a", shape}})), steel(), o);
}

TEST(RigidBodies, MassCentreAndInertiaOfADistortedBrickAreExact) {
  const auto b = alone(rigid({"a"}), box({1, 0, 0}, {3, 1, 0.5}, {4, 3, 2}, 0.3));
  const RigidInertia& found = b->rigid_bodies().inertia(0);
  const double m = 7850;
  EXPECT_NEAR(found.mass, m, 1e-12 * m);
  EXPECT_NEAR(norm(b->rigid_bodies().state(0).pivot - Vec3{2, 0.5, 0.25}), 0, 1e-14);
  EXPECT_NEAR(found.inertia.xx, m / 12 * (1 + 0.25), 1e-12 * m);
  EXPECT_NEAR(found.inertia.yy, m / 12 * (4 + 0.25), 1e-12 * m);
  EXPECT_NEAR(found.inertia.zz, m / 12 * (4 + 1), 1e-12 * m);
  EXPECT_NEAR(found.inertia.xy, 0, 1e-12 * m);
}

TEST(RigidBodies, AFreeBodyKeepsItsMomentaAndItsShape) {
  RigidBody options = rigid({"a"});
  options.spin = Vec3{30, -200, 10};
  options.velocity = Vec3{1, 2, 3};
  const auto b = alone(options, box({0, 0, 0}, {0.2, 0.1, 0.05}, {2, 2, 2}));
  b->initialize();
  const double energy = energy_rows(*b).at("kinetic_energy");
  Ledger ledger(*b);
  for (int s = 0; s < 500; ++s) b->advance(1e-4);
  EXPECT_NEAR(energy_rows(*b).at("kinetic_energy"), energy, 1e-12 * energy);
  EXPECT_LE(ledger.error(), 1e-12);
  const RigidState& state = b->rigid_bodies().state(0);
  EXPECT_NEAR(norm(state.pivot - (Vec3{0.1, 0.05, 0.025} + b->time() * Vec3{1, 2, 3})), 0, 1e-13);
  for (const LocalIndex n : b->mesh().owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    const Vec3 x = b->current_coordinates()[i] - state.pivot, start = b->mesh().coordinates[i] - Vec3{0.1, 0.05, 0.025};
    EXPECT_NEAR(norm(x - rotate(state.orientation, start)), 0, 1e-14);
  }
}

TEST(RigidBodies, FallsWithItsDeformablePartAndKeepsTheLedger) {
  MechanicsOptions o;
  o.loads.rigid_bodies = {rigid({"a_top"})};
  o.loads.body_forces.push_back({{}, {always(0), always(0), always(-1000)}, "gravity"});
  o.initial_velocities.push_back({"", "", {0, 0, 5}, {0, -30, 0, 30, 0, 0, 0, 0, 0}, {0.5, 0.5, 0}});
  const auto b = body(shared_mesh(joined({{"a", box({0, 0, 0}, {1, 1, 1.2}, {3, 3, 4}, 0.2), 2}})), steel(), o);
  b->initialize();
  Ledger ledger(*b);
  for (int s = 0; s < 100; ++s) b->advance(b->time_step());
  EXPECT_LE(ledger.error(), 1e-12);
  // Momentum of both: M g t, with the velocities of half a step before.
  const double mass = 7850 * 1.2;
  const double t = b->time() - 0.5 * b->time_step();
  const double rigid_part = b->rigid_bodies().inertia(0).mass * b->rigid_bodies().state(0).velocity[2];
  const double z =
      sum_over_nodes(*b, [&](std::size_t n) { return b->nodal_mass()[n] * field(*b, "velocity")[3 * n + 2]; });
  EXPECT_NEAR(z + rigid_part, mass * (5 - 1000 * t), 2e-3 * mass * 1000 * b->time_step());
}

TEST(RigidBodies, APendulumOnABallJointSwings) {
  RigidBody options = rigid({"a"});
  options.joint = Vec3{0, 0, 0};
  MechanicsOptions o;
  o.loads.rigid_bodies = {options};
  o.loads.body_forces.push_back({{}, {always(0.01), always(0), always(-10)}, "gravity"});  // equilibrium off by 1e-3
  const auto b =
      body(shared_mesh(joined({{"a", box({-0.05, -0.05, -1.05}, {0.05, 0.05, -0.95}, {2, 2, 2}, 0.3)}})), steel(), o);
  b->initialize();
  Ledger ledger(*b);
  const double m = 7850e-3, inertia = m * (1 + 1e-2 / 6), period = 2 * std::numbers::pi * std::sqrt(inertia / (m * 10));
  const int steps = 400;
  double highest = 0;
  for (int s = 0; s < steps; ++s) {
    b->advance(period / steps);
    highest = std::max(highest, rotate(b->rigid_bodies().state(0).orientation, {0, 0, -1})[0]);
  }
  EXPECT_NEAR(highest, 2e-3, 2e-6);                                                     // half way
  EXPECT_NEAR(rotate(b->rigid_bodies().state(0).orientation, {0, 0, -1})[0], 0, 2e-6);  // and back
  EXPECT_LE(ledger.error(), 1e-11);  // of work that is 1e-6 of what round-off in positions acts on
}

TEST(RigidBodies, PrescribedMotionIsExactAndItsWorkBooked) {
  RigidBody options = rigid({"a_top"});
  options.rotation = RigidBody::Rotation::prescribed;
  options.axis = {0, 0, 2};
  options.angle = TimeFunction::smooth_step(0, 0.1, 0, 1e-3);
  options.prescribed_velocity = {TimeFunction::constant(0), TimeFunction::constant(0), TimeFunction::constant(20)};
  MechanicsOptions o;
  o.loads.rigid_bodies = {options};
  const auto b = body(shared_mesh(joined({{"a", box({0, 0, 0}, {1, 1, 1}, {2, 2, 3}), 1}})), steel(), o);
  b->initialize();
  Ledger ledger(*b);
  const double start = b->rigid_bodies().state(0).pivot[2];
  EXPECT_LT(start, 5.0 / 6);  // the mass of the nodes below counts
  EXPECT_GT(start, 2.0 / 3);
  run_to(*b, 1e-3);
  EXPECT_NEAR(b->rigid_bodies().state(0).angle, 0.1, 1e-14);
  EXPECT_NEAR(b->rigid_bodies().state(0).pivot[2] - start, 0.02, 1e-14);
  EXPECT_GT(energy_rows(*b).at("rigid_body_work"), 0);
  EXPECT_LE(ledger.error(), 1e-12);
}

TEST(RigidBodies, AHingeTurnsUnderATorque) {
  RigidBody options = rigid({"a"});
  options.joint = Vec3{0, 0, 0};
  options.rotation = RigidBody::Rotation::hinge;
  options.axis = {0, 0, 1};
  MechanicsOptions o;
  o.loads.rigid_bodies = {options};
  o.loads.body_forces.push_back({{}, {always(0), always(1), always(-50)}, "push"});
  const auto b = body(shared_mesh(joined({{"a", box({0.9, -0.1, 3}, {1.1, 0.1, 3.2}, {2, 2, 2})}})), steel(), o);
  b->initialize();
  Ledger ledger(*b);
  for (int s = 0; s < 10; ++s) b->advance(1e-3);
  const double m = 7850 * 0.008, inertia = m * (1 + 0.04 / 6);
  EXPECT_NEAR(b->rigid_bodies().state(0).angle, 0.5 * m / inertia * 1e-4, 1e-12);
  EXPECT_LE(ledger.error(), 1e-12);
}

std::unique_ptr<Mechanics> tied_pair(MechanicsOptions o, double gap) {
  TiedSet tie{{"b_z_min"}, {"a_z_max"}, 0.1, "tied"};
  o.loads.ties = {tie};
  return body(shared_mesh(joined({{"a", box({0, 0, 0}, {1, 1, 1}, {2, 3, 2})},
                                  {"b", box({0, 0, 1 + gap}, {1, 1, 2 + gap}, {3, 4, 3}, 0.2)}})),
              steel(), std::move(o));
}

TEST(Ties, MomentumIsKeptAndTheLedgerCloses) {
  MechanicsOptions o;
  o.initial_velocities = {{"a", "", {0, 0, 20}, {}, {}}, {"b", "", {5, 0, -10}, {}, {}}};
  const auto b = tied_pair(o, 0);
  b->initialize();
  const auto momentum = [&](std::size_t c) {
    const std::vector<double> v = field(*b, "velocity");
    return sum_over_nodes(*b, [&](std::size_t n) { return b->nodal_mass()[n] * v[3 * n + c]; });
  };
  const Vec3 start{momentum(0), momentum(1), momentum(2)};
  EXPECT_NEAR(sum_over_nodes(*b, [&](std::size_t n) { return b->nodal_mass()[n]; }), 2 * 7850, 1e-11 * 7850);
  Ledger ledger(*b);
  for (int s = 0; s < 200; ++s) b->advance(b->time_step());
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(momentum(c), start[c], 1e-12 * norm(start));
  EXPECT_LE(ledger.error(), 1e-13);
  EXPECT_GT(energy_rows(*b).at("internal_energy"), 1e4);
}

TEST(Ties, LinearFieldsPassThroughUnequalMeshes) {
  MechanicsOptions o;
  const std::array<double, 9> gradient{1, 2, 3, -4, 5, 6, 7, -8, 9};
  o.initial_velocities = {{"a", "", {}, gradient, {}}};
  const auto b = tied_pair(o, 0);
  b->initialize();
  const std::vector<double> v = field(*b, "velocity");
  for (const LocalIndex node : nodes_of_sets(b->mesh(), {"b_z_min"}, "test")) {
    const auto n = static_cast<std::size_t>(node);
    const Vec3& x = b->mesh().coordinates[n];
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(v[3 * n + c], gradient[3 * c] * x[0] + gradient[3 * c + 1] * x[1] + gradient[3 * c + 2] * x[2],
                  1e-13);
  }
}

TEST(Ties, NodesWithoutAFaceAreRefused) {
  try {
    tied_pair({}, 0.5);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("has no face within"), std::string::npos) << error.what();
  }
}

Connector spring_to_ground(double stiffness, std::vector<std::string> sets) {
  Connector c;
  c.node_sets = std::move(sets);
  c.law = {{0, 0}, {1, stiffness}};
  c.label = "spring";
  return c;
}

TEST(Springs, ARigidMassOnSpringsHasTheFrequencyOfCentralDifferences) {
  // Rigid so that only the springs move: omega^2 = K/m; central differences: sin(w dt/2) = omega dt/2.
  RigidBody options = rigid({"a"});
  options.rotation = RigidBody::Rotation::fixed;
  options.velocity = Vec3{1, 0, 0};
  MechanicsOptions o;
  o.loads.rigid_bodies = {options};
  o.loads.connectors = {spring_to_ground(1e6, {"a_x_min"})};  // nine nodes
  const auto b = body(shared_mesh(joined({{"a", box({0, 0, 0}, {0.1, 0.1, 0.1}, {2, 2, 2})}})), steel(), o);
  b->initialize();
  Ledger ledger(*b);
  const double omega = std::sqrt(9e6 / 7.85), dt = 0.2 / omega, w = 2 * std::asin(0.1) / dt;
  double at_rest = 0;
  for (int s = 1; s <= 100; ++s) {
    b->advance(dt);
    const double expected = dt * std::sin(w * dt * s) / std::sin(w * dt);  // u0 = 0, u1 = dt v (v is that of the start)
    at_rest = std::max(at_rest, std::abs(b->rigid_bodies().state(0).pivot[0] - 0.05 - expected));
  }
  EXPECT_LE(at_rest, 1e-10 * dt * 100);
  EXPECT_LE(ledger.error(), 1e-13);
}

TEST(Springs, BetweenNodesThePairIsInBalanceAndTheStepCounts) {
  MechanicsOptions o;
  Connector c;
  c.ends = Connector::Ends::sets;
  c.node_sets = {"a_x_max"}, c.other_sets = {"b_x_min"};
  c.law = {{-1, -1e11}, {0, 0}, {1, 5e10}};
  c.label = "spring";
  Connector damper = c;
  damper.kind = Connector::Kind::dashpot;
  damper.law = {{0, 0}, {1, 1e6}};
  Connector one = c;
  one.ends = Connector::Ends::places;
  one.place = {Vec3{0, 0, 0}, Vec3{3.5, 1, 1}};
  o.initial_velocities = {{"a", "", {10, 3, 0}, {}, {}}, {"b", "", {-10, 0, 0}, {}, {}}};
  const auto make = [&] {
    return body(shared_mesh(joined(
                    {{"a", box({0, 0, 0}, {1, 1, 1}, {2, 2, 2})}, {"b", box({2, 0, 0}, {3.5, 1, 1}, {2, 2, 2})}})),
                steel(), o);
  };
  const auto free = make();
  free->initialize();
  o.loads.connectors = {c, damper, one};
  const auto b = make();
  b->initialize();
  EXPECT_LT(b->time_step(), free->time_step());
  Ledger ledger(*b);
  const auto momentum = [&](std::size_t k) {
    const std::vector<double> v = field(*b, "velocity");
    return sum_over_nodes(*b, [&](std::size_t n) { return b->nodal_mass()[n] * v[3 * n + k]; });
  };
  const double start = momentum(0);
  for (int s = 0; s < 300; ++s) b->advance(b->time_step());
  EXPECT_NEAR(momentum(0), start, 1e-11 * 7850 * 20);
  EXPECT_NEAR(momentum(1), 3 * 7850, 1e-11 * 7850 * 20);
  EXPECT_LE(ledger.error(), 1e-13);
  EXPECT_GT(energy_rows(*b).at("spring_energy"), 0);
  EXPECT_GT(energy_rows(*b).at("damping_energy"), 0);
}

TEST(Damping, MassProportionalDampingDecaysAsTheMidpointRuleSays) {
  MechanicsOptions o;
  o.loads.damping.mass = 500;
  o.initial_velocities.push_back({"", "", {1, -2, 3}, {}, {}});
  const auto b = body(shared_mesh(on_root(box({0, 0, 0}, {1, 1, 1}, {2, 2, 2}))), steel(), o);
  b->initialize();
  Ledger ledger(*b);
  const double dt = b->time_step(), first = 0.25 * 500 * dt, next = 0.5 * 500 * dt;
  for (int s = 0; s < 100; ++s) b->advance(dt);
  const double factor = (1 - first) / (1 + first) * std::pow((1 - next) / (1 + next), 99);
  const std::vector<double> v = field(*b, "velocity");
  for (std::size_t i = 0; i < v.size(); i += 3) EXPECT_NEAR(v[i], factor, 1e-12);
  EXPECT_LE(ledger.error(), 1e-13);
  EXPECT_NEAR(energy_rows(*b).at("damping_energy"), 0.5 * 7850 * 14 * (1 - factor * factor), 1e-8);
}

TEST(Damping, HeavyDampingIsStable) {
  MechanicsOptions o;
  o.loads.damping.mass = 1e12;
  Connector damper = spring_to_ground(1e15, {"x_min"});
  damper.kind = Connector::Kind::dashpot;
  o.loads.connectors = {damper};
  o.initial_velocities.push_back({"", "", {1, -2, 3}, {}, {}});
  const auto b = body(shared_mesh(on_root(box({0, 0, 0}, {1, 1, 1}, {2, 2, 2}))), steel(), o);
  b->initialize();
  const double energy = energy_rows(*b).at("kinetic_energy");
  for (int s = 0; s < 200; ++s) b->advance(b->time_step());
  EXPECT_LE(energy_rows(*b).at("kinetic_energy"), 1.001 * energy);
}

TEST(Damping, StiffnessProportionalDampingOfABreathingBar) {
  // Uniaxial strain, one element: the mode u = x on [0, L] with the end free; decay rate beta omega^2/2.
  const auto amplitude = [&](double beta, double* step) {
    MechanicsOptions o;
    o.viscosity = {0, 0};
    o.hourglass.form = HourglassOptions::Form::none;
    o.loads.damping.stiffness = beta;
    o.motions = {symmetry("x_min", {1, 0, 0}), symmetry("y_min", {0, 1, 0}), symmetry("y_max", {0, 1, 0}),
                 symmetry("z_min", {0, 0, 1}), symmetry("z_max", {0, 0, 1})};
    o.initial_velocities.push_back({"", "x_max", {1e-3, 0, 0}, {}, {}});
    o.time_step.scale = 0.05;
    const auto b = body(shared_mesh(on_root(BoxShape{})), elastic_material(1e9, 0, 1000), o);
    b->initialize();
    *step = b->time_step();
    Ledger ledger(*b);
    const double omega = std::sqrt(2 * 1e9 / 1000.0), period = 2 * std::numbers::pi / omega;
    run_to(*b, 5 * period);
    EXPECT_LE(ledger.error(), 1e-13);
    const auto rows = energy_rows(*b);
    return rows.at("kinetic_energy") + rows.at("internal_energy");
  };
  double free_step = 0, step = 0;
  const double omega = std::sqrt(2 * 1e9 / 1000.0), beta = 0.02 / omega;
  const double before = amplitude(0, &free_step), after = amplitude(beta, &step);
  EXPECT_NEAR(std::log(before / after), beta * omega * omega * 10 * std::numbers::pi / omega, 0.01);
  EXPECT_LT(step, free_step);
}

TEST(InitialStress, PushesTheFreeEndAsItsTraction) {
  MechanicsOptions o;
  InitialStress initial{{}, {}, "initial stress"};
  initial.stress[0] = always(-3e6);
  o.loads.initial_stresses = {initial};
  const auto b = body(shared_mesh(on_root(box({0, 0, 0}, {2, 1, 1}, {4, 2, 2}))), steel(), o);
  b->initialize();
  ExactSum force;
  for (const LocalIndex n : nodes_of_sets(b->mesh(), {"x_max"}, "test"))
    if (b->mesh().owns_node(n)) force.add(b->internal_force()[static_cast<std::size_t>(n)].v[0]);
  EXPECT_NEAR(b->mesh().comm.sum(force), -3e6, 1e-8);  // resisting: it pushes outwards
}

TEST(MassScaling, EveryElementAllowsTheStepAndTheMassIsReported) {
  MechanicsOptions o;
  BoxShape shape = box({0, 0, 0}, {1, 1, 1}, {4, 2, 2});
  shape.grading = {8, 1, 1};
  const auto make = [&] { return body(shared_mesh(on_root(shape)), steel(), o); };
  const auto plain = make();
  plain->initialize();
  o.loads.mass_scaling = MassScaling{1.5 * plain->time_step(), 0.5};
  const auto b = make();
  b->initialize();
  EXPECT_GE(b->time_step(), 1.5 * plain->time_step() * (1 - 1e-9));
  const double mass = sum_over_nodes(*b, [&](std::size_t n) { return b->nodal_mass()[n]; });
  double shown = 0;
  for (const HistoryValue& value : b->history_values())
    if (value.column == "added_mass") shown = value.local;
  EXPECT_GT(shown, 0);
  EXPECT_NEAR(mass - 7850, shown, 1e-9);
  ASSERT_EQ(b->warnings().size(), 1u);
  EXPECT_NE(b->warnings()[0].find("mass scaling added"), std::string::npos);
  o.loads.mass_scaling->limit = 0.01 * shown / 7850;
  EXPECT_THROW(make(), Error);
}

}  // namespace
}  // namespace tenon::testing

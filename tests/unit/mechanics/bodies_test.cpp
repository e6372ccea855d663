// SPDX-License-Identifier: BSD-3-Clause
// Rigid bodies and ties together with walls and damping, and the inertia of rigid shells.
#include <functional>

#include "components/mechanics/connectors.hpp"
#include "constraints_case.hpp"
#include "shell_case.hpp"

namespace tenon::testing {
namespace {

RigidBody rigid(std::vector<std::string> blocks) {
  RigidBody body;
  body.blocks = std::move(blocks);
  body.label = "rigid body";
  return body;
}

RigidWall floor_below(double z, std::vector<std::string> sets) {
  return {{0, 0, z}, {0, 0, 1}, TimeFunction::constant(0), std::move(sets), "wall below"};
}

/// Two bricks one over the other, the upper one rigid and falling.
std::unique_ptr<Mechanics> falling(const RigidWall& wall, std::vector<Part> parts) {
  MechanicsOptions o;
  o.loads.rigid_bodies = {rigid({"a"})};
  o.walls = {wall};
  o.initial_velocities = {{"", "", {0, 0, -20}, {}, {}}};
  return body(shared_mesh(joined(parts)), steel(), o);
}

void expect_refusal(const std::function<void()>& act, const std::string& words) {
  try {
    act();
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

const Part upper{"a", box({0, 0, 1}, {1, 1, 2}, {2, 2, 2})}, beside{"b", box({2, 0, 1}, {3, 1, 2}, {2, 2, 2})};

TEST(WallsAndBodies, AWallThatNamesRigidNodesIsRefused) {
  expect_refusal([] { falling(floor_below(0, {"b_z_min", "a_z_min"}), {upper, beside}); }, "wall below");
}

TEST(WallsAndBodies, AWallWithNothingButRigidNodesIsRefused) {
  expect_refusal([] { falling(floor_below(0, {}), {upper}); }, "all of its nodes are tied or belong to rigid bodies");
}

TEST(WallsAndBodies, AWallForEveryNodeSaysThatItLeavesRigidOnesOut) {
  const auto b = falling(floor_below(1 - 1e-9, {}), {upper, beside});
  b->initialize();
  ASSERT_EQ(b->warnings().size(), 1u);
  EXPECT_NE(b->warnings()[0].find("27 nodes"), std::string::npos) << b->warnings()[0];
  Ledger ledger(*b);
  for (int s = 0; s < 20; ++s) b->advance(b->time_step());
  EXPECT_EQ(b->rigid_bodies().state(0).velocity[2], -20);
  EXPECT_GT(std::abs(energy_rows(*b).at("internal_energy")), 1e3);  // the other one is stopped
  EXPECT_LT(ledger.error(), 1e-12);
}

TEST(WallsAndBodies, AWallThatNamesTiedNodesIsRefused) {
  MechanicsOptions o;
  o.loads.ties = {{{"b_x_min"}, {"a_x_max"}, 0.1, "tied"}};
  o.walls = {floor_below(0, {"b_z_min"})};
  expect_refusal(
      [&] {
        body(shared_mesh(joined({upper, {"b", box({1, 0, 1}, {2, 1, 2}, {3, 3, 3})}})), steel(), o);
      },
      "is tied or belongs to a rigid body");
}

// Nodes off an edge, as near to the one side of an element as to the other: the same face on any ranks.
TEST(TiedEdges, TheFirstOfEquallyNearSidesHoldsTheNode) {
  MechanicsOptions o;
  o.loads.ties = {{{"b_x_min"}, {"a_z_max", "a_x_max"}, 0.3, "tied"}};
  o.initial_velocities = {{"a", "", {1, 2, 3}, {0, -30, 7, 30, 0, 11, -7, 5, 0}, {}}};
  const std::vector<Part> parts{{"a", box({0, 0, 0}, {1, 1, 1}, {3, 3, 3})},
                                {"b", box({1.1, 0.03, 1.1}, {2, 0.97, 1.15}, {2, 7, 1})}};
  const auto shared = body(shared_mesh(joined(parts)), steel(), o), whole = body(whole_mesh(joined(parts)), steel(), o);
  shared->initialize(), whole->initialize();
  for (int s = 0; s < 10; ++s) {
    ASSERT_EQ(shared->time_step(), whole->time_step());
    shared->advance(shared->time_step()), whole->advance(whole->time_step());
  }
  for (const char* name : {"displacement", "velocity", "stress"})
    expect_same_bits(in_global_order(*shared, name), in_global_order(*whole, name), name);
}

// Each node to the nearest of the other set, however far; of two at one distance to that of the smaller id.
TEST(Links, GoToTheNearestNodeOnAnyRanks) {
  const auto mesh = shared_mesh(joined({{"a", box({0, 0, 0}, {1, 1, 1}, {4, 4, 4})},
                                        {"b", box({50, 0.125, 0}, {51, 0.875, 1}, {2, 3, 4})},
                                        {"c", box({50, 0, 1.5}, {51, 1, 2}, {1, 1, 1})}}));
  Connector c;
  c.ends = Connector::Ends::sets;
  c.node_sets = {"a_x_max"}, c.other_sets = {"b_x_min", "c_x_max"};
  c.law = {{0, 0}, {1, 1}};
  c.label = "spring";
  const std::vector<Link> links = find_links(*mesh, c);
  EXPECT_TRUE(std::ranges::is_sorted(links, {}, &Link::first));
  ExactSum firsts;
  for (const Link& link : links) {
    const auto at = std::ranges::lower_bound(mesh->node_ids, link.first);
    const auto owned = [&](GlobalId id) {
      const auto found = std::ranges::lower_bound(mesh->node_ids, id);
      return found != mesh->node_ids.end() && *found == id &&
             mesh->owns_node(static_cast<LocalIndex>(found - mesh->node_ids.begin()));
    };
    ASSERT_TRUE(owned(link.first) || owned(link.second));
    if (owned(link.first)) {
      EXPECT_EQ(mesh->coordinates[static_cast<std::size_t>(at - mesh->node_ids.begin())], link.first_place);
      firsts.add(1);
    }
    // Rows of b at y = 0.125, 0.375, 0.625, 0.875: half way between those of a; the lower one has the smaller id.
    const double y = link.first_place[1];
    EXPECT_EQ(link.second_place, (Vec3{50, y == 0 ? 0.125 : y - 0.125, link.first_place[2]}));
  }
  EXPECT_EQ(mesh->comm.sum(firsts), 25);
}

/// A body alone under damping, and what it had and lost.
struct Damped {
  static constexpr double alpha = 400, dt = 1e-4;
  static constexpr int steps = 100;
  std::unique_ptr<Mechanics> body;
  double energy, lost, error;

  explicit Damped(const RigidBody& options) {
    MechanicsOptions o;
    o.loads.rigid_bodies = {options};
    o.loads.damping.mass = alpha;
    body = testing::body(shared_mesh(joined({{"a", box({0, 0, 0}, {0.2, 0.1, 0.05}, {2, 2, 2}, 0.2)}})), steel(), o);
    body->initialize();
    energy = energy_rows(*body).at("kinetic_energy");
    Ledger ledger(*body);
    for (int s = 0; s < steps; ++s) body->advance(dt);
    lost = energy_rows(*body).at("damping_energy");
    error = ledger.error();
  }
  /// What is left of a momentum by the midpoint rule; the first kick is half a step.
  static double factor() {
    const double first = 0.25 * alpha * dt, next = 0.5 * alpha * dt;
    return (1 - first) / (1 + first) * std::pow((1 - next) / (1 + next), steps - 1);
  }
};

/// Angular momentum of the same body at the start.
Vec3 alone_momentum(const RigidBody& options) {
  MechanicsOptions o;
  o.loads.rigid_bodies = {options};
  const auto b = body(shared_mesh(joined({{"a", box({0, 0, 0}, {0.2, 0.1, 0.05}, {2, 2, 2}, 0.2)}})), steel(), o);
  b->initialize();
  return b->rigid_bodies().state(0).momentum;
}

TEST(DampedBodies, AFreeBodyLosesItsMomentaByTheMidpointRule) {
  RigidBody options = rigid({"a"});
  options.velocity = Vec3{1, -2, 3}, options.spin = Vec3{30, -20, 10};
  const Damped d(options);
  const auto undamped = alone_momentum(options);
  const RigidState& state = d.body->rigid_bodies().state(0);
  EXPECT_NEAR(norm(state.velocity - Damped::factor() * Vec3{1, -2, 3}), 0, 1e-12);
  EXPECT_NEAR(norm(state.momentum - Damped::factor() * undamped), 0, 1e-11 * norm(undamped));
  EXPECT_NEAR(d.lost, d.energy - energy_rows(*d.body).at("kinetic_energy"), 1e-12 * d.energy);
  EXPECT_GT(d.lost, 0.9 * d.energy);
  EXPECT_LT(d.error, 1e-13);
}

TEST(DampedBodies, AHingeLosesItsSpin) {
  RigidBody options = rigid({"a"});
  options.joint = Vec3{0, 0, 0};
  options.rotation = RigidBody::Rotation::hinge;
  options.axis = {0, 0, 1};
  options.spin = Vec3{0, 0, 50};
  const Damped d(options);
  EXPECT_NEAR(d.body->rigid_bodies().spin(0)[2], 50 * Damped::factor(), 1e-11);
  EXPECT_NEAR(d.lost, d.energy * (1 - Damped::factor() * Damped::factor()), 1e-12 * d.energy);
  EXPECT_LT(d.error, 1e-13);
}

TEST(DampedBodies, WhatPrescribesTheMotionPaysForTheDamping) {
  RigidBody options = rigid({"a"});
  options.rotation = RigidBody::Rotation::fixed;
  options.prescribed_velocity = {TimeFunction::constant(0), TimeFunction::constant(0), TimeFunction::constant(20)};
  const Damped d(options);
  const double mass = 7.85, time = Damped::dt * (Damped::steps - 0.5);  // of the kicks
  EXPECT_NEAR(d.lost, Damped::alpha * mass * 400 * time, 1e-10 * d.lost);
  EXPECT_NEAR(energy_rows(*d.body).at("rigid_body_work"), d.lost, 1e-12 * d.lost);
  EXPECT_LT(d.error, 1e-13);
}

/// A rigid plate of quads or triangles in the plane z = 1.
std::unique_ptr<Mechanics> plate(const ShellGrid& grid, double thickness, ShellSection::Reference reference) {
  MechanicsOptions o;
  ShellSection section;
  section.thickness = thickness, section.reference = reference;
  auto mesh = shared_mesh(shell_grid(grid, [](double r, double s) { return Vec3{0.6 * r, 0.4 * s, 1}; }));
  std::vector<std::string> names;
  for (const ElementBlock& block : mesh->blocks) {
    o.blocks.push_back({block.name, steel(), {}, section});
    names.push_back(block.name);
  }
  o.loads.rigid_bodies = {rigid(names)};
  return std::make_unique<Mechanics>("plate", std::move(mesh), o);
}

TEST(RigidShells, MassAndInertiaAreThoseOfThePlate) {
  const double a = 0.6, b = 0.4, t = 0.02, m = 7850 * a * b * t;
  using Cells = ShellGrid::Cells;
  for (const ShellGrid& grid : {ShellGrid{1, 1, Cells::quads}, ShellGrid{3, 2, Cells::quads},
                                ShellGrid{1, 1, Cells::triangles}, ShellGrid{3, 3, Cells::mixed}}) {
    const auto p = plate(grid, t, ShellSection::Reference::middle);
    const RigidInertia& found = p->rigid_bodies().inertia(0);
    EXPECT_NEAR(found.mass, m, 1e-12 * m);
    EXPECT_NEAR(norm(p->rigid_bodies().state(0).pivot - Vec3{0.5 * a, 0.5 * b, 1}), 0, 1e-14);
    EXPECT_NEAR(found.inertia.xx, m * (b * b + t * t) / 12, 1e-12 * m);
    EXPECT_NEAR(found.inertia.yy, m * (a * a + t * t) / 12, 1e-12 * m);
    EXPECT_NEAR(found.inertia.zz, m * (a * a + b * b) / 12, 1e-12 * m);
    EXPECT_NEAR(found.inertia.xy, 0, 1e-12 * m);
  }
}

TEST(RigidShells, OffTheirMiddleSurfaceAreRefused) {
  expect_refusal(
      [] {
        plate({1, 1, ShellGrid::Cells::quads}, 0.02, ShellSection::Reference::top);
      },
      "expected reference: middle");
}

}  // namespace
}  // namespace tenon::testing

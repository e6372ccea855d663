// SPDX-License-Identifier: BSD-3-Clause
// Prescribed motions and rigid walls: exact places, combinations, conflicts, work.
#include <numbers>

#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

using Kind = PrescribedMotion::Kind;

BoxShape small_box() {
  BoxShape box;
  box.elements = {3, 3, 3};
  box.distortion = 0.2;
  return box;
}

const std::vector<std::string> all_faces{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

double set_extreme(Mechanics& m, const std::string& set, const std::function<double(const Vec3&, const Vec3&)>& f) {
  double most = 0;
  for (const LocalIndex n : m.mesh().find_node_set(set)->nodes) {
    const auto i = static_cast<std::size_t>(n);
    most = std::max(most, std::abs(f(m.mesh().coordinates[i], m.current_coordinates()[i])));
  }
  return communicator().max(most);
}

TEST(Conditions, PrescribedDisplacementIsReachedAtEveryStep) {
  MechanicsOptions options;
  PrescribedMotion pull = motion(Kind::displacement, {"x_max"});
  pull.components = {true, false, true};
  pull.value[0] = TimeFunction::sine(1e-3, 1e-3, 0, 0);
  pull.value[2] = TimeFunction::constant(0);
  options.motions.push_back(pull);
  const auto m = body(shared_mesh(on_root(small_box())), steel(), options);
  m->initialize();
  for (int s = 0; s < 20; ++s) {
    m->advance(m->time_step());
    const double wanted = pull.value[0](m->time());
    EXPECT_LT(set_extreme(*m, "x_max", [&](const Vec3& X, const Vec3& x) { return x[0] - X[0] - wanted; }), 1e-15);
    EXPECT_LT(set_extreme(*m, "x_max", [&](const Vec3& X, const Vec3& x) { return x[2] - X[2]; }), 1e-15);
  }
}

TEST(Conditions, PrescribedVelocityIsThatOfMidStep) {
  MechanicsOptions options;
  PrescribedMotion push = motion(Kind::velocity, {"z_min"});
  push.components = {false, false, true};
  push.value[2] = TimeFunction::table({{0, 0}, {1, 1e4}});
  options.motions.push_back(push);
  const auto m = body(shared_mesh(on_root(small_box())), steel(), options);
  m->initialize();
  run_to(*m, 1e-4);
  // The midpoint rule is exact for a linear velocity.
  EXPECT_LT(set_extreme(*m, "z_min", [&](const Vec3& X, const Vec3& x) { return x[2] - X[2] - 0.5 * 1e4 * 1e-8; }),
            1e-12);
}

TEST(Conditions, ObliquePlanesCombineOnOneNode) {
  const Vec3 a{1, 0.2, -0.1}, b{-0.3, 1, 0.4};
  MechanicsOptions options;
  options.motions = {symmetry("x_min", a), symmetry("y_min", b)};
  PrescribedMotion push = motion(Kind::velocity, {"z_max"});
  push.components = {false, false, true};
  push.value[2] = TimeFunction::constant(-20);
  options.motions.push_back(push);
  options.initial_velocities.push_back({"", "", {30, 20, 10}, {}, {}});
  const auto m = body(shared_mesh(on_root(small_box())), steel(), options);
  m->initialize();
  for (int s = 0; s < 20; ++s) m->advance(m->time_step());
  const double down = 20 * m->time();
  EXPECT_LT(set_extreme(*m, "x_min", [&](const Vec3& X, const Vec3& x) { return dot(a, x - X); }), 1e-15);
  EXPECT_LT(set_extreme(*m, "y_min", [&](const Vec3& X, const Vec3& x) { return dot(b, x - X); }), 1e-15);
  EXPECT_LT(set_extreme(*m, "z_max", [&](const Vec3& X, const Vec3& x) { return x[2] - X[2] + down; }), 1e-15);
  EXPECT_GT(set_extreme(*m, "z_max", [&](const Vec3& X, const Vec3& x) { return x[0] - X[0]; }), 1e-5);
}

TEST(Conditions, RotationFollowsTheAngle) {
  MechanicsOptions options;
  PrescribedMotion turn = motion(Kind::rotation, all_faces);
  turn.axis = {0, 0, 2};
  turn.centre = {0.5, 0.5, 0};
  turn.factor = TimeFunction::table({{0, 0}, {1e-3, 0.5 * std::numbers::pi}});
  options.motions.push_back(turn);
  options.time_step.fixed = 1e-5;
  const auto m = body(shared_mesh(on_root(small_box())), steel(), options);
  m->initialize();
  run_to(*m, 1e-3);
  EXPECT_LT(set_extreme(*m, "x_max", [](const Vec3& X, const Vec3& x) { return x[0] - 0.5 + (X[1] - 0.5); }), 1e-14);
  EXPECT_LT(set_extreme(*m, "x_max", [](const Vec3& X, const Vec3& x) { return x[1] - 0.5 - (X[0] - 0.5); }), 1e-14);
}

TEST(Conditions, ContradictionsAreRefusedOnAllRanks) {
  MechanicsOptions options;
  PrescribedMotion push = motion(Kind::velocity, {"z_max"});
  push.value[0] = TimeFunction::constant(1);
  options.motions = {push, symmetry("x_min", {1, 0, 0})};
  const auto mesh = shared_mesh(on_root(small_box()));
  try {
    body(mesh, steel(), options);
    ADD_FAILURE() << "accepted";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ExitCode::usage);
    EXPECT_NE(std::string(e.what()).find("z_max"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("x_min"), std::string::npos) << e.what();
  }
}

TEST(Conditions, AgreeingOnesAreAccepted) {
  MechanicsOptions options;
  options.motions = {motion(Kind::fixed, {"z_min"}), symmetry("x_min", {1, 0, 0}), symmetry("z_min", {0, 0.3, 1})};
  EXPECT_NO_THROW(body(shared_mesh(on_root(small_box())), steel(), options));
}

TEST(Conditions, WallsOnTheWrongSideAreRefused) {
  const auto mesh = shared_mesh(on_root(small_box()));
  MechanicsOptions options;
  options.walls.push_back({{0, 0, 0}, {0, 0, -1}, TimeFunction::constant(0), {}, "wall"});
  EXPECT_THROW(body(mesh, steel(), options), Error);
  PrescribedMotion bonded = motion(Kind::wall, {"z_min"});
  bonded.centre = {0, 0, 0.1};
  MechanicsOptions other;
  other.motions.push_back(bonded);
  EXPECT_THROW(body(mesh, steel(), other), Error);
}

// A block flies against a corner of two oblique walls: nothing passes, and it leaves again.
TEST(Conditions, NothingPassesAWallAndNothingSticks) {
  MechanicsOptions options;
  options.initial_velocities.push_back({"", "", {-20, 0, -30}, {}, {}});
  const Vec3 down{0.1, 0, 1}, left{1, 0, 0.2};
  options.walls.push_back({{0, 0, -0.12}, down, TimeFunction::constant(0), {}, "floor"});
  options.walls.push_back({{-0.1, 0, 0}, left, TimeFunction::constant(0), {}, "side"});
  options.motions = {symmetry("y_min", {0, 1, 0})};
  const auto m = body(shared_mesh(on_root(small_box())), elastic_material(1e9, 0.3, 1000), options);
  m->initialize();
  Ledger ledger(*m);
  double error = 0;
  bool touched = false;
  while (m->time() < 0.02) {
    m->advance(m->time_step());
    for (const Vec3& x : m->current_coordinates()) {
      EXPECT_GT(dot(down, x) + 0.12, -1e-12);
      EXPECT_GT(dot(left, x) + 0.1, -1e-12);
    }
    error = std::max(error, ledger.error());
    touched = touched || energy_rows(*m)["wall_work"] < 0;
  }
  EXPECT_TRUE(touched);
  EXPECT_LT(error, 1e-12);
  // It bounces off both.
  double up = 0, right = 0;
  for (const LocalIndex n : m->mesh().owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    up += m->current_coordinates()[i][2] - m->mesh().coordinates[i][2];
    right += m->current_coordinates()[i][0] - m->mesh().coordinates[i][0];
  }
  std::vector<double> sums{up, right};
  ExactSum all_up, all_right;
  all_up.add(up), all_right.add(right);
  EXPECT_GT(communicator().sum(all_up), 0);
  EXPECT_GT(communicator().sum(all_right), 0);
}

TEST(Conditions, AMovingWallPushesAndItsWorkIsBooked) {
  MechanicsOptions options;
  options.walls.push_back({{0, 0, 0}, {0, 0, 1}, TimeFunction::smooth_step(0, 0.05, 0, 2e-3), {}, "ram"});
  const auto m = body(shared_mesh(on_root(small_box())), elastic_material(1e9, 0.3, 1000), options);
  m->initialize();
  Ledger ledger(*m);
  run_to(*m, 2e-3);
  EXPECT_GT(energy_rows(*m)["wall_work"], 0);
  EXPECT_LT(ledger.error(), 1e-12);
  for (const Vec3& x : m->current_coordinates()) EXPECT_GT(x[2], 0.05 - 1e-9);
}

}  // namespace
}  // namespace tenon::testing

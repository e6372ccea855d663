// SPDX-License-Identifier: BSD-3-Clause
// Impacts with subcycling, in which levels are chosen anew: the same bits on any number of ranks, and after a restart.
#include <cstdio>
#include <filesystem>

#include "shell_case.hpp"
#include "solid_meshes.hpp"

namespace tenon::testing {
namespace {

MechanicsOptions impact() {
  MechanicsOptions options;
  options.time_step.subcycling = 16;
  options.heat = HeatMode::adiabatic;
  options.initial_velocities.push_back({"", "", {-180, 20, 5}, {}, {}});
  options.walls.push_back({{0, 0, 0}, {1, 0, 0}, TimeFunction::constant(0), {"x_min"}, "wall"});
  return options;
}

std::unique_ptr<Mechanics> bar(bool whole, ElementKind kind, MechanicsOptions::Formulation formulation) {
  BoxShape box;
  box.high = {0.06, 0.012, 0.012};
  box.elements = {14, 3, 3};
  box.grading = {12, 1, 1};
  box.distortion = 0.2;
  MaterialDescription metal = copper();
  metal.failure.emplace().plastic_strain = 0.6;
  const MeshData data = solid_box(box, kind);
  return solid_body(whole ? whole_mesh(data) : shared_mesh(MeshData(data)), metal, formulation, impact());
}

std::unique_ptr<Mechanics> panel(bool whole) {
  const MeshData data = shell_grid({9, 5, ShellGrid::Cells::mixed}, [](double r, double s) {
    return Vec3{0.2 * r * r + 0.02 * r, 0.1 * s, 0.01 * std::sin(3 * r)};
  });
  MechanicsOptions options;
  options.time_step.subcycling = 8;
  options.initial_velocities.push_back({"", "", {20, 0, -150}, {0, -300, 0, 300, 0, 100, 0, -100, 0}, {}});
  options.motions = {hold("r0", "xyzrxryrz")};
  return shell_body(whole ? whole_mesh(data) : shared_mesh(MeshData(data)), copper(), section(0.003), options);
}

constexpr const char* fields[] = {"displacement", "velocity", "stress", "eqps", "temperature"};

void expect_same(Mechanics& a, Mechanics& b) {
  for (const char* name : fields) expect_same_bits(in_global_order(a, name), in_global_order(b, name), name);
  EXPECT_EQ(energy_rows(a), energy_rows(b));
}

template <typename Make>
void same_bits(Make make, int steps) {
  const auto shared = make(false), whole = make(true);
  shared->initialize(), whole->initialize();
  ASSERT_GE(shared->subcycling()->greatest(), 1);
  for (int s = 0; s < steps; ++s) {
    ASSERT_EQ(shared->time_step(), whole->time_step()) << "step " << s;
    shared->advance(shared->time_step());
    whole->advance(whole->time_step());
  }
  expect_same(*shared, *whole);
  EXPECT_GT(energy_rows(*shared)["plastic_work"], 0);
}

template <typename Make>
void restart(Make make, int before, int after, const std::string& what) {
  const std::string file = "mechanics_restart_" + what + std::to_string(communicator().size()) + ".h5";
  const auto whole = make(false);
  whole->initialize();
  for (int s = 0; s < before; ++s) whole->advance(whole->time_step());
  {
    CheckpointWriter writer(communicator(), file);
    whole->save(writer);
    writer.finish();
  }
  const auto continued = make(false);
  {
    const CheckpointReader reader(communicator(), file);
    continued->set_clock(whole->time());
    continued->load(reader);
  }
  continued->initialize();
  for (int s = 0; s < after; ++s) {
    ASSERT_EQ(continued->time_step(), whole->time_step()) << "step " << s;
    whole->advance(whole->time_step());
    continued->advance(continued->time_step());
  }
  expect_same(*continued, *whole);
  communicator().barrier();
  if (communicator().rank() == 0) std::filesystem::remove(file);
}

const auto hexes = [](bool whole) { return bar(whole, ElementKind::hex8, MechanicsOptions::Formulation::automatic); };
const auto tets = [](bool whole) { return bar(whole, ElementKind::tet4, MechanicsOptions::Formulation::full); };
const auto averaged = [](bool whole) {
  return bar(whole, ElementKind::wedge6, MechanicsOptions::Formulation::automatic);
};

TEST(SubcyclingRanks, HexesSameBits) {
  same_bits(hexes, 120);
}
TEST(SubcyclingRanks, TetrahedraSameBits) {
  same_bits(tets, 40);
}
TEST(SubcyclingRanks, ShellsSameBits) {
  same_bits(panel, 60);
}

// A block that needs nodal averages has one level.
TEST(SubcyclingRanks, AveragedWedgesHaveOneLevel) {
  const auto m = averaged(false);
  m->initialize();
  EXPECT_EQ(m->subcycling()->greatest(), 0);
  m->advance(m->time_step());
}

TEST(SubcyclingRanks, HexesRestartBitwise) {
  restart(hexes, 45, 60, "subcycled_hex");
}
TEST(SubcyclingRanks, ShellsRestartBitwise) {
  restart(panel, 25, 30, "subcycled_shell");
}

/// An elastic box that rings: its least step comes and goes within a step of the longest.
std::unique_ptr<Mechanics> ringing(bool whole) {
  BoxShape box;
  box.high = {0.06, 0.01, 0.01};
  box.elements = {14, 2, 2};
  box.grading = {12, 1, 1};
  MechanicsOptions options;
  options.time_step.subcycling = 16;
  options.initial_velocity_function = [](const Vec3& x) { return Vec3{800 * x[0], -300 * x[1], 200 * x[0]}; };
  const MeshData data = on_root(box);
  return body(whole ? whole_mesh(data) : shared_mesh(MeshData(data)), steel(), options);
}

TEST(SubcyclingRanks, RingingRestartsBitwiseAtAnyStep) {
  for (const int cut : {1, 7, 20, 33}) restart(ringing, cut, 25, "subcycled_ring");
}

/// The crush that follows; a restart right after levels were chosen anew carries the impulses of the old ones.
std::unique_ptr<Mechanics> crushed(bool whole, int subcycling = 16) {
  BoxShape box;
  box.high = {0.06, 0.012, 0.012};
  box.elements = {14, 3, 3};
  box.grading = {1.0 / 12, 1, 1};
  MechanicsOptions options = impact();
  options.initial_velocities[0].velocity = {-300, 0, 0};
  options.time_step.subcycling = subcycling;
  const MeshData data = on_root(box);
  return body(whole ? whole_mesh(data) : shared_mesh(MeshData(data)), copper(), options);
}

TEST(SubcyclingRanks, NewLevelsRestartBitwise) {
  const auto m = crushed(false);
  m->initialize();
  const Subcycling* const first = m->subcycling();
  int steps = 0;
  for (; steps < 2000 && m->subcycling() == first; ++steps) m->advance(m->time_step());
  ASSERT_LT(steps, 2000);
  restart([](bool whole) { return crushed(whole); }, steps, 10, "subcycled_anew");
}

// The long elements meet the wall and become short: levels are chosen anew, and the shortest step is not theirs alone.
TEST(SubcyclingRanks, LevelsFollowTheDeformation) {
  const auto m = crushed(false);
  m->initialize();
  Ledger ledger(*m);
  const Subcycling* const first = m->subcycling();
  bool again = false;
  for (int s = 0; s < 2000 && !again; ++s) {
    m->advance(m->time_step());
    again = m->subcycling() != first;
  }
  EXPECT_TRUE(again);
  // The impact goes on as it does with equal steps: no impulse is lost or given twice.
  const double end = m->time();
  for (int s = 0; s < 40; ++s) m->advance(m->time_step());
  EXPECT_LT(ledger.error(), 1e-12);
  const auto plain = crushed(false, 1);
  plain->initialize();
  run_to(*plain, m->time());
  EXPECT_GT(m->time(), end);
  const double kinetic = energy_rows(*m)["kinetic_energy"], expected = energy_rows(*plain)["kinetic_energy"];
  EXPECT_NEAR(kinetic, expected, 0.01 * expected);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// A plastic, warped shell of quadrilaterals and triangles: the same bits on any number of ranks, and after a restart.
#include <cstdio>
#include <filesystem>

#include "shell_case.hpp"

namespace tenon::testing {
namespace {

MeshData panel() {
  return shell_grid({7, 6, ShellGrid::Cells::mixed}, [](double r, double s) {
    return Vec3{0.1 * r + 0.01 * r * s, 0.1 * s, 0.02 * r * s + 0.01 * std::sin(3 * r)};
  });
}

MaterialDescription failing() {
  MaterialDescription metal = copper();
  metal.failure.emplace().plastic_strain = 0.15;
  return metal;
}
/// All layers in one call (LayerLaw).
MaterialDescription layered() {
  MaterialDescription metal = copper();
  metal.plasticity = LinearHardeningParameters{100e6, 200e6};
  return metal;
}

std::unique_ptr<Mechanics> struck(std::shared_ptr<const Mesh> mesh, const MaterialDescription& metal) {
  MechanicsOptions options;
  options.heat = HeatMode::adiabatic;
  options.initial_velocities.push_back({"", "", {20, 0, -150}, {0, -300, 0, 300, 0, 100, 0, -100, 0}, {}});
  options.motions = {hold("r0", "xyzrxryrz"), hold("s0", "yrz")};
  options.walls.push_back({{0, 0, -0.01}, {0, 0, 1}, TimeFunction::constant(0), {}, "wall"});
  ShellSection s = section(0.003);
  s.reference = ShellSection::Reference::top;
  return shell_body(std::move(mesh), metal, s, options);
}

constexpr const char* fields[] = {"displacement", "velocity", "stress", "eqps", "temperature", "thickness"};

void expect_same_bits_of_ranks(const MaterialDescription& metal) {
  const auto shared = struck(shared_mesh(panel()), metal), whole = struck(whole_mesh(panel()), metal);
  shared->initialize();
  whole->initialize();
  for (int s = 0; s < 150; ++s) {
    ASSERT_EQ(shared->time_step(), whole->time_step()) << "step " << s;
    shared->advance(shared->time_step());
    whole->advance(whole->time_step());
  }
  for (const char* name : fields) expect_same_bits(in_global_order(*shared, name), in_global_order(*whole, name), name);
  EXPECT_EQ(energy_rows(*shared), energy_rows(*whole));
  EXPECT_GT(energy_rows(*shared)["plastic_work"], 0);
}

void expect_same_bits_after_restart(const MaterialDescription& metal) {
  const std::string file = "mechanics_restart_shell_" + std::to_string(communicator().size()) + ".h5";
  const auto whole = struck(shared_mesh(panel()), metal);
  whole->initialize();
  for (int s = 0; s < 60; ++s) whole->advance(whole->time_step());
  {
    CheckpointWriter writer(communicator(), file);
    whole->save(writer);
    writer.finish();
  }
  const auto continued = struck(shared_mesh(panel()), metal);
  {
    const CheckpointReader reader(communicator(), file);
    continued->set_clock(whole->time());
    continued->load(reader);
  }
  continued->initialize();
  for (int s = 0; s < 60; ++s) {
    ASSERT_EQ(continued->time_step(), whole->time_step()) << "step " << s;
    whole->advance(whole->time_step());
    continued->advance(continued->time_step());
  }
  for (const char* name : fields)
    expect_same_bits(in_global_order(*continued, name), in_global_order(*whole, name), name);
  EXPECT_EQ(energy_rows(*continued), energy_rows(*whole));
  communicator().barrier();
  if (communicator().rank() == 0) std::filesystem::remove(file);
}

TEST(ShellRanks, SameBits) {
  expect_same_bits_of_ranks(failing());
}
TEST(ShellRanks, SameBitsOfLayers) {
  expect_same_bits_of_ranks(layered());
}
TEST(ShellRanks, RestartContinuesBitwise) {
  expect_same_bits_after_restart(failing());
}
TEST(ShellRanks, RestartOfLayersContinuesBitwise) {
  expect_same_bits_after_restart(layered());
}

}  // namespace
}  // namespace tenon::testing

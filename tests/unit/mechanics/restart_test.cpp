// SPDX-License-Identifier: BSD-3-Clause
// A run that continues from a checkpoint is bit for bit the run that never stopped.
#include <cstdio>
#include <filesystem>

#include "mechanics_case.hpp"

namespace tenon::testing {
namespace {

MechanicsOptions impact(HourglassOptions::Form form) {
  MechanicsOptions options;
  options.hourglass.form = form;
  options.heat = HeatMode::exported;
  options.initial_velocities.push_back({"", "", {-150, 20, 0}, {}, {}});
  options.walls.push_back({{0, 0, 0}, {1, 0, 0}, TimeFunction::constant(0), {}, "wall"});
  options.motions = {symmetry("z_min", {0, 0, 1})};
  return options;
}

std::unique_ptr<Mechanics> make(HourglassOptions::Form form) {
  BoxShape box;
  box.high = {0.02, 0.01, 0.01};
  box.elements = {5, 3, 3};
  box.distortion = 0.2;
  return body(shared_mesh(on_root(box)), copper(), impact(form));
}

void check(HourglassOptions::Form form, const std::string& file) {
  const auto whole = make(form);
  whole->initialize();
  for (int s = 0; s < 60; ++s) whole->advance(whole->time_step());
  field(*whole, "plastic_heat");
  {
    CheckpointWriter writer(communicator(), file);
    whole->save(writer);
    writer.finish();
  }
  const auto continued = make(form);
  {
    const CheckpointReader reader(communicator(), file);
    continued->set_clock(whole->time());
    continued->load(reader);
  }
  continued->initialize();
  EXPECT_EQ(continued->time_step(), whole->time_step());
  for (int s = 0; s < 60; ++s) {
    whole->advance(whole->time_step());
    continued->advance(continued->time_step());
  }
  EXPECT_EQ(continued->time(), whole->time());
  for (const char* name : {"displacement", "velocity", "stress", "eqps", "temperature", "plastic_heat"})
    expect_same_bits(in_global_order(*continued, name), in_global_order(*whole, name), name);
  EXPECT_EQ(energy_rows(*continued), energy_rows(*whole));
  communicator().barrier();
  if (communicator().rank() == 0) std::filesystem::remove(file);
}

TEST(Restart, ContinuesBitwiseWithViscousHourglass) {
  check(HourglassOptions::Form::viscous, "mechanics_restart_viscous_" + std::to_string(communicator().size()) + ".h5");
}

TEST(Restart, ContinuesBitwiseWithPhysicalHourglass) {
  check(HourglassOptions::Form::physical,
        "mechanics_restart_physical_" + std::to_string(communicator().size()) + ".h5");
}

TEST(Restart, ContinuesBitwiseWithStiffnessHourglass) {
  check(HourglassOptions::Form::stiffness,
        "mechanics_restart_stiffness_" + std::to_string(communicator().size()) + ".h5");
}

}  // namespace
}  // namespace tenon::testing

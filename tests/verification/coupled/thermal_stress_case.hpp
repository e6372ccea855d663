// SPDX-License-Identifier: BSD-3-Clause
// Bodies that conduction warms through a transfer, and the bimetal strip of case F03.
#pragma once

#include <cstdio>

#include "components/thermal/thermal.hpp"
#include "constraints_case.hpp"
#include "framework/simulation/simulation.hpp"
#include "shell_case.hpp"
#include "transfer/field_link.hpp"

namespace tenon::testing::thermal_stress {

using Form = HourglassOptions::Form;
using Formulation = MechanicsOptions::Formulation;

constexpr double start_temperature = 300, density = 7850, specific_heat = 460;

inline MaterialDescription metal(double youngs_modulus, double poissons_ratio, double expansion) {
  MaterialDescription m = elastic_material(youngs_modulus, poissons_ratio, density);
  m.elastic->expansion = expansion;
  m.thermal = ThermalProperties{50, specific_heat, start_temperature, 0.9};
  return m;
}

/// Insulated, with a source in all blocks that brings `rise` (K) between 0 and `duration`, smoothly enough.
inline std::unique_ptr<Component> warmed(const std::shared_ptr<const Mesh>& mesh, double rise, double duration,
                                         double step) {
  ThermalOptions options;
  const double power = rise * density * specific_heat / (0.5 * duration);
  for (const ElementBlock& block : mesh->blocks) {
    options.blocks.push_back({block.name, density, specific_heat, 50, start_temperature});
    options.sources.push_back(
        {block.name, TimeFunction::table({{0, 0}, {0.5 * duration, power}, {duration, 0}, {2 * duration, 0}})});
  }
  options.stepper = ThermalStepper::crank_nicolson;
  options.fixed_step = step;
  return std::make_unique<Thermal>("conduction", mesh, options);
}

/// Runs both until the end or until relaxation has converged.
inline std::unique_ptr<Simulation> run(std::unique_ptr<Component> heat, std::unique_ptr<Mechanics> solid, double end) {
  static Log log(false);
  auto simulation = std::make_unique<Simulation>(communicator(), log, 0.0, end);
  Component& source = simulation->add(std::move(heat));
  Component& target = simulation->add(std::move(solid));
  transfer::FieldLinkOptions link;
  link.source_field = link.target_field = "temperature";
  simulation->add(std::make_unique<transfer::FieldLink>("temperature", source, target, link));
  simulation->initialize();
  simulation->run();
  return simulation;
}

inline Mechanics& solid_of(Simulation& simulation) {
  return dynamic_cast<Mechanics&>(*simulation.components().back());
}

constexpr double bimetal_length = 0.1, bimetal_tip = 2.07692e-3, bimetal_rise = 50;

/// Deflection of the tip of steel and aluminium, 1 mm each, by 50 K from a mesh of its own; `ramp`: seconds of warming.
inline double settle_strip(std::unique_ptr<Mechanics> strip, double ramp) {
  const auto conducting = shared_mesh(on_root(box({0, 0, -2e-3}, {bimetal_length, 5e-3, 2e-3}, {10, 1, 2})));
  const auto simulation = run(warmed(conducting, bimetal_rise, ramp, ramp / 200), std::move(strip), 20 * ramp);
  Mechanics& b = solid_of(*simulation);
  EXPECT_TRUE(b.finished()) << b.ending();
  EXPECT_LT(simulation->ledger().take().error, 1e-11);
  std::printf("%s\n", b.ending().c_str());
  double tip = 0;
  for (std::size_t n = 0; n < b.mesh().coordinates.size(); ++n)
    if (b.mesh().coordinates[n][0] > bimetal_length * (1 - 1e-9))
      tip = b.current_coordinates()[n][2] - b.mesh().coordinates[n][2];
  return std::abs(tip);
}

inline MechanicsOptions relaxed(Form form, double ramp) {
  MechanicsOptions o;
  o.hourglass.form = form;
  o.viscosity = {0, 0};
  o.loads.relaxation = RelaxationOptions{1e-5, ramp};
  return o;
}

/// 4 + 4 layers of hexahedra, `n` along.
inline double hexahedra(int n, Form form, Formulation formulation) {
  const int layers = 8;
  MeshData data = on_root(box({0, 0, 0}, {bimetal_length, 5e-3, 2e-3}, {n, 1, layers}));
  if (communicator().rank() == 0) {
    BlockData &steel = data.blocks[0], aluminium = steel;
    const auto half = static_cast<std::ptrdiff_t>(steel.size() / 2);
    aluminium.name = "aluminium";
    aluminium.connectivity.erase(aluminium.connectivity.begin(), aluminium.connectivity.begin() + 8 * half);
    aluminium.labels.erase(aluminium.labels.begin(), aluminium.labels.begin() + half);
    steel.connectivity.resize(static_cast<std::size_t>(8 * half)), steel.labels.resize(static_cast<std::size_t>(half));
    data.blocks.push_back(aluminium);
  }
  const auto mesh = shared_mesh(std::move(data));
  constexpr double ramp = 2e-3;
  MechanicsOptions o = relaxed(form, ramp);
  o.motions = {motion(PrescribedMotion::Kind::fixed, {"x_min"}), symmetry("y_min", {0, 1, 0})};
  o.motions[0].components = {true, false, true};
  o.blocks = {{"box", metal(210e9, 0, 12e-6), formulation, {}}, {"aluminium", metal(70e9, 0, 24e-6), formulation, {}}};
  return settle_strip(std::make_unique<Mechanics>("strip", mesh, o), ramp);
}

/// Two shells on the same nodes, one above and one below.
inline double shells(int n) {
  MeshData data = shell_grid({n, 1}, [](double r, double s) { return Vec3{bimetal_length * r, 5e-3 * s, 0}; });
  if (communicator().rank() == 0) {
    data.blocks.push_back(data.blocks[0]);
    data.blocks[1].name = "aluminium";
    for (std::int64_t& label : data.blocks[1].labels) label += n;
  }
  const auto mesh = shared_mesh(std::move(data));
  constexpr double ramp = 2e-3;
  MechanicsOptions o = relaxed(Form::physical, ramp);
  o.motions = {hold("r0", "xyzrxryrz")};
  ShellSection below = section(1e-3), above = section(1e-3);
  below.reference = ShellSection::Reference::top, above.reference = ShellSection::Reference::bottom;
  o.blocks = {{"quads", metal(210e9, 0, 12e-6), {}, below}, {"aluminium", metal(70e9, 0, 24e-6), {}, above}};
  return settle_strip(std::make_unique<Mechanics>("strip", mesh, o), ramp);
}

inline void expect_tip(const char* what, double tip, double tolerance) {
  std::printf("F03 %s: tip %.5f mm, %.2f %% off\n", what, 1e3 * tip, 100 * (tip / bimetal_tip - 1));
  EXPECT_NEAR(tip, bimetal_tip, tolerance * bimetal_tip) << what;
}

}  // namespace tenon::testing::thermal_stress

// SPDX-License-Identifier: BSD-3-Clause
// Small heat conduction problems for the tests.
#pragma once

#include <cmath>
#include <memory>
#include <string>

#include "components/thermal/thermal.hpp"
#include "framework/mesh/generators.hpp"
#include "tests/support/test_communicator.hpp"

namespace tenon::testing {

/// Distributed over all ranks; made on rank 0.
inline std::shared_ptr<const Mesh> distributed(const BoxShape& shape) {
  MeshData data;
  if (communicator().rank() == 0) {
    data = generate(shape);
    add_derived_sets(data);
  }
  return distribute(communicator(), std::move(data), {});
}

inline BoxShape cube(int n, bool tetrahedra = false, double distortion = 0) {
  BoxShape shape;
  shape.elements = {n, n, n};
  shape.tetrahedra = tetrahedra;
  shape.distortion = distortion;
  return shape;
}

/// A bar along x, one element thick.
inline BoxShape bar(double length, int n) {
  BoxShape shape;
  const double width = length / n;
  shape.high = {length, width, width};
  shape.elements = {n, 1, 1};
  return shape;
}

/// rho c = 1/(conductivity / diffusivity): a block "box" with the wanted diffusivity (m^2/s).
inline ThermalBlock material(double conductivity, double diffusivity) {
  return {"box", conductivity / diffusivity, 1, conductivity, 0};
}

/// Temperature of the node nearest to a place, on all ranks.
inline double temperature_at(const Thermal& thermal, const Vec3& place) {
  const Mesh& mesh = thermal.mesh();
  double least = std::numeric_limits<double>::infinity(), value = 0;
  for (const LocalIndex n : mesh.owned_nodes) {
    const double d = norm(mesh.coordinates[static_cast<std::size_t>(n)] - place);
    if (d < least) least = d, value = thermal.temperature()[static_cast<std::size_t>(n)];
  }
  const bool mine = least == mesh.comm.min(least);
  return mesh.comm.max(mine ? value : -std::numeric_limits<double>::infinity());
}

/// Advances with the component's own step, the last one shortened.
inline void run_until(Thermal& thermal, double end) {
  while (end - thermal.time() > 1e-12 * end) thermal.advance(std::min(thermal.time_step(), end - thermal.time()));
}

/// Stored, supplied and |stored| + |supplied| energy, J.
struct Balance {
  double stored = 0, supplied = 0, size = 0;
  double error() const { return size > 0 ? std::abs(stored - supplied) / size : 0; }
};

inline Balance balance(Thermal& thermal) {
  std::vector<EnergyTerm> terms;
  thermal.energies(terms);
  Balance b;
  for (const EnergyTerm& term : terms) {
    const double value = thermal.mesh().comm.sum(term.local);
    if (term.role == EnergyTerm::Role::memo) continue;
    (term.role == EnergyTerm::Role::stored ? b.stored : b.supplied) += value;
    b.size += std::abs(value);
  }
  return b;
}

inline double energy(Thermal& thermal, const std::string& row) {
  std::vector<EnergyTerm> terms;
  thermal.energies(terms);
  for (const EnergyTerm& term : terms)
    if (term.row == row) return thermal.mesh().comm.sum(term.local);
  return std::nan("");
}

inline ImportPort import_port(Thermal& thermal, const std::string& field) {
  for (ImportPort& port : thermal.imports())
    if (port.field.name == field) return port;
  throw std::invalid_argument(field);
}

/// A problem with every kind of load on a distorted box.
inline ThermalOptions all_loads(ThermalStepper stepper) {
  ThermalOptions options;
  options.blocks = {{"box", 8960, 383, 386, 300}};
  options.stepper = stepper;
  if (stepper == ThermalStepper::backward_euler || stepper == ThermalStepper::crank_nicolson) options.fixed_step = 40;
  options.initial = {{"", "", 293.15, {30, 0, -20}}};
  options.prescribed = {{"x_min", TimeFunction::sine(5, 400, 0, 350)}};
  options.fluxes = {{"x_max", TimeFunction::table({{0, 0}, {300, 2e4}})}, {"y_min", TimeFunction::constant(-100)}};
  options.convection = {{"z_max", 250, TimeFunction::sine(50, 500, 0, 280)},
                        {"y_max", 20, TimeFunction::constant(400)}};
  options.sources = {{"box", TimeFunction::constant(1e3)}};
  return options;
}

/// The same with properties over temperature, melting in the range of temperatures, and radiation.
inline ThermalOptions all_loads_warm(ThermalStepper stepper) {
  ThermalOptions options = all_loads(stepper);
  ThermalBlock& block = options.blocks.front();
  block.conductivity_over_temperature = TemperatureTable({{280.0, 386.0}, {400.0, 300.0}});
  block.specific_heat_over_temperature = TemperatureTable({{280.0, 383.0}, {350.0, 420.0}});
  block.latent_heat = 2000, block.solidus = 300, block.liquidus = 301;
  options.radiation = {{"x_max", 0.8, TimeFunction::constant(500)}};
  return options;
}

/// Displaces every node by a smooth motion and hands some heat to all.
inline void disturb(Thermal& thermal, double amount) {
  const Mesh& mesh = thermal.mesh();
  std::vector<double> u, heat;
  for (const Vec3& x : mesh.coordinates) {
    for (std::size_t c = 0; c < 3; ++c) u.push_back(amount * std::sin(3 * x[c] + x[(c + 1) % 3]));
    heat.push_back(amount * 1e4 * (1 + x[0] * x[1]));
  }
  import_port(thermal, "displacement").write(u);
  import_port(thermal, "heat").write(heat);
}

}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// A coupled run without a scene file: a copper bar hits a wall (hexahedra) and heats up (tetrahedra), joined by two
// transfers.
//
//   build/coupled_bar                 on one rank
//   mpirun -n 3 build/coupled_bar     the same numbers, to the last bit
//
//        mechanics (hex8)  --- plastic_heat, conserved --->  conduction (tet4)
//                          <--- temperature, interpolated --
#include <cstdio>

#include "components/mechanics/mechanics.hpp"
#include "components/thermal/thermal.hpp"
#include "framework/mesh/generators.hpp"
#include "framework/simulation/simulation.hpp"
#include "transfer/field_link.hpp"

using namespace tenon;

namespace {

MaterialDescription copper() {
  MaterialDescription material;
  material.name = "copper";
  material.density = 8960;
  material.elastic = Elasticity{124e9, 0.34, 0};
  material.plasticity = JohnsonCookParameters{90e6, 292e6, 0.31, 0.025, 1.09, 1, 293.15, 1356};
  material.thermal = ThermalProperties{386, 383, 293.15, 0.9};
  return material;
}

/// A bar of radius 3.2 mm; every rank gets its part of the mesh.
std::shared_ptr<const Mesh> bar(const Communicator& comm, bool tetrahedra) {
  CylinderShape shape;
  shape.radius = 3.2e-3, shape.length = 12e-3, shape.tetrahedra = tetrahedra;
  shape.core = tetrahedra ? 6 : 4, shape.shell = tetrahedra ? 3 : 2, shape.axial = tetrahedra ? 20 : 12;
  return distribute(comm, comm.rank() == 0 ? generate(shape) : MeshData{}, {});
}

std::unique_ptr<Component> mechanics(const Communicator& comm) {
  MechanicsOptions options;
  options.blocks = {{"cylinder", copper(), {}, {}}};
  options.heat = HeatMode::exported;
  options.initial_velocities.push_back({"", "", {0, 0, -227}, {}, {}});
  PrescribedMotion wall;
  wall.kind = PrescribedMotion::Kind::wall;
  wall.node_sets = {"bottom"};
  options.motions.push_back(wall);
  return std::make_unique<Mechanics>("mechanics", bar(comm, false), options);
}

std::unique_ptr<Component> conduction(const Communicator& comm) {
  ThermalOptions options;
  options.blocks = {{"cylinder", 8960, 383, 386, 293.15}};
  options.stepper = ThermalStepper::crank_nicolson;
  options.fixed_step = 0.2e-6;
  return std::make_unique<Thermal>("conduction", bar(comm, true), options);
}

void run(const Communicator& comm) {
  Log log(comm.rank() == 0);
  Simulation simulation(comm, log, 0.0, 10e-6);
  Component& solid = simulation.add(mechanics(comm));
  Component& heat = simulation.add(conduction(comm));
  simulation.add(std::make_unique<transfer::FieldLink>(
      "heat", solid, heat,
      transfer::FieldLinkOptions{
          "plastic_heat", "heat", {}, transfer::Configuration::reference, CouplingSchedule::source_step}));
  transfer::FieldLinkOptions softening;
  softening.source_field = softening.target_field = "temperature";
  simulation.add(std::make_unique<transfer::FieldLink>("softening", heat, solid, softening));
  simulation.initialize();
  simulation.run();

  const LedgerSnapshot ledger = simulation.ledger().take();
  for (const LedgerRow& row : ledger.rows) log.print("{:<12} {:<20} {:.17g} J", row.component, row.row, row.value);
  log.print("ledger error {:.1e} after {} steps", ledger.error, simulation.steps());
}

}  // namespace

int main(int argc, char** argv) {
  const MpiEnvironment environment(argc, argv);
  const Communicator comm = Communicator::world();
  try {
    run(comm);
    return 0;
  } catch (const Error& error) {
    if (comm.rank() == 0) std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.code());
  }
}

// SPDX-License-Identifier: BSD-3-Clause
// Heat that arises at nodes of a surface (friction) goes through a transfer to the nodes of a thermal mesh: nothing is
// lost, on meshes that match and that do not, whatever the two steps are.
#include "components/thermal/thermal.hpp"
#include "framework/simulation/contact_party.hpp"
#include "framework/simulation/simulation.hpp"
#include "mechanics_case.hpp"
#include "transfer/field_link.hpp"

namespace tenon::testing {
namespace {

constexpr double density = 1000, specific_heat = 500;

BoxShape box(std::array<int, 3> elements, bool tetrahedra = false) {
  BoxShape shape;
  shape.elements = elements;
  shape.tetrahedra = tetrahedra;
  shape.distortion = tetrahedra ? 0.15 : 0;
  return shape;
}

std::unique_ptr<Component> insulated(const BoxShape& shape) {
  ThermalOptions options;
  options.blocks = {{"box", density, specific_heat, 1e-9, 0}};
  options.stepper = ThermalStepper::backward_euler;
  options.fixed_step = 1.7e-3;
  return std::make_unique<Thermal>("conduction", shared_mesh(on_root(shape)), options);
}

/// J, of a node in one step; on the top face only.
double heat_of(const Vec3& x, int step) {
  return x[2] > 1 - 1e-9 ? (1 + x[0] * x[0] + 0.3 * x[1]) * (1 + 0.1 * step) : 0;
}

struct Outcome {
  double given = 0, stored = 0, received = 0, ledger_error = 0;
  std::vector<double> temperature;
  std::vector<Vec3> places;
};

Outcome outcome(const BoxShape& solid_shape, const BoxShape& thermal_shape, CouplingSchedule schedule) {
  Log log(false);
  Simulation simulation(communicator(), log, 0.0, 0.02);
  auto solid = body(shared_mesh(on_root(solid_shape)), elastic_material(1e6, 0.3, density), {});
  ContactParty& party = *solid->contact_party();
  ContactFields& fields = party.contact_fields();
  const Mesh& mesh = solid->mesh();
  Component& mechanics = simulation.add(std::move(solid));
  Component& heat = simulation.add(insulated(thermal_shape));
  simulation.add(std::make_unique<transfer::FieldLink>(
      "friction", mechanics, heat,
      transfer::FieldLinkOptions{"friction_heat", "heat", {}, transfer::Configuration::reference, schedule}));
  simulation.initialize();
  ExactSum given;
  for (int step = 0; !simulation.done(); ++step) {
    for (const LocalIndex n : mesh.owned_nodes) {
      const double mine = heat_of(mesh.coordinates[static_cast<std::size_t>(n)], step);
      fields.friction_heat[static_cast<std::size_t>(n)] += mine;
      given.add(mine);
    }
    simulation.step();
  }
  Outcome o;
  o.given = communicator().sum(given);
  const LedgerSnapshot ledger = simulation.ledger().take();
  for (const LedgerRow& row : ledger.rows) {
    if (row.row == "thermal_energy") o.stored = row.value;
    if (row.row == "transferred_heat") o.received = row.value;
  }
  o.ledger_error = ledger.error;
  const auto& thermal = dynamic_cast<const Thermal&>(heat);
  o.temperature.assign(thermal.temperature().begin(), thermal.temperature().end());
  o.places = thermal.mesh().coordinates;
  return o;
}

void expect_kept(const Outcome& o) {
  EXPECT_GT(o.given, 100);
  EXPECT_NEAR(o.received, o.given, 1e-13 * o.given);
  EXPECT_NEAR(o.stored, o.given, 1e-13 * o.given);
  EXPECT_LT(o.ledger_error, 1e-11);
  for (std::size_t n = 0; n < o.places.size(); ++n)
    if (o.places[n][2] < 0.4) {
      EXPECT_NEAR(o.temperature[n], 0, 1e-6);
    }
}

TEST(SurfaceHeat, ReachesTheSameNodesOnTheSameMesh) {
  const BoxShape shape = box({3, 2, 2});
  const Outcome o = outcome(shape, shape, CouplingSchedule::source_step);
  expect_kept(o);
  // Heat over the capacity of a corner node and of the middle of an edge along x.
  const auto rise = [&](const Vec3& place) {
    double value = -1;
    for (std::size_t n = 0; n < o.places.size(); ++n)
      if (norm(o.places[n] - place) < 1e-9) value = o.temperature[n];
    return communicator().max(value);
  };
  EXPECT_NEAR(rise({1, 0, 1}) / rise({0, 0, 1}), 2, 1e-6);
  EXPECT_NEAR(rise({0, 1, 1}) / rise({0, 0, 1}), 1.3, 1e-6);
}

TEST(SurfaceHeat, IsKeptOnMeshesThatDoNotMatch) {
  for (const CouplingSchedule schedule : {CouplingSchedule::source_step, CouplingSchedule::slower_step}) {
    expect_kept(outcome(box({5, 4, 3}), box({3, 4, 4}, true), schedule));
    expect_kept(outcome(box({3, 3, 3}), box({5, 7, 4}), schedule));
  }
}

}  // namespace
}  // namespace tenon::testing

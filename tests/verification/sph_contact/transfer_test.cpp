// SPDX-License-Identifier: BSD-3-Clause
// Fields between particles and meshes: linear ones are exact, heat is kept, the same bits on any number of ranks.
#include "components/thermal/thermal.hpp"
#include "fluid_case.hpp"
#include "sph_contact_case.hpp"
#include "transfer/field_link.hpp"

namespace tenon::testing {
namespace {

double linear(const Vec3& x) {
  return 300 + 20 * x[0] - 30 * x[1] + 10 * x[2];
}

MaterialDescription warm(double youngs_modulus, double density) {
  MaterialDescription m = elastic_material(youngs_modulus, 0.2, density);
  m.thermal = ThermalProperties{0.2, 500, 293.15, 0.9};
  return m;
}

std::shared_ptr<const Mesh> shared(const Communicator& comm, MeshData data) {
  DistributeOptions by_place;
  by_place.method = PartitionMethod::rcb;
  return distribute(comm, std::move(data), by_place);
}

/// Particles of a solid in a box within the unit cube, not aligned with its elements.
std::unique_ptr<Sph> particles_in_cube(bool linear_temperature) {
  ParticleFill fill;
  fill.spacing = 0.1;
  SphOptions options;
  options.formulation = SphFormulation::total_lagrangian;
  options.bodies = {body_of("particles", warm(1e6, 1000))};
  if (linear_temperature) options.bodies[0].initial_temperature = of_place(linear);
  options.heat_conduction = true;
  return std::make_unique<Sph>(
      "particles", shared(communicator(), join_particles({{"particles", fill_box({0.1, 0.1, 0.1}, {1, 1, 1}, fill)}})),
      options);
}

transfer::FieldLinkOptions link_of(const std::string& from, const std::string& to) {
  transfer::FieldLinkOptions link;
  link.source_field = from, link.target_field = to;
  return link;
}

std::vector<double> field_of(Component& component, const std::string& name) {
  for (const ExportPort& port : component.exports())
    if (port.field.name == name) {
      const Mesh& mesh = component.mesh();
      std::vector<double> values(
          static_cast<std::size_t>(port.field.location == Location::node ? mesh.nodes() : mesh.elements()));
      port.read(values);
      return values;
    }
  ADD_FAILURE() << "no field " << name;
  return {};
}

TEST(FieldsOfParticles, LinearTemperatureOfAMeshIsExactOnThem) {
  Log log(false);
  Simulation simulation(communicator(), log, 0, 1);
  ThermalOptions options;
  options.blocks = {{"cube", 1000, 500, 0.2, 0}};
  options.stepper = ThermalStepper::backward_euler, options.fixed_step = 1;
  options.initial_function = linear;
  Component& mesh = simulation.add(std::make_unique<Thermal>(
      "conduction", shared(communicator(), beside({{"cube", brick({0, 0, 0}, {1.1, 1.1, 1.1}, {4, 3, 5})}})), options));
  Component& particles = simulation.add(particles_in_cube(false));
  simulation.add(std::make_unique<transfer::FieldLink>("warm", mesh, particles, link_of("temperature", "temperature")));
  simulation.initialize();
  const std::vector<double> temperature = field_of(particles, "temperature");
  double worst = 0;
  for (const LocalIndex n : particles.mesh().owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    worst = std::max(worst, std::abs(temperature[i] - linear(particles.mesh().coordinates[i])));
  }
  worst = communicator().max(worst);
  std::printf("mesh to particles, linear: %.1e K\n", worst);
  EXPECT_LE(worst, 1e-11);
}

TEST(FieldsOfParticles, TheirLinearTemperatureIsExactInElements) {
  Log log(false);
  Simulation simulation(communicator(), log, 0, 1);
  Component& particles = simulation.add(particles_in_cube(true));
  MechanicsOptions options;
  options.blocks = {of_material("cube", warm(1e6, 1000))};
  Component& mesh = simulation.add(std::make_unique<Mechanics>(
      "body", shared(communicator(), beside({{"cube", brick({0.1, 0.1, 0.1}, {1, 1, 1}, {4, 3, 5})}})), options));
  simulation.add(std::make_unique<transfer::FieldLink>("warm", particles, mesh, link_of("temperature", "temperature")));
  simulation.initialize();
  const std::vector<double> temperature = field_of(mesh, "temperature");
  double worst = 0;
  std::size_t e = 0;
  for (const ElementBlock& block : mesh.mesh().blocks)
    for (LocalIndex k = 0; k < block.size(); ++k, ++e) {
      Vec3 centre{};
      for (const LocalIndex n : block.nodes(k))
        centre = centre + 0.125 * mesh.mesh().coordinates[static_cast<std::size_t>(n)];
      worst = std::max(worst, std::abs(temperature[e] - linear(centre)));
    }
  worst = communicator().max(worst);
  std::printf("particles to elements, linear: %.1e K\n", worst);
  EXPECT_LE(worst, 1e-10);
}

/// A block of particles that slides over a plate. What friction makes of heat on either side goes to the other one.
class Rubbing {
 public:
  explicit Rubbing(const Communicator& comm = communicator(), const std::string& checkpoint = "")
      : run_(scene(), comm, checkpoint, [&](Simulation& simulation, Component& body, Component& particles) {
          ThermalOptions options;
          options.blocks = {{"plate", 1000, 500, 0.2, 0}};
          options.stepper = ThermalStepper::backward_euler, options.fixed_step = 5e-5;
          conduction_ = static_cast<Thermal*>(
              &simulation.add(std::make_unique<Thermal>("conduction", shared(comm, plate()), options)));
          body.contact_party()->contact_fields(), particles.contact_party()->contact_fields();
          simulation.add(std::make_unique<transfer::FieldLink>("to_plate", particles, *conduction_,
                                                               link_of("friction_heat", "heat")));
          simulation.add(
              std::make_unique<transfer::FieldLink>("to_particles", body, particles, link_of("friction_heat", "heat")));
        }) {}

  ParticlesOnMeshRun* operator->() { return &run_; }
  double row(const std::string& component, const std::string& name) {
    for (const LedgerRow& row : run_.simulation().ledger().take().rows)
      if (row.row == name && row.component == component) return row.value;
    ADD_FAILURE() << "no row " << name << " of " << component;
    return 0;
  }
  /// Temperatures of all particles, by id, on rank 0.
  std::vector<double> temperatures() {
    const ParticleData& p = run_.sph().particles();
    const Communicator& comm = run_.body().mesh().comm;
    const std::vector<GlobalId> ids = comm.gather(std::span<const GlobalId>(p.ids).first(p.owned()));
    const std::vector<double> all =
        comm.gather(std::span<const double>(p.find("temperature")->values).first(p.owned()));
    std::vector<double> ordered(all.size());
    for (std::size_t k = 0; k < ids.size(); ++k) ordered[static_cast<std::size_t>(ids[k])] = all[k];
    return ordered;
  }

 private:
  static MeshData plate() { return beside({{"plate", brick({0, 0, -0.01}, {0.06, 0.04, 0}, {6, 4, 1})}}); }
  static ParticlesOnMesh scene() {
    ParticlesOnMesh s;
    s.mesh = plate();
    s.mechanics.blocks = {of_material("plate", warm(40e6, 1000))};
    PrescribedMotion held;
    held.kind = PrescribedMotion::Kind::fixed, held.node_sets = {"plate_z_min"};
    s.mechanics.motions = {held};
    ParticleFill fill;
    fill.spacing = 0.004;
    s.particles = join_particles({{"block", fill_box({0.01, 0.01, 0}, {0.03, 0.03, 0.012}, fill)}});
    s.sph.formulation = SphFormulation::total_lagrangian;
    s.sph.bodies = {body_of("block", warm(40e6, 1000))};
    s.sph.bodies[0].initial_velocity[0] = SpaceTimeFunction::constant(5);
    s.sph.gravity[2] = TimeFunction::constant(-3000);
    s.sph.heat_conduction = true;
    s.contact.friction = {0.3, 0.3};
    s.end = 2e-3;
    return s;
  }

  Thermal* conduction_ = nullptr;
  ParticlesOnMeshRun run_;
};

TEST(FieldsOfParticles, HeatOfFrictionIsKeptBothWays) {
  Rubbing rubbing;
  rubbing->run();
  const double friction = rubbing.row("contact", "friction_energy");
  const double plate = rubbing.row("conduction", "thermal_energy"), block = rubbing.row("particles", "heat_received");
  std::printf("friction %.6e J: plate %.6e, particles %.6e, missing %.1e, ledger %.1e\n", friction, plate, block,
              1 - (plate + block) / friction, rubbing->ledger_error());
  EXPECT_GT(friction, 0);
  EXPECT_GT(block, 0.4 * friction);
  EXPECT_NEAR(plate + block, friction, 1e-12 * friction);
  EXPECT_LE(rubbing->ledger_error(), 1e-11);
}

TEST(FieldsOfParticles, SameBits) {
  Rubbing rubbing;
  rubbing->steps(60);
  const std::vector<double> all = rubbing.temperatures(), state = rubbing->state();
  if (communicator().rank() != 0) return;
  Rubbing alone(Communicator::self());
  alone->steps(60);
  EXPECT_GT(*std::max_element(all.begin(), all.end()), 293.15);
  EXPECT_EQ(all, alone.temperatures());
  EXPECT_EQ(state, alone->state());
}

TEST(FieldsOfParticles, SameBitsThroughARestart) {
  const std::string file = "particle-transfer-restart-" + std::to_string(communicator().size()) + ".h5";
  Rubbing through;
  through->steps(30);
  through->save(file);
  through->steps(30);
  Rubbing again(communicator(), file);
  again->steps(30);
  EXPECT_EQ(through.temperatures(), again.temperatures());
  EXPECT_EQ(through->ledger_error(), again->ledger_error());
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// The middle of a flying bar is torn apart, and its elements go on as particles: mass, momentum and energy are kept,
// and bits do not depend on ranks or restarts.
#include "sph_contact_case.hpp"

namespace tenon::testing {
namespace {

constexpr double length = 0.03, width = 0.006;  // m
constexpr double density = 2700;

/// Ends that are strong, and a middle that fails under tension.
ParticlesOnMesh scene() {
  ParticlesOnMesh s;
  s.mesh = beside({{"ends", brick({0, 0, 0}, {length, width, width}, {15, 3, 3})}});
  const BlockData all = s.mesh.blocks[0];
  BlockData strong = all, weak = all;
  weak.name = "middle", weak.label = 2;
  for (BlockData* b : {&strong, &weak}) b->connectivity.clear(), b->labels.clear();
  for (std::size_t e = 0; e < all.size(); ++e) {
    const double x = s.mesh.coordinates[static_cast<std::size_t>(all.connectivity[8 * e])][0];
    BlockData& to = x > 0.31 * length && x < 0.64 * length ? weak : strong;
    to.connectivity.insert(to.connectivity.end(), all.connectivity.begin() + static_cast<std::ptrdiff_t>(8 * e),
                           all.connectivity.begin() + static_cast<std::ptrdiff_t>(8 * e + 8));
    to.labels.push_back(all.labels[e]);
  }
  s.mesh.blocks = {strong, weak};
  s.mesh.side_sets.clear();
  const MaterialDescription metal = elastic_material(70e9, 0.3, density);
  MaterialDescription brittle = metal;
  brittle.failure.emplace().tensile_stress = 100e6;
  s.mechanics.blocks = {of_material("ends", metal), of_material("middle", brittle)};
  InitialVelocity apart{"", "", {20, 5, 0}, {}, {0.5 * length, 0, 0}};
  apart.gradient[0] = 3000;
  s.mechanics.initial_velocities = {apart};
  s.particles = join_particles({{"dust", particles_of_elements(s.mesh, "middle")}});
  SphBody dust = body_of("dust", liquid(density, 5000));
  dust.waits = true;
  s.sph.bodies = {dust};
  s.end = 2e-5;
  return s;
}

/// The run of the other cases, with the link between the two.
class DebrisRun {
 public:
  explicit DebrisRun(const Communicator& comm = communicator(), const std::string& checkpoint = "")
      : run_(scene(), comm, checkpoint, [](Simulation& simulation, Component& body, Component& particles) {
          simulation.add(std::make_unique<DebrisLink>("debris", body, "middle", particles, "dust"));
        }) {}
  ParticlesOnMeshRun& operator*() { return run_; }
  ParticlesOnMeshRun* operator->() { return &run_; }

  double mass() {
    ExactSum sum;
    for (const LocalIndex n : run_.body().mesh().owned_nodes)
      sum.add(run_.body().nodal_mass()[static_cast<std::size_t>(n)]);
    const ParticleData& p = run_.sph().particles();
    sum.add(std::span(p.mass.values).first(p.owned()));
    return run_.body().mesh().comm.sum(sum);
  }
  std::int64_t particles() {
    return run_.body().mesh().comm.sum(static_cast<std::int64_t>(run_.sph().particles().owned()));
  }

 private:
  ParticlesOnMeshRun run_;
};

TEST(Debris, MassMomentumAndEnergyAreKept) {
  DebrisRun run;
  const double mass = run.mass(), size = mass * 40;
  EXPECT_EQ(run.particles(), 0);
  double worst = 0;
  run->run([&] {
    worst = std::max(worst, norm(run->momentum() - run->start()) / size);
    EXPECT_NEAR(run.mass(), mass, 1e-14 * mass);
  });
  std::printf("debris: %lld of 45 elements became particles, momentum lost %.1e, ledger %.1e\n",
              static_cast<long long>(run.particles()), worst, run->ledger_error());
  EXPECT_GT(run.particles(), 20);
  EXPECT_LE(worst, 1e-13);
  EXPECT_LE(run->momentum_residual(), 1e-13);
  EXPECT_LE(run->ledger_error(), 1e-11);
}

TEST(Debris, SameBits) {
  DebrisRun run;
  run->steps(60);
  const std::vector<double> all = run->state();
  EXPECT_GT(run.particles(), 0);
  if (communicator().rank() != 0) return;
  DebrisRun alone(Communicator::self());
  alone->steps(60);
  EXPECT_EQ(all, alone->state());
}

TEST(Debris, SameBitsThroughARestart) {
  const std::string file = "debris-restart-" + std::to_string(communicator().size()) + ".h5";
  DebrisRun through;
  while (through.particles() == 0 && !through->simulation().done()) through->step();
  ASSERT_FALSE(through->simulation().done());
  through->save(file);
  through->steps(20);
  DebrisRun again(communicator(), file);
  EXPECT_GT(again.particles(), 0);
  again->steps(20);
  EXPECT_EQ(through->state(), again->state());
  EXPECT_EQ(through->ledger_error(), again->ledger_error());
}

/// What is said where elements of a block are to become particles.
std::string refusal(const ParticlesOnMesh& s, const std::string& block) {
  MeshData mesh = s.mesh;
  Mechanics body("body", distribute(communicator(), std::move(mesh), {}), s.mechanics);
  try {
    body.give_up(block);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Debris, WhatCannotBecomeParticlesIsRefused) {
  const auto expect = [](const std::string& said, const std::string& why) {
    EXPECT_NE(said.find(" cannot become particles: " + why), std::string::npos) << said;
  };
  EXPECT_EQ(refusal(scene(), "middle"), "");
  expect(refusal(scene(), "ends"), "they never fail; give their material a `failure`, or the component `erosion`");
  ParticlesOnMesh cycling = scene(), scaled = scene(), rigid = scene(), hot = scene(), shells = scene();
  cycling.mechanics.time_step.subcycling = 4;
  expect(refusal(cycling, "middle"), "the component has subcycling; leave it out");
  scaled.mechanics.loads.mass_scaling.emplace().time_step = 1e-7;
  RigidBody body;
  body.blocks = {"ends"}, body.label = "ends";
  rigid.mechanics.loads.rigid_bodies = {body};
  for (const ParticlesOnMesh* const s : {&scaled, &rigid})
    expect(refusal(*s, "middle"),
           "masses of the component belong to rigid bodies, ties or mass scaling; leave these out");
  hot.mechanics.heat = HeatMode::exported;
  expect(refusal(hot, "middle"), "their heat is given to another component (`heat: exported`); take `adiabatic`");
  PlateShape plate;
  shells.mesh = beside({{"plate", generate(plate)}});
  MaterialDescription metal = shells.mechanics.blocks[1].material;
  metal.failure.emplace().tensile_stress = 100e6;
  shells.mechanics = {};
  shells.mechanics.blocks = {of_material("plate", metal)};
  shells.mechanics.blocks[0].shell.thickness = 0.01;
  expect(refusal(shells, "plate"), "they are shells; solid elements can");
}

}  // namespace
}  // namespace tenon::testing

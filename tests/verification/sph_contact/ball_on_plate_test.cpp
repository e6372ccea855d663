// SPDX-License-Identifier: BSD-3-Clause
// A ball of particles hits a plate that floats freely: nothing is lost, nothing passes, and the bits do not depend on
// the ranks.
#include "sph_contact_case.hpp"

namespace tenon::testing {
namespace {

enum class Plate { hexahedra, shells };

constexpr double radius = 0.01, spacing = 0.002, edge = 0.05, half_thickness = 0.0025;  // m

ParticlesOnMesh scene(Plate plate, const Vec3& velocity, double friction = 0) {
  ParticlesOnMesh s;
  if (plate == Plate::hexahedra) {
    s.mesh = beside({{"plate", brick({0, 0, -half_thickness}, {edge, edge, half_thickness}, {9, 9, 2})}});
  } else {
    PlateShape shape;
    shape.length_x = shape.length_y = edge, shape.elements_x = shape.elements_y = 9;
    s.mesh = beside({{"plate", generate(shape)}});
  }
  s.mechanics.blocks = {of_material("plate", elastic_material(70e9, 0.3, 2700))};
  if (plate == Plate::shells) s.mechanics.blocks[0].shell.thickness = 2 * half_thickness;
  ParticleFill fill;
  fill.spacing = spacing;
  // Not above the middle, so that the plate turns.
  const Vec3 centre{0.6 * edge, 0.45 * edge, half_thickness + radius + spacing};
  s.particles = join_particles({{"ball", fill_region(ball_region(centre, 0, radius, 3), fill)}});
  SphBody ball = body_of("ball", liquid(1000, 1500));
  for (std::size_t c = 0; c < 3; ++c) ball.initial_velocity[c] = SpaceTimeFunction::constant(velocity[c]);
  s.sph.bodies = {ball};
  s.contact.friction = {friction, friction};
  s.end = 1.5e-4;
  return s;
}

/// Least height of the nodes of the plate that stood on its upper face, m.
double lowest_of_upper_face(const ParticlesOnMeshRun& run, double height) {
  const Mesh& mesh = const_cast<ParticlesOnMeshRun&>(run).body().mesh();
  const std::span<const Vec3> x = const_cast<ParticlesOnMeshRun&>(run).body().current_coordinates();
  double least = 1e300;
  for (const LocalIndex n : mesh.owned_nodes)
    if (mesh.coordinates[static_cast<std::size_t>(n)][2] >= height)
      least = std::min(least, x[static_cast<std::size_t>(n)][2]);
  return mesh.comm.min(least);
}

void hit(Plate plate, double friction) {
  ParticlesOnMeshRun run(scene(plate, {20, 0, -60}, friction));
  const double size = norm(run.start()), face = plate == Plate::hexahedra ? half_thickness : 0;
  double deepest = 1e300;
  const Vec3 before = run.momentum_of_particles();
  run.run([&] { deepest = std::min(deepest, run.lowest(2) - lowest_of_upper_face(run, face)); });
  const Vec3 after = run.momentum_of_particles();
  std::printf(
      "ball on %s, friction %.1f: %lld steps, momentum of the ball (%.5f, %.5f) -> (%.5f, %.5f), lost %.1e, "
      "residual %.1e, ledger %.1e, deepest %.3f mm\n",
      plate == Plate::hexahedra ? "hexahedra" : "shells", friction, static_cast<long long>(run.simulation().steps()),
      before[0], before[2], after[0], after[2], norm(run.momentum() - run.start()) / size, run.momentum_residual(),
      run.ledger_error(), 1e3 * deepest);
  EXPECT_GT(after[2] - before[2], 0.3 * std::abs(before[2]));  // it did hit
  EXPECT_LE(norm(run.momentum() - run.start()), 1e-13 * size);
  EXPECT_LE(run.momentum_residual(), 1e-13);
  EXPECT_LE(run.ledger_error(), 1e-11);
  EXPECT_GT(deepest, 0);
  if (friction == 0 && plate == Plate::hexahedra) {
    EXPECT_NEAR(after[0], before[0], 0.02 * before[0]);
  }
  if (friction > 0) {
    EXPECT_LT(after[0], 0.95 * before[0]);
  }
}

TEST(BallOnPlate, Hexahedra) {
  hit(Plate::hexahedra, 0);
}

TEST(BallOnPlate, HexahedraWithFriction) {
  hit(Plate::hexahedra, 0.3);
}

TEST(BallOnPlate, Shells) {
  hit(Plate::shells, 0.3);
}

TEST(BallOnPlate, SameBits) {
  const ParticlesOnMesh s = scene(Plate::hexahedra, {20, 0, -60}, 0.3);
  ParticlesOnMeshRun run(s);
  run.steps(100);
  const std::vector<double> all = run.state();
  if (communicator().rank() != 0) return;
  ParticlesOnMeshRun alone(s, Communicator::self());
  alone.steps(100);
  EXPECT_EQ(all, alone.state());
}

TEST(BallOnPlate, SameBitsThroughARestart) {
  const ParticlesOnMesh s = scene(Plate::hexahedra, {20, 0, -60}, 0.3);
  const std::string file = "sph-contact-restart-" + std::to_string(communicator().size()) + ".h5";
  ParticlesOnMeshRun through(s);
  through.steps(60);
  through.save(file);
  through.steps(40);
  ParticlesOnMeshRun again(s, communicator(), file);
  again.steps(40);
  EXPECT_EQ(through.state(), again.state());
  EXPECT_EQ(through.ledger_error(), again.ledger_error());
}

// Particles of one component never touch each other as balls, however close they come.
TEST(BallOnPlate, ParticlesAreNoContactForEachOther) {
  ParticlesOnMesh s = scene(Plate::hexahedra, {0, 0, 0});
  s.end = 2e-5;
  ParticlesOnMeshRun run(s);
  run.run();
  for (const auto& [name, share] : run.contact().amounts())
    if (name.find("contacts") != std::string::npos) {
      EXPECT_EQ(communicator().sum(share), 0) << name;
    }
  EXPECT_LE(norm(run.momentum()), 1e-16);
}

}  // namespace
}  // namespace tenon::testing

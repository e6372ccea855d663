// SPDX-License-Identifier: BSD-3-Clause
// A block of particles that is tied to a plate goes where the plate goes, away from it and along it.
#include "sph_contact_case.hpp"

namespace tenon::testing {
namespace {

constexpr double edge = 0.03, half_thickness = 0.002, spacing = 0.002, side = 0.012;  // m

ParticlesOnMesh scene(bool tied) {
  ParticlesOnMesh s;
  s.mesh = beside({{"plate", brick({0, 0, -half_thickness}, {edge, edge, half_thickness}, {7, 7, 2})}});
  s.mechanics.blocks = {of_material("plate", elastic_material(70e9, 0.3, 2700))};
  s.mechanics.initial_velocities = {moving("plate", {4, 0, -6})};  // away from the block, and along it
  const Vec3 low{0.5 * (edge - side), 0.5 * (edge - side), half_thickness};
  ParticleFill fill;
  fill.spacing = spacing;
  s.particles = join_particles({{"block", fill_box(low, low + Vec3{side, side, 0.5 * side}, fill)}});
  s.sph.bodies = {body_of("block", liquid(1000, 1500))};
  s.contact.initial_overlaps = ContactOptions::InitialOverlaps::keep;
  if (tied) s.contact.pairs = {{"block", "plate", false, {}, true}};
  s.end = 4e-5;
  return s;
}

/// Way of the lowest layer of particles against the plate, whose mean way is taken: greatest of all, m.
double greatest_parting(ParticlesOnMeshRun& run) {
  const std::span<const Vec3> now = run.sph().current_coordinates();
  const Mesh& mesh = run.sph().mesh();
  const std::span<const Vec3> plate = run.body().current_coordinates();
  const Mesh& plate_mesh = run.body().mesh();
  std::array<ExactSum, 3> sums;
  for (const LocalIndex n : plate_mesh.owned_nodes)
    for (std::size_t c = 0; c < 3; ++c)
      sums[c].add(plate[static_cast<std::size_t>(n)][c] - plate_mesh.coordinates[static_cast<std::size_t>(n)][c]);
  Vec3 mean{};
  for (std::size_t c = 0; c < 3; ++c)
    mean[c] = plate_mesh.comm.sum(sums[c]) / static_cast<double>(plate_mesh.global_nodes);
  double greatest = 0;
  for (const LocalIndex n : mesh.owned_nodes) {
    const auto i = static_cast<std::size_t>(n);
    if (mesh.coordinates[i][2] > half_thickness + spacing) continue;
    greatest = std::max(greatest, norm(now[i] - mesh.coordinates[i] - mean));
  }
  return mesh.comm.max(greatest);
}

TEST(Tied, ParticlesFollowThePlate) {
  ParticlesOnMeshRun run(scene(true)), loose(scene(false));
  run.run();
  loose.run();
  const double parted = greatest_parting(run), without = greatest_parting(loose);
  const double size = norm(run.start());
  std::printf(
      "tied block: parts from the plate by %.4f spacings (without ties %.2f), momentum lost %.1e, ledger %.1e\n",
      parted / spacing, without / spacing, norm(run.momentum() - run.start()) / size, run.ledger_error());
  EXPECT_LT(parted, 0.05 * spacing);
  EXPECT_GT(without, 0.1 * spacing);
  EXPECT_LE(norm(run.momentum() - run.start()), 1e-13 * size);
  EXPECT_LE(run.momentum_residual(), 1e-13);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

}  // namespace
}  // namespace tenon::testing

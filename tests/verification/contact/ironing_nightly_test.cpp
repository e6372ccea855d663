// SPDX-License-Identifier: BSD-3-Clause
// Ironing on a finer slab, and by a cylinder of elements.
#include "ironing_case.hpp"

namespace tenon::testing {
namespace {

TEST(IroningNightly, DragEvensOutWithTheElements) {
  const Ironed coarse = iron_rigidly({}), fine = iron_rigidly({72, 16});
  EXPECT_LE(fine.off, 0.75 * coarse.off);
  EXPECT_LE(fine.coulomb, 1e-2);
}

TEST(IroningNightly, CylinderOfElements) {
  const Ironing ironing;
  ContactScene s = ironed_slab(ironing);
  AnnulusShape ring;
  ring.inner_radius = 0.015, ring.outer_radius = Ironing::radius, ring.length = Ironing::width;
  ring.radial = 2, ring.circumferential = 60, ring.axial = 2;
  // About y: (x, y, z) -> (x, z, -y), a rotation.
  MeshData die = placed(generate(ring), [](const Vec3& x) { return Vec3{x[0], x[2], -x[1]}; });
  const MeshData slab =
      brick({0, 0, -Ironing::height}, {Ironing::length, Ironing::width, 0}, {ironing.along, 1, ironing.deep});
  s.mesh = beside({{"slab", slab}, {"die", placed(std::move(die), shifted({0.035, 0, Ironing::radius}))}});
  s.mechanics.blocks.push_back(of_material("die", elastic_material(50e9, 0.3, 8000)));
  PrescribedMotion grip = motion(PrescribedMotion::Kind::displacement, {"die_inner"});
  grip.value[0] = ironing_way();
  grip.value[1] = TimeFunction::constant(0);
  grip.value[2] = ironing_depth();
  s.mechanics.motions.push_back(grip);
  ContactRun run(s);
  const double facet = 2 * std::numbers::pi * Ironing::radius / ring.circumferential;
  check_ironing(run, "slab_die", (ironing.element() + facet) / 8, "cylinder of elements");
}

}  // namespace
}  // namespace tenon::testing

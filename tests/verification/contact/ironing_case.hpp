// SPDX-License-Identifier: BSD-3-Clause
// Ironing: a stiff cylinder is pressed into an elastic slab and dragged over it, across the edges of many elements.
#pragma once

#include "contact_case.hpp"

namespace tenon::testing {

struct Ironing {
  static constexpr double length = 0.09, height = 0.02, width = 0.005, radius = 0.02, depth = 1e-3, friction = 0.3;
  static constexpr double pressed = 2e-3, dragged = 8e-3, way = 0.025;  // s, s, m
  int along = 36, deep = 8;
  double element() const { return length / along; }
};

inline ContactScene ironed_slab(const Ironing& i) {
  ContactScene s;
  s.mesh =
      beside({{"slab", brick({0, 0, -Ironing::height}, {Ironing::length, Ironing::width, 0}, {i.along, 1, i.deep})}});
  MechanicsOptions& o = s.mechanics;
  // Nearly incompressible: else shear moves the pressure forwards under the cylinder, whose normals then tilt the load.
  o.blocks = {of_material("slab", elastic_material(1e9, 0.45, 1000))};
  o.hourglass.form = HourglassOptions::Form::stiffness;
  o.motions = {motion(PrescribedMotion::Kind::fixed, {"slab_z_min"}), symmetry("slab_y_min", {0, 1, 0}),
               symmetry("slab_y_max", {0, 1, 0})};
  // The slab would ring for long after the start: a tenth of critical damping in its slowest mode.
  o.loads.damping.mass = 0.2 * std::sqrt(1e9 / 1000) * std::numbers::pi / (2 * Ironing::height);
  s.contact.friction = {Ironing::friction, Ironing::friction};
  s.end = Ironing::pressed + Ironing::dragged;
  return s;
}

inline TimeFunction ironing_way() {
  return TimeFunction::smooth_step(0, Ironing::way, Ironing::pressed, Ironing::pressed + Ironing::dragged);
}
inline TimeFunction ironing_depth() {
  return TimeFunction::smooth_step(0, -Ironing::depth, 0, Ironing::pressed);
}

/// Over windows of the way: greatest deviation of drag/load from mu, least and greatest load, N; over all of it: drag,
/// load, N; across/along: greatest deviation from mu of the forces across and along the normals of a true cylinder.
struct Ironed {
  double off = 0, least = 1e300, greatest = 0, drag = 0, load = 0, coulomb = 0;
};

inline Ironed drag_over(ContactRun& run, const std::string& pair) {
  Ironed ironed;
  // The tip sticks at first, while the surface under it shears: one way of the width of contact and it slides.
  const double start = Ironing::pressed + 0.25 * Ironing::dragged, end = run.simulation().end_time();
  const TimeFunction way = ironing_way();
  run.run(start);
  constexpr int windows = 24;
  for (int w = 0; w < windows; ++w) {
    const Vec3 before = run.impulse(pair);
    const double from = run.time();
    double along = 0, across = 0;
    run.run(start + (end - start) * (w + 1) / windows, [&] {
      const Vec3 axis{0.035 + way(run.time()), 0, Ironing::radius - Ironing::depth};
      const std::vector<double> f = field(run.body(), "contact_force");
      for (std::size_t n = 0; n < f.size() / 3; ++n) {
        const Vec3 x = run.body().current_coordinates()[n] - axis;
        const double r = std::hypot(x[0], x[2]);
        along += (f[3 * n] * x[0] + f[3 * n + 2] * x[2]) / r, across += (f[3 * n + 2] * x[0] - f[3 * n] * x[2]) / r;
      }
    });
    const Vec3 given = (1 / (run.time() - from)) * (run.impulse(pair) - before);
    const double drag = std::abs(given[0]), load = std::abs(given[2]);
    ironed.off = std::max(ironed.off, std::abs(drag / load / Ironing::friction - 1));
    ironed.least = std::min(ironed.least, load), ironed.greatest = std::max(ironed.greatest, load);
    ironed.drag += drag / windows, ironed.load += load / windows;
    if (w + 1 < windows)  // in the last one the cylinder comes to rest, and nodes stick
      ironed.coulomb = std::max(ironed.coulomb, std::abs(std::abs(across / along) / Ironing::friction - 1));
  }
  return ironed;
}

/// `blur` (m): how well meshes know the place of the pressure. It tilts the load by blur/R, which changes drag/load =
/// tan(atan mu + tilt) by (1 + mu^2) of that.
inline Ironed check_ironing(ContactRun& run, const std::string& pair, double blur, const char* what) {
  const Ironed ironed = drag_over(run, pair);
  constexpr double mu = Ironing::friction;
  std::printf(
      "ironing, %s: drag/load off mu by at most %.4f in a window, %.4f on the whole, across the true normals %.1e, "
      "load %.1f N, %.4f to %.4f of it; friction %.4f J, %lld steps\n",
      what, ironed.off, ironed.drag / ironed.load / mu - 1, ironed.coulomb, ironed.load, ironed.least / ironed.load,
      ironed.greatest / ironed.load, run.row("friction_energy"), static_cast<long long>(run.simulation().steps()));
  EXPECT_LE(ironed.off, (1 + mu * mu) / mu * blur / Ironing::radius);
  EXPECT_NEAR(ironed.drag / ironed.load, mu, 0.03 * mu);
  EXPECT_GE(ironed.least, 0.95 * ironed.load);
  EXPECT_LE(ironed.greatest, 1.05 * ironed.load);
  // What friction took is the drag over the way, but for what the start stored in shear.
  EXPECT_NEAR(run.row("friction_energy"), mu * ironed.load * Ironing::way, 0.1 * mu * ironed.load * Ironing::way);
  expect_conserved(run, false);
  return ironed;
}

/// Under a rigid cylinder. By Coulomb the forces across its normals are mu times those along them, wherever the
/// pressure is: to what the cylinder turns away in a step.
inline Ironed iron_rigidly(const Ironing& i) {
  ContactScene s = ironed_slab(i);
  RigidSurface die;
  die.name = "die", die.shape = RigidSurface::Shape::cylinder;
  die.point = {0.035, 0, Ironing::radius}, die.direction = {0, 1, 0}, die.radius = Ironing::radius;
  die.displacement[0] = ironing_way(), die.displacement[2] = ironing_depth();
  s.contact.rigid_surfaces = {die};
  ContactRun run(s);
  const Ironed ironed = check_ironing(run, "slab_die", i.element() / 8, "rigid cylinder");
  // No node of the slab is inside the cylinder.
  const Vec3 axis{0.035 + Ironing::way, 0, Ironing::radius - Ironing::depth};
  for (const Vec3& x : run.body().current_coordinates())
    EXPECT_GE(std::hypot(x[0] - axis[0], x[2] - axis[2]), Ironing::radius * (1 - 1e-6));
  return ironed;
}

}  // namespace tenon::testing

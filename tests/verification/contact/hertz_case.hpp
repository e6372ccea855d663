// SPDX-License-Identifier: BSD-3-Clause
// Case C02: an elastic ball and a rigid plane. By Hertz F = 4/3 E* sqrt(R) d^1.5, a = sqrt(R d), p0 = 2 E*/pi sqrt(d/R)
// [Her82]; of a ball, no half-space, to the first order of a/R.
#pragma once

#include "depth.hpp"

namespace tenon::testing {

constexpr double ball_radius = 0.01, ball_modulus = 1e9, ball_ratio = 0.3;
constexpr double ball_star = ball_modulus / (1 - ball_ratio * ball_ratio);  // E*, Pa

/// What theory says of a contact of radius a: force, N; approach of plane and centre, m; greatest pressure, Pa.
struct HertzContact {
  double radius, force, approach, pressure;
};

/// Hertz's approach a^2/R is that of two half-spaces. A ball whose centre is at rest is stiffer: with the pressure of
/// Hertz on both poles (p_n its Legendre coefficients; of a small cap by the Bessel function of the same argument) its
/// surface moves by the closed solution of the sphere [Lur64], which in the limit of great n is that of the
/// half-space. The approach is such that the mean gap, weighted by the pressure, is zero: <u> + <r^2>/2R, <r^2> =
/// 2 a^2/5.
inline HertzContact hertz(double a) {
  const double r = ball_radius, nu = ball_ratio, shear = ball_modulus / (2 * (1 + nu)),
               p0 = 2 * ball_star * a / (std::numbers::pi * r), force = 2.0 / 3 * std::numbers::pi * a * a * p0;
  double work = 0;
  double k = 0;
  for (int i = 0; k < 100; ++i) {  // terms fall with k^-4
    const double n = 2.0 * i;
    k = (n + 0.5) * a / r;
    const double p = (2 * n + 1) * p0 * a * a / (r * r) * (std::sin(k) - k * std::cos(k)) / (k * k * k);
    const double u = i == 0 ? p * r * (1 - 2 * nu) / ball_modulus
                            : p * r / (2 * shear) * (2 * n * n * (1 - nu) + nu * n - 1 + 2 * nu) /
                                  ((n - 1) * (n * n + n + 1 + nu * (2 * n + 1)));
    work += p * u / (2 * n + 1);
  }
  return {a, force, 2 * std::numbers::pi * r * r * work / force + 0.2 * a * a / r, p0};
}

/// The contact at an approach, by halving.
inline HertzContact hertz_at(double approach) {
  double low = 0, high = 2 * std::sqrt(ball_radius * approach);
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (hertz(middle).approach < approach ? low : high) = middle;
  }
  return hertz(high);
}

inline double half_space_force(double approach) {
  return 4.0 / 3 * ball_star * std::sqrt(ball_radius) * std::pow(approach, 1.5);
}

/// A distance by which intervals of `element`, `first` of them equal and the others growing geometrically, reach 1 m
/// in `count` steps after `place * count` of them.
inline double graded(double place, double count, double first, double element) {
  double low = 1 + 1e-9, high = 4;
  const auto reach = [&](double g, double steps) { return element * g * (std::pow(g, steps) - 1) / (g - 1); };
  for (int i = 0; i < 80; ++i) {
    const double g = 0.5 * (low + high);
    (reach(g, count - first) < 1 - first * element ? low : high) = g;
  }
  const double n = place * count;
  return n <= first ? n * element : first * element + reach(low, n - first);
}

/// Quarter of the lower half of a ball that stands on its pole at the origin: a quarter of a cylinder whose disks
/// become caps. Elements are of equal size about the pole (where the map of the disk
/// shrinks it by the root of 2) and grow away from it.
inline MeshData half_ball(double element) {
  CylinderShape shape;
  const double even = 2.4e-3;  // m, of equal elements about the pole
  const int fine = static_cast<int>(even / element + 0.5), inner = fine / 2, grow = (fine + 3) / 2;
  shape.radius = 1, shape.length = 1, shape.fraction = 0.25;
  shape.core = 2 * inner, shape.shell = fine - inner + grow, shape.axial = inner + grow + 1;
  MeshData mesh = generate(shape);
  const double rings = inner + shape.shell, relative = element / ball_radius;
  for (Vec3& x : mesh.coordinates) {
    const double r = std::hypot(x[0], x[1]);
    const double far = r > 0 ? graded(std::min(r, 1.0), rings, fine, std::numbers::sqrt2 * relative) / r : 0;
    const double s = std::min(far * r, 1.0), z = 1 - graded(x[2], shape.axial, inner, relative);
    const double scale = ball_radius * far * std::sqrt(1 - 0.5 * z * z);
    x = {scale * x[0], scale * x[1], ball_radius * (1 - z * std::sqrt(1 - 0.5 * s * s))};
  }
  return mesh;
}

/// The plane is lifted against the pole at up to 0.2 m/s while the equator is held.
inline ContactScene pressed_ball(double element, double approach) {
  ContactScene s;
  s.mesh = beside({{"ball", half_ball(element)}});
  s.end = 1.875 * approach / 0.2;  // the greatest slope of a quintic step is 1.875
  MechanicsOptions& o = s.mechanics;
  o.blocks = {of_material("ball", elastic_material(ball_modulus, ball_ratio, 1000))};
  o.hourglass.form = HourglassOptions::Form::stiffness;
  o.motions = {symmetry("ball_x_min", {1, 0, 0}), symmetry("ball_y_min", {0, 1, 0}), symmetry("ball_top", {0, 0, 1})};
  RigidSurface plane = rigid_plane("plane", {0, 0, 0}, {0, 0, 1});
  plane.displacement[2] = TimeFunction::smooth_step(0, approach, 0, s.end);
  s.contact.rigid_surfaces = {plane};
  return s;
}

/// Greatest distance from the axis of nodes of the foot that touch, m; on one rank.
inline double touching_radius(ContactRun& run, double lifted) {
  double radius = 0;
  for (const Vec3& x : nodes_of(run.body(), "ball_bottom"))
    if (x[2] - lifted < 1e-7) radius = std::max(radius, std::hypot(x[0], x[1]));
  return radius;
}

/// Pressure in the element at the pole, Pa; on one rank.
inline double pole_pressure(ContactRun& run) {
  const std::vector<double> stress = field(run.body(), "stress");
  const ElementBlock& ball = run.body().mesh().blocks[0];
  double nearest = 1e300, pressure = 0;
  for (LocalIndex e = 0; e < ball.size(); ++e) {
    Vec3 centre{};
    for (const LocalIndex n : ball.nodes(e))
      centre = centre + 0.125 * run.body().mesh().coordinates[static_cast<std::size_t>(n)];
    if (norm(centre) < nearest) nearest = norm(centre), pressure = -stress[6 * static_cast<std::size_t>(e) + 2];
  }
  return pressure;
}

/// Greatest deviation of the force from theory at any approach above `from` (m), relative: from where the radius of
/// contact spans three elements, below which single nodes show (4 % at two and a half). Forces are means over windows:
/// waves in the ball and hits of single nodes are no part of the law.
inline double press_ball(double element, double approach, double from) {
  const ContactScene scene = pressed_ball(element, approach);
  const TimeFunction lift = scene.contact.rigid_surfaces[0].displacement[2];
  ContactRun run(scene);
  std::vector<double> times{0}, impulses{0};
  run.run(scene.end, [&] {
    times.push_back(run.time());
    impulses.push_back(std::abs(run.impulse("ball_plane")[2]));
  });
  double worst = 0;
  const std::size_t window = times.size() / 120,
                    first = static_cast<std::size_t>(
                        std::ranges::find_if(times, [&](double t) { return lift(t) >= from; }) - times.begin());
  for (std::size_t i = std::max(first, window); i + window < times.size(); i += window) {
    const double force = 4 * (impulses[i + window] - impulses[i - window]) / (times[i + window] - times[i - window]),
                 d = lift(times[i]), exact = hertz_at(d).force;
    worst = std::max(worst, std::abs(force / exact - 1));
    if ((i / window) % 5 == 0)
      std::printf("C02 element %.2f mm: at %.3f mm %.2f N, %.4f of a ball, %.4f of half-spaces\n", 1e3 * element,
                  1e3 * d, force, force / exact, force / half_space_force(d));
  }
  const HertzContact exact = hertz_at(approach);
  const double radius = touching_radius(run, lift(run.time())), pressure = pole_pressure(run);
  std::printf(
      "C02 force off by at most %.4f, radius %.4f mm of %.4f, pressure %.2f MPa of %.2f; %lld steps of %lld "
      "elements\n",
      worst, 1e3 * radius, 1e3 * exact.radius, 1e-6 * pressure, 1e-6 * exact.pressure,
      static_cast<long long>(run.simulation().steps()), static_cast<long long>(run.body().mesh().global_elements));
  EXPECT_LE(worst, 0.03);
  EXPECT_NEAR(radius, exact.radius, 0.5 * element);
  EXPECT_NEAR(pressure, exact.pressure, 0.06 * exact.pressure);
  EXPECT_LE(run.momentum_residual(), 1e-13);
  EXPECT_LE(run.ledger_error(), 1e-11);
  return worst;
}

}  // namespace tenon::testing

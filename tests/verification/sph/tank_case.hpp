// SPDX-License-Identifier: BSD-3-Clause
// Water at rest in a tank against its hydrostatic pressure, and a dam break against experiments [KO96].
#pragma once

#include <gtest/gtest.h>

#include "dam_break_case.hpp"

namespace tenon::testing {

struct Rest {
  double spacing, width, height, end;  ///< m, s
  bool pressed = true;                 ///< at the start: else gravity grows during the first second [AHA12], damped
};

struct RestEnd {
  double pressure = 0;  ///< root of the mean square of the error below the uppermost support, over that at the bottom
  double force = 0;     ///< mean over the second half, over the weight
  double speed = 0;     ///< greatest, over sqrt(g H)
  double rise = 0;      ///< of the uppermost particle, over the spacing
  double lost = 0;      ///< particles outside
  double ledger = 0;
};

inline SphScene at_rest(const Rest& rest) {
  SphScene scene =
      water({rest.width, rest.height, 0}, {rest.width, 1.2 * rest.height, 0}, rest.spacing, rest.pressed ? 0.3 : 1);
  if (rest.pressed) return scene;
  scene.options.bodies[0].initial_pressure.reset();
  scene.options.gravity[1] = TimeFunction::smooth_step(0, -gravity, 0, 1);
  return scene;
}

inline RestEnd end_of_rest(const Rest& rest) {
  SphRun run(at_rest(rest));
  double weight = 0, count = 0;
  const auto force = [&] {
    if (run.time() < 0.5 * rest.end || run.simulation().steps() % 20 != 0) return;
    ++count;
    weight -= run.sum([](const ParticleData& p, std::size_t i) {
      return p.body[i] == 1 ? p.mass[i] * p.acceleration[3 * i + 1] : 0;
    });
  };
  run.run(rest.end, force);
  const ParticleData& all = run.particles();
  const Column& pressure = *all.find("pressure");
  const double bottom = density * gravity * rest.height;
  const auto inside = [&](const ParticleData& p, std::size_t i) {
    return p.body[i] == 0 && p.position[3 * i + 1] < rest.height - 2.6 * rest.spacing;
  };
  const double wrong = run.sum([&](const ParticleData& p, std::size_t i) {
    const double difference = pressure[i] / bottom - (1 - p.position[3 * i + 1] / rest.height);
    return inside(p, i) ? difference * difference : 0;
  });
  const double number = run.sum([&](const ParticleData& p, std::size_t i) { return inside(p, i) ? 1 : 0; });
  RestEnd found;
  double top = 0;
  for (std::size_t i = 0; i < all.owned(); ++i)
    if (all.body[i] == 0)
      found.speed = std::max(found.speed, norm(all.velocity.vec(i))), top = std::max(top, all.position[3 * i + 1]);
  found.speed = run.comm().max(found.speed) / std::sqrt(gravity * rest.height);
  found.rise = run.comm().max(top) / rest.spacing - (rest.height / rest.spacing - 0.5);
  found.pressure = std::sqrt(wrong / number), found.force = weight / count / (bottom * rest.width);
  found.lost = run.sum([&](const ParticleData& p, std::size_t i) {
    const Vec3 x = p.position.vec(i);
    return p.body[i] == 0 && (x[0] < 0 || x[0] > rest.width || x[1] < 0 || x[1] > 1.2 * rest.height);
  });
  found.ledger = run.ledger_error();
  if (communicator().rank() == 0)
    std::printf("%g m apart, %g s: pressure %.3f %%, force %+.3f %%, speed %.1e, rise %.2f, lost %g, ledger %.1e\n",
                rest.spacing, run.time(), 100 * found.pressure, 100 * (found.force - 1), found.speed, found.rise,
                found.lost, found.ledger);
  return found;
}

/// `speed`: what may be left of it, over sqrt(g H).
inline void expect_rest(const RestEnd& found, double speed = 1e-3) {
  EXPECT_LE(found.pressure, 0.02);
  EXPECT_NEAR(found.force, 1, 0.01);
  EXPECT_LE(found.speed, speed);
  EXPECT_LE(std::abs(found.rise), 0.5);
  EXPECT_EQ(found.lost, 0);
  EXPECT_LE(found.ledger, 1e-11);
}

/// A column of 1 m by 2 m breaks; fronts of the experiment as x/L over t sqrt(2 g/L).
inline void expect_the_dam_to_break(double spacing) {
  SphRun run(water({1, 2, 0}, {4, 3, 0}, spacing, 0.05));
  const double scale = std::sqrt(2 * gravity);
  const std::array<std::array<double, 2>, 6> experiment{
      {{1.153, 1.505}, {1.537, 1.892}, {1.935, 2.241}, {2.323, 2.615}, {2.719, 3.003}, {3.096, 3.624}}};
  const auto front = [&] {
    double x = 0;
    const ParticleData& p = run.particles();
    for (std::size_t i = 0; i < p.owned(); ++i)
      if (p.body[i] == 0) x = std::max(x, p.position[3 * i]);
    return run.comm().max(x);
  };
  double worst = 0;
  const auto look = [&] {
    const ParticleData& p = run.particles();
    for (std::size_t i = 0; i < p.owned(); ++i)
      if (p.body[i] == 0) worst = std::max(worst, std::abs(p.density[i] / density - 1));
  };
  const auto energy = [&] { return run.row("kinetic_energy") + run.row("internal_energy") - run.row("gravity_work"); };
  double before = energy();
  const double size = density * gravity * 2;
  for (const auto& [t, z] : experiment) {
    run.run(t / scale, look);
    const double at = front() + 0.5 * spacing, now = energy();
    if (communicator().rank() == 0)
      std::printf("T %.3f: front %.3f, experiment %.3f (%+.1f %%), mechanical energy %.1f J\n", t, at, z,
                  100 * (at / z - 1), now);
    EXPECT_LE(now, before + 1e-6 * size);
    before = now;
    if (t > 3) continue;
    EXPECT_GE(at, 0.98 * z);
    EXPECT_LE(at, 1.10 * z);
  }
  worst = run.comm().max(worst);
  const double half = 0.5 * spacing;  // where the particles of the wall begin
  const double outside = run.sum([&](const ParticleData& p, std::size_t i) {
    return p.body[i] == 0 &&
           (p.position[3 * i] < -half || p.position[3 * i] > 4 + half || p.position[3 * i + 1] < -half);
  });
  const double ledger = run.ledger_error();
  if (communicator().rank() == 0)
    std::printf("density %.2f %%, outside %g, ledger %.1e, steps %lld\n", 100 * worst, outside, ledger,
                static_cast<long long>(run.simulation().steps()));
  EXPECT_LE(worst, 0.02);
  EXPECT_EQ(outside, 0);
  EXPECT_LE(ledger, 1e-11);
}

}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Water at rest in a tank against its hydrostatic pressure, and a dam break against experiments [KO96].
#include <gtest/gtest.h>

#include "dam_break_case.hpp"

namespace tenon::testing {
namespace {

TEST(Hydrostatics, PressureAndForceOnTheBottom) {
  const double spacing = 0.05, height = 1, width = 0.5, exact = density * gravity * height * width;
  SphRun run(water({width, height, 0}, {width, 1.2, 0}, spacing, 0.3));
  double weight = 0, count = 0;
  const auto force = [&] {
    if (run.time() < 1 || run.simulation().steps() % 20 != 0) return;
    ++count;
    weight -= run.sum([](const ParticleData& p, std::size_t i) {
      return p.body[i] == 1 ? p.mass[i] * p.acceleration[3 * i + 1] : 0;
    });
  };
  run.run(2, force);
  weight /= count;
  const ParticleData& all = run.particles();
  const Column& pressure = *all.find("pressure");
  const auto inside = [&](const ParticleData& p, std::size_t i) {
    return p.body[i] == 0 && p.position[3 * i + 1] < height - 2.6 * spacing;
  };
  const double wrong = run.sum([&](const ParticleData& p, std::size_t i) {
    const double difference = pressure[i] - density * gravity * (height - p.position[3 * i + 1]);
    return inside(p, i) ? difference * difference : 0;
  });
  const double number = run.sum([&](const ParticleData& p, std::size_t i) { return inside(p, i) ? 1 : 0; });
  double fastest = 0, top = 0;
  for (std::size_t i = 0; i < all.owned(); ++i)
    if (all.body[i] == 0)
      fastest = std::max(fastest, norm(all.velocity.vec(i))), top = std::max(top, all.position[3 * i + 1]);
  fastest = run.comm().max(fastest), top = run.comm().max(top);
  const double error = std::sqrt(wrong / number) / (density * gravity * height);
  if (communicator().rank() == 0)
    std::printf("pressure %.3f %%, force on the bottom %.2f N (%.2f), speed %.2e, top %.4f (%.4f) ledger %.1e\n",
                100 * error, weight, exact, fastest, top, height - 0.5 * spacing, run.ledger_error());
  EXPECT_LE(error, 0.02);
  EXPECT_NEAR(weight, exact, 0.01 * exact);
  EXPECT_LE(fastest, 1e-3 * std::sqrt(gravity * height));
  EXPECT_NEAR(top, height - 0.5 * spacing, 0.5 * spacing);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

TEST(DamBreak, FrontAndEnergy) {
  const double spacing = 0.05;
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
  for (const auto& [t, z] : experiment) {
    run.run(t / scale, look);
    const double at = front() + 0.5 * spacing;
    if (communicator().rank() == 0) std::printf("T %.3f: front %.3f, experiment %.3f\n", t, at, z);
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
  if (communicator().rank() == 0)
    std::printf(
        "density %.2f %%, outside %g, rows: kinetic %.1f internal %.1f viscosity %.1f, ledger %.1e, steps %lld\n",
        100 * worst, outside, run.row("kinetic_energy"), run.row("internal_energy"), run.row("viscosity_energy"),
        run.ledger_error(), static_cast<long long>(run.simulation().steps()));
  EXPECT_LE(worst, 0.02);
  EXPECT_EQ(outside, 0);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

}  // namespace
}  // namespace tenon::testing

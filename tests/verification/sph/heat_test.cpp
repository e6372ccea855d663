// SPDX-License-Identifier: BSD-3-Clause
// Heat between particles against exact solutions of one-dimensional slabs, and that none is lost.
#include <gtest/gtest.h>

#include "solid_case.hpp"

namespace tenon::testing {
namespace {

constexpr double conductivity = 50, capacity = 500, density = 8000, slab = 0.1;  // W/(m K), J/(kg K), kg/m^3, m
constexpr double diffusivity = conductivity / (density * capacity);

MaterialDescription steel() {
  MaterialDescription material = elastic_solid(density, 200e9, 0.3);
  ThermalProperties thermal;
  thermal.conductivity = conductivity, thermal.specific_heat = capacity, thermal.reference_temperature = 300;
  material.thermal = thermal;
  return material;
}

/// 350 K + 100 K cos(pi x/L).
class CosineTemperature final : public Formula {
 public:
  double value(double, const Vec3& x) const override { return 350 + 100 * std::cos(std::numbers::pi * x[0] / slab); }
};

/// A slab with adiabatic ends between mirrors, of one or two dimensions, at rest.
SphScene slab_scene(int across, int dimension) {
  SphScene scene;
  ParticleBox box;
  box.dimension = dimension;
  box.particles = {across, dimension > 1 ? 6 : 1, 1};
  box.low = {0, 0, 0}, box.high = {slab, dimension > 1 ? 6 * slab / across : 0, 0};
  scene.mesh = particle_bodies({{"slab", generate(box)}});
  scene.options.bodies = {body_of("slab", steel())};
  scene.options.dimension = dimension;
  scene.options.formulation = SphFormulation::solid;
  scene.options.heat_conduction = true;
  scene.options.smoothing = 1.6;
  for (std::size_t c = 0; c < static_cast<std::size_t>(dimension); ++c)
    scene.options.domain.axes[c].low = box.low[c], scene.options.domain.axes[c].high = box.high[c];
  scene.end = 1e9;
  return scene;
}

/// L2 error of the temperature where a cosine has decayed to about a third: T = 350 + 100 cos(pi x/L) exp(-a pi^2
/// t/L^2).
double error_of_cosine(int across, int dimension) {
  SphScene scene = slab_scene(across, dimension);
  constexpr double k = std::numbers::pi / slab, end = 1 / (diffusivity * k * k);
  const double dt = 0.1 * (slab / across) * (slab / across) / diffusivity;
  scene.options.bodies[0].initial_temperature = SpaceTimeFunction::formula(std::make_shared<CosineTemperature>());
  const auto steps = static_cast<int>(std::ceil(end / dt));
  scene.options.time_step.fixed = end / steps;
  SphRun run(scene);
  const double total = run.row("thermal_energy");
  EXPECT_GT(total, 0);
  run.steps(steps);
  const double amplitude = 100 * std::exp(-diffusivity * k * k * run.time());
  const double squares = run.sum([&](const ParticleData& p, std::size_t i) {
    const double difference = p.find("temperature")->values[i] - (350 + amplitude * std::cos(k * p.position[3 * i]));
    return difference * difference;
  });
  EXPECT_LE(run.ledger_error(), 1e-11);
  EXPECT_NEAR(run.row("thermal_energy"), total, 1e-12 * total);
  return std::sqrt(squares / run.sum([](const ParticleData&, std::size_t) { return 1.0; })) / 100;
}

TEST(ParticleHeat, CosineDecaysWithTheSecondOrder) {
  const double coarse = error_of_cosine(10, 1), fine = error_of_cosine(20, 1), finer = error_of_cosine(40, 1);
  const double order = std::log2(coarse / finer) / 2;
  if (communicator().rank() == 0)
    std::printf("1-D: errors %.3e %.3e %.3e of the amplitude, order %.2f\n", coarse, fine, finer, order);
  EXPECT_LT(finer, 2e-3);
  EXPECT_GT(order, 1.7);
}

// A block on a crooked lattice, with free surfaces, half hot and half cold: what one loses the other gains.
TEST(ParticleHeat, NoneIsLostOnACrookedLattice) {
  SphScene scene = slab_scene(12, 2);
  scene.options.domain = {};
  scene.options.displaced = [](const Vec3& x) {
    return Vec3{1e-3 * std::sin(900 * x[1]), 1e-3 * std::sin(700 * x[0] + 1), 0};
  };
  scene.options.bodies[0].initial_temperature = SpaceTimeFunction::formula(std::make_shared<CosineTemperature>());
  scene.options.time_step.fixed = 0.5;
  SphRun run(scene);
  const double before = run.row("thermal_energy");
  const auto extremes = [&] {
    const std::vector<double> T = run.gathered("temperature");
    const auto [low, high] = std::ranges::minmax_element(T);
    return T.empty() ? std::pair{350.0, 350.0} : std::pair{*low, *high};
  };
  const auto [low, high] = extremes();
  run.steps(300);
  const auto [low_after, high_after] = extremes();
  EXPECT_NEAR(run.row("thermal_energy"), before, 1e-12 * before);
  EXPECT_LE(run.ledger_error(), 1e-11);
  EXPECT_GE(low_after, low);
  EXPECT_LE(high_after, high);
  EXPECT_LE(high_after - low_after, 0.8 * (high - low) + (high == low ? 1 : 0));
}

// Ends held at 400 K and 300 K: a straight line between the middles of the held particles, and as much heat comes as
// goes.
TEST(ParticleHeat, SteadyFlowBetweenHeldEnds) {
  SphScene scene;
  const int across = 20, held = 3;
  const double spacing = slab / across;
  const auto line = [&](double low, int count) {
    ParticleBox box;
    box.dimension = 1, box.particles = {count, 1, 1};
    box.low = {low, 0, 0}, box.high = {low + count * spacing, 0, 0};
    return generate(box);
  };
  scene.mesh =
      particle_bodies({{"hot", line(-held * spacing, held)}, {"slab", line(0, across)}, {"cold", line(slab, held)}});
  scene.options.bodies = {body_of("hot", steel()), body_of("slab", steel()), body_of("cold", steel())};
  scene.options.bodies[0].held_temperature = TimeFunction::constant(400);
  scene.options.bodies[2].held_temperature = TimeFunction::constant(300);
  scene.options.bodies[1].initial_temperature = SpaceTimeFunction::constant(350);
  scene.options.dimension = 1;
  scene.options.formulation = SphFormulation::solid;
  scene.options.heat_conduction = true;
  scene.options.time_step.fixed = 0.2 * spacing * spacing / diffusivity;
  scene.end = 1e9;
  SphRun run(scene);
  run.steps(4000);
  const std::vector<double> T = run.gathered("temperature"), x = run.gathered("position");
  if (communicator().rank() == 0) {
    const auto first = static_cast<std::size_t>(held + 5), last = static_cast<std::size_t>(held + across - 6);
    const double slope = (T[last] - T[first]) / (x[3 * last] - x[3 * first]);
    std::printf("held ends: slope %.4f of 100 K over the slab\n", -slope * slab / 100);
    EXPECT_NEAR(-slope * slab / 100, 1, 0.06);
    EXPECT_NEAR(T[static_cast<std::size_t>(held) + across / 2] + T[static_cast<std::size_t>(held) + across / 2 - 1],
                700, 1e-6);
  }
  EXPECT_LE(run.ledger_error(), 1e-11);
}

}  // namespace
}  // namespace tenon::testing

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

/// L2 error of the temperature where a cosine has decayed to about a third: T = 300 + 100 cos(pi x/L) exp(-a pi^2
/// t/L^2).
double error_of_cosine(int across, int dimension) {
  SphScene scene = slab_scene(across, dimension);
  constexpr double k = std::numbers::pi / slab, end = 1 / (diffusivity * k * k);
  const double dt = 0.2 * (slab / across) * (slab / across) / diffusivity / 2;
  scene.options.bodies[0].initial_temperature =
      SpaceTimeFunction(Formula("300 + 100*cos(31.41592653589793*x)", SpaceTimeFunction::variables()));
  const auto steps = static_cast<int>(std::ceil(end / dt));
  scene.options.time_step.fixed = end / steps;
  SphRun run(scene);
  run.steps(steps);
  const double amplitude = 100 * std::exp(-diffusivity * k * k * run.time());
  const double squares = run.sum([&](const ParticleData& p, std::size_t i) {
    const double difference = p.find("temperature")->values[i] - (300 + amplitude * std::cos(k * p.position[3 * i]));
    return difference * difference;
  });
  EXPECT_LE(run.ledger_error(), 1e-11);
  EXPECT_LE(std::abs(run.row("thermal_energy")), 1e-11 * density * capacity * slab * 100);
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

}  // namespace
}  // namespace tenon::testing

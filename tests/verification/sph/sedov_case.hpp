// SPDX-License-Identifier: BSD-3-Clause
// Sedov's blast [Sed59]: unit energy at a point of cold gas of density one, gamma = 1.4.
#pragma once

#include "components/sph/smoothing_kernel.hpp"
#include "shock_case.hpp"

namespace tenon::testing {

/// At t = 0.05 s; radius (E t^2/(alpha rho))^(1/5) with alpha = 0.851072.
struct SedovSolution {
  static constexpr double end = 0.05, radius = 0.311598, kinetic = 0.218726;
};

/// `across` particles along the edge of a unit cube about the blast; its octant between mirrors, or all of it.
inline SphScene sedov(int across, bool octant) {
  SphScene scene = gas_scene(3);
  const double spacing = 1.0 / across, low = octant ? 0 : -0.5, reach = spacing;
  scene.mesh = particle_bodies({{"gas", box_of_particles({low, low, low}, {0.5, 0.5, 0.5}, spacing, 3)}});
  // The energy is spread by a kernel; its sum over the particles is one in all.
  const auto weight = [=](const Vec3& x) { return WendlandC2::w<3>(norm(x) / reach); };
  double sum = 0;
  for (const Vec3& x : scene.mesh.coordinates) sum += weight(x);
  const double share = octant ? 0.125 : 1, mass = spacing * spacing * spacing;
  SphBody gas = body_of("gas", ideal_gas(1, 1.4));
  gas.initial_energy = of_place([=](const Vec3& x) { return 1e-6 / 0.4 + share * weight(x) / (sum * mass); });
  scene.options.bodies = {gas};
  scene.options.artificial_conduction = 0;  // which would carry the heat of the middle far
  for (ParticleDomain::Axis& axis : scene.options.domain.axes) axis.low = low, axis.high = 0.5;
  scene.end = SedovSolution::end;
  return scene;
}

struct SedovEnd {
  double radius = 0;   ///< where the density is half way to its peak, outside, of means over shells
  double peak = 0;     ///< greatest density of a particle
  double kinetic = 0;  ///< share of the energy
};

inline SedovEnd run_sedov(const SphScene& scene) {
  SphRun run(scene);
  run.run(scene.end);
  const double kinetic = run.row("kinetic_energy"), inner = run.row("internal_energy");
  EXPECT_LE(run.ledger_error(), 1e-11);
  const std::vector<double> x = run.gathered("position"), rho = run.gathered("density");
  SedovEnd end;
  end.kinetic = kinetic / (kinetic + inner);
  if (communicator().rank() != 0) return end;
  constexpr int shells = 80;
  std::array<double, shells> sum{}, count{};
  for (std::size_t i = 0; i < rho.size(); ++i) {
    const double r = std::hypot(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    end.peak = std::max(end.peak, rho[i]);
    const auto shell = static_cast<std::size_t>(r / 0.4 * shells);
    if (shell < shells) sum[shell] += rho[i], ++count[shell];
  }
  double greatest = 0;
  const auto mean = [&](std::size_t s) { return count[s] > 0 ? sum[s] / count[s] : 0; };
  for (std::size_t s = 0; s < shells; ++s) greatest = std::max(greatest, mean(s));
  const double half = 0.5 * (1 + greatest);
  for (std::size_t s = 1; s < shells; ++s)
    if (mean(s - 1) > half && mean(s) <= half)
      end.radius = 0.4 / shells * (static_cast<double>(s) - 0.5 + (mean(s - 1) - half) / (mean(s - 1) - mean(s)));
  std::printf("Sedov: r2 %.4f peak %.3f (of means %.3f) kinetic %.4f; %lld steps\n", end.radius, end.peak, greatest,
              end.kinetic, static_cast<long long>(run.simulation().steps()));
  return end;
}

}  // namespace tenon::testing

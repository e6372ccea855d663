// SPDX-License-Identifier: BSD-3-Clause
// Sedov's blast [Sed59]: unit energy at a point of cold gas of density one, gamma = 1.4.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

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
  double radius = 0;      ///< where the pressure is half way to its peak behind the front, of means over shells
  double of_density = 0;  ///< likewise of the density
  double peak = 0;        ///< greatest density of a particle
  double kinetic = 0;     ///< share of the energy
};

inline constexpr double shell_of_sedov = 0.005;  // m

/// Means over shells about the blast.
inline std::vector<double> shell_means(const std::vector<double>& x, const std::vector<double>& value) {
  constexpr std::size_t shells = 80;
  std::vector<double> mean(shells), count(shells);
  for (std::size_t i = 0; i < value.size(); ++i) {
    const double r = std::hypot(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    const auto shell = static_cast<std::size_t>(r / shell_of_sedov);
    if (shell < shells) mean[shell] += value[i], ++count[shell];
  }
  for (std::size_t s = 0; s < shells; ++s) mean[s] = count[s] > 0 ? mean[s] / count[s] : 0;
  return mean;
}

/// Outermost radius where means are half way from `before` to the greatest that there is behind the front. The hot
/// middle does not count.
inline double half_way(const std::vector<double>& mean, double before) {
  const auto behind = static_cast<std::ptrdiff_t>(0.9 * SedovSolution::radius / shell_of_sedov);
  const double half = 0.5 * (before + *std::max_element(mean.begin() + behind, mean.end()));
  double radius = 0;
  for (std::size_t s = 1; s < mean.size(); ++s)
    if (mean[s - 1] > half && mean[s] <= half)
      radius = shell_of_sedov * (static_cast<double>(s) - 0.5 + (mean[s - 1] - half) / (mean[s - 1] - mean[s]));
  return radius;
}

inline SedovEnd run_sedov(const SphScene& scene) {
  SphRun run(scene);
  run.run(scene.end);
  const double kinetic = run.row("kinetic_energy"), inner = run.row("internal_energy");
  EXPECT_LE(run.ledger_error(), 1e-11);
  const std::vector<double> x = run.gathered("position"), rho = run.gathered("density"), p = run.gathered("pressure");
  SedovEnd end;
  end.kinetic = kinetic / (kinetic + inner);
  if (communicator().rank() != 0) return end;
  end.radius = half_way(shell_means(x, p), 0);
  end.of_density = half_way(shell_means(x, rho), 1);
  for (const double r : rho) end.peak = std::max(end.peak, r);
  std::printf("Sedov: r2 %.4f (%+.2f %%; of the density %.4f) peak %.3f kinetic %.4f (%+.2f %%); %lld steps\n",
              end.radius, 100 * (end.radius / SedovSolution::radius - 1), end.of_density, end.peak, end.kinetic,
              100 * (end.kinetic / SedovSolution::kinetic - 1), static_cast<long long>(run.simulation().steps()));
  return end;
}

}  // namespace tenon::testing

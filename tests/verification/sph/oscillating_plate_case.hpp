// SPDX-License-Identifier: BSD-3-Clause
// A clamped plate that swings in its first bending mode (case B10, after [GMS01]).
#pragma once

#include "solid_case.hpp"

namespace tenon::testing {

struct Swing {
  double period = 0, amplitude = 0, decay = 0;  // s, m, share of the amplitude that a period takes
};

/// Length 0.2 m, `across` particles through the thickness of 0.02 m. The clamp is layers of the same material that do
/// not move and hold on to the plate; the plate begins where the outermost of them ends.
inline Swing swing(int across, double speed_factor, double periods,
                   const std::function<void(SphOptions&)>& change = {}) {
  constexpr double L = 0.2, H = 0.02, sound = 57.03, kL = 1.8751040687;
  const double spacing = H / across;
  const int layers = 4, along = 10 * across;
  ParticleBox box;
  box.dimension = 2;
  box.low = {0, -0.5 * H, 0}, box.high = {L, 0.5 * H, 0}, box.particles = {along, across, 1};
  const MeshData plate = generate(box);
  box.low[0] = -layers * spacing, box.high[0] = 0, box.particles[0] = layers;
  SphScene scene;
  scene.mesh = particle_bodies({{"plate", plate}, {"clamp", generate(box)}});
  const MaterialDescription material = elastic_solid(1000, 2e6, 0.3975);
  scene.options.bodies = {body_of("plate", material), body_of("clamp", material)};
  scene.options.bodies[0].bond = scene.options.bodies[1].bond = "clamped";
  scene.options.bodies[1].wall = true;
  scene.options.dimension = 2;
  scene.options.formulation = SphFormulation::total_lagrangian;
  scene.options.time_step.cfl = 0.5;
  const auto mode = [](double s) {
    return (std::cos(kL) + std::cosh(kL)) * (std::cosh(kL * s) - std::cos(kL * s)) +
           (std::sin(kL) - std::sinh(kL)) * (std::sinh(kL * s) - std::sin(kL * s));
  };
  scene.options.initial_velocity_function = [=](const Vec3& x) {
    return Vec3{0, speed_factor * sound * mode(x[0] / L) / mode(1), 0};
  };
  scene.end = 10;
  if (change) change(scene.options);
  SphRun run(scene);
  // The mean of the layer at the tip; it comes back through zero after half a period.
  std::vector<double> zeros, peaks;
  double before = 0, time_before = 0, peak = 0;
  const auto tip = [&] {
    return run.sum([&](const ParticleData& p, std::size_t i) {
      return p.find("origin")->values[3 * i] > L - spacing ? p.position[3 * i + 1] / across : 0.0;
    });
  };
  while (run.time() < 0.26 * periods + 0.01) {
    run.step();
    if (run.simulation().steps() % 4 != 0) continue;
    const double now = tip();
    peak = std::max(peak, std::abs(now));
    if (before * now < 0) {
      zeros.push_back(time_before + (run.time() - time_before) * before / (before - now));
      peaks.push_back(peak);
      peak = 0;
    }
    before = now, time_before = run.time();
  }
  Swing result;
  const std::size_t last = zeros.size() - 1;
  result.period = 2 * (last == 0 ? zeros[0] : (zeros[last] - zeros[0]) / static_cast<double>(last));
  result.amplitude = peaks[0];
  if (last >= 2) result.decay = 1 - std::pow(peaks[last] / peaks[0], 2.0 / static_cast<double>(last));
  if (communicator().rank() == 0)
    std::printf("%d across, V %.3g c0: period %.5f s, amplitude %.4f mm, decay %.2f %% a period, %lld steps\n", across,
                speed_factor, result.period, 1e3 * result.amplitude, 100 * result.decay,
                static_cast<long long>(run.simulation().steps()));
  return result;
}

}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Noh's implosion [Noh87]: gas without pressure rushes to a plane, an axis or a point and stands still behind a shock
// that runs outwards at a third of its speed; in front of it rho = (1 + t/r)^(d - 1).
#include <gtest/gtest.h>

#include "noh_case.hpp"

namespace tenon::testing {
namespace {

struct Planar {
  double density = 0, pressure = 0, shock = 0, error = 0, length = 0;
};

/// The plateau without the six particles at the wall, where heat is left over.
Planar planar(int particles, ArtificialViscosity::Switch limiter) {
  SphScene scene = noh(particles, 1);
  scene.options.artificial_viscosity.limiter = limiter;
  SphRun run(scene);
  run.run(scene.end);
  EXPECT_LE(run.ledger_error(), 1e-11);
  const std::vector<double> x = run.gathered("position"), rho = run.gathered("density"), p = run.gathered("pressure"),
                            h = run.gathered("smoothing_length"), m = run.gathered("mass");
  Planar end;
  double mass = 0, inside = 0;
  for (std::size_t i = 0; i < rho.size(); ++i) {
    const double at = x[3 * i], exact = at < 0.2 ? 4 : 1;
    if (rho[i] > 2.5) end.shock = std::max(end.shock, at);
    if (at < 0.35) end.error += m[i] / rho[i] * std::abs(rho[i] - exact), mass += m[i] / rho[i] * exact;
    if (i < 6 || at > 0.17) continue;
    end.density += rho[i], end.pressure += p[i], end.length += h[i], ++inside;
    if (limiter != ArtificialViscosity::Switch::none) continue;  // it rings a little
    EXPECT_NEAR(rho[i], 4, 0.02 * 4) << "at " << at;
  }
  end.density /= inside, end.pressure /= inside, end.length /= inside, end.error /= mass;
  if (communicator().rank() == 0)
    std::printf("Noh, plane, %d: rho %.4f p %.4f shock %.4f h %.5f L1 %.4f; %lld steps\n", particles, end.density,
                end.pressure, end.shock, end.length, end.error, static_cast<long long>(run.simulation().steps()));
  return end;
}

TEST(Noh, Planar) {
  for (const auto limiter : {ArtificialViscosity::Switch::none, ArtificialViscosity::Switch::cullen_dehnen}) {
    const Planar end = planar(200, limiter);
    if (communicator().rank() != 0) continue;
    EXPECT_NEAR(end.density, 4, 0.02 * 4);
    EXPECT_NEAR(end.pressure, 4.0 / 3, 0.02 * 4 / 3);
    EXPECT_NEAR(end.shock, 0.2, 2 * end.length);
  }
}

TEST(Noh, PlanarOrder) {
  const double coarse = planar(200, ArtificialViscosity::Switch::none).error,
               fine = planar(400, ArtificialViscosity::Switch::none).error;
  if (communicator().rank() != 0) return;
  EXPECT_NEAR(std::log2(coarse / fine), 1, 0.25);
}

}  // namespace
}  // namespace tenon::testing

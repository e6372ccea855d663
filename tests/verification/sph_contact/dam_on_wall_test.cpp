// SPDX-License-Identifier: BSD-3-Clause
// Case F11 [WKHD05]: a dam breaks, and its wave bends an elastic wall in the middle of the tank.
#include "water_case.hpp"

namespace tenon::testing {
namespace {

constexpr double L = 0.146, height = 0.08, width = 0.012;  // m
constexpr int across_wall = 4;                             // elements, and particles as large

/// Displacement of the upper left corner, m: mean of four published codes (Kratos; Meduri 2018; Ryzhakov 2010;
/// Cerquaglia 2019), every 0.02 s from 0.14 s on.
constexpr std::array<double, 22> published{0.00015, 0.01045, 0.02483, 0.03973, 0.04463, 0.04545, 0.04258, 0.03865,
                                           0.03393, 0.03020, 0.02718, 0.02445, 0.02210, 0.02018, 0.01945, 0.01838,
                                           0.01768, 0.01705, 0.01635, 0.01585, 0.01470, 0.01383};

double published_at(double t) {
  const double place = (t - 0.14) / 0.02;
  const auto before = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(before);
  return (1 - share) * published[before] + share * published[before + 1];
}

ParticlesOnMesh scene() {
  WaterShape water;
  water.spacing = L / std::lround(L / (width / across_wall)), water.sound = 10 * std::sqrt(2 * earth * 2 * L);
  water.high = {L, 2 * L, 0};
  water.room_low = Vec3{}, water.room_high = Vec3{4 * L, 3 * L, 0};
  ParticlesOnMesh s = with_water(water);
  s.sph.artificial_viscosity.alpha = 0.03;
  s.sph.fluid.density_diffusion = 0.1;
  s.mesh = beside({{"wall", thick_brick({2 * L, 0, 0}, {2 * L + width, height, 0}, across_wall,
                                        static_cast<int>(std::lround(height / width * across_wall)))}});
  s.mechanics.blocks = {of_material("wall", elastic_material(1e6, 0, 2500))};
  s.mechanics.hourglass.form = HourglassOptions::Form::physical;
  PrescribedMotion foot, plane;
  foot.node_sets = {"wall_y_min"};
  plane.node_sets = {"wall_z_min", "wall_z_max"}, plane.components = {false, false, true};
  s.mechanics.motions = {foot, plane};
  s.mechanics.loads.body_forces = {gravity({0, -earth, 0})};
  s.end = 0.56;
  return s;
}

TEST(DamBreak, BendsAnElasticWall) {
  ParticlesOnMeshRun run(scene());
  const Mesh& mesh = run.body().mesh();
  const auto corner = [&] {
    double u = -1e300;
    for (const LocalIndex n : mesh.owned_nodes) {
      const auto i = static_cast<std::size_t>(n);
      const Vec3& X = mesh.coordinates[i];
      if (X[1] > 0.999 * height && X[0] < 2 * L + 1e-9) u = std::max(u, run.body().current_coordinates()[i][0] - X[0]);
    }
    return mesh.comm.max(u);
  };
  double peak = 0, when = 0, first = 0, error = 0, worst_at = 0, before = 0, before_time = 0, least = 1;
  run.run([&] {
    const double u = corner(), t = run.time();
    if (first == 0 && u > 0.005) first = before_time + (t - before_time) * (0.005 - before) / (u - before);
    if (u > peak && t < 0.4) peak = u, when = t;
    least = std::min(least, u);
    if (t > 0.14 && t < 0.55 && std::abs(u - published_at(t)) > error)
      error = std::abs(u - published_at(t)), worst_at = t;
    before = u, before_time = t;
  });
  std::printf(
      "F11: peak %.1f mm at %.4f s, 5 mm at %.4f s, greatest deviation from the mean of four codes %.1f mm (%.1f %% of "
      "the peak) at %.3f s, least %.1f mm, momentum residual %.1e, ledger %.1e, %lld steps\n",
      1e3 * peak, when, first, 1e3 * error, 100 * error / 0.0455, worst_at, 1e3 * least, run.momentum_residual(),
      run.ledger_error(), static_cast<long long>(run.simulation().steps()));
  EXPECT_GE(peak, 0.040);
  EXPECT_LE(peak, 0.051);
  EXPECT_GE(when, 0.223 - 0.015);
  EXPECT_LE(when, 0.236 + 0.015);
  EXPECT_LE(error, 0.15 * 0.0455);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

}  // namespace
}  // namespace tenon::testing

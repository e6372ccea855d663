// SPDX-License-Identifier: BSD-3-Clause
// Case C06: axial crush of a thin aluminium tube. Mean force, length of the folds, no interpenetration.
#include "tube_case.hpp"

namespace tenon::testing {
namespace {

/// Least distance between nodes and shells that share no node with them nor with their neighbours, m.
double closest(Mechanics& body) {
  const ElementBlock& block = body.mesh().blocks[0];
  const std::span<const Vec3> x = body.current_coordinates();
  std::vector<std::vector<LocalIndex>> around(x.size());  // elements of each node
  for (LocalIndex e = 0; e < block.size(); ++e)
    for (const LocalIndex n : block.nodes(e)) around[static_cast<std::size_t>(n)].push_back(e);
  const std::vector<Triangle> triangles = triangles_of(body, "", "tube");  // four of each shell
  double least = 1e300;
  std::vector<char> near(static_cast<std::size_t>(block.size()));
  for (std::size_t n = 0; n < x.size(); ++n) {
    std::ranges::fill(near, char{0});
    for (const LocalIndex e : around[n])
      for (const LocalIndex m : block.nodes(e))
        for (const LocalIndex f : around[static_cast<std::size_t>(m)]) near[static_cast<std::size_t>(f)] = 1;
    for (std::size_t e = 0; e < near.size(); ++e)
      for (std::size_t k = 0; !near[e] && k < 4; ++k) least = std::min(least, distance(x[n], triangles[4 * e + k]));
  }
  return least;
}

/// Mean lengths along the undeformed tube between successive extrema of the mean radius of its rings, m: half folds.
double half_fold(Mechanics& body, const Tube& tube) {
  std::vector<double> radius(static_cast<std::size_t>(tube.along) + 1);
  const std::span<const Vec3> x = body.current_coordinates();
  for (std::size_t n = 0; n < x.size(); ++n)
    radius[n / static_cast<std::size_t>(tube.around)] += std::hypot(x[n][0], x[n][1]) / tube.around;
  std::vector<std::size_t> extrema;
  for (std::size_t k = 1; k + 1 < radius.size(); ++k) {
    const double step = tube.length / tube.along, up = radius[k] - radius[k - 1], on = radius[k + 1] - radius[k];
    if (up * on < 0 && std::max(std::abs(up), std::abs(on)) > 0.1 * step) extrema.push_back(k);
  }
  if (extrema.size() < 3) return 0;
  return tube.length / tube.along * static_cast<double>(extrema.back() - extrema.front()) /
         static_cast<double>(extrema.size() - 1);
}

TEST(TubeNightly, AxialCrush) {
  const Tube tube;
  ContactRun run(crush(tube));
  double least = 1e300, peak = 0;
  int looks = 0;
  Vec3 before{};
  double from = 0;
  run.run(run.simulation().end_time(), [&] {
    if (run.time() < 0.1 * (looks + 1) * run.simulation().end_time()) return;
    ++looks;
    least = std::min(least, closest(run.body()));
    const Vec3 impulse = run.impulse("tube_striker");
    peak = std::max(peak, std::abs(impulse[2] - before[2]) / (run.time() - from));
    before = impulse, from = run.time();
  });
  const double mean = std::abs(run.impulse("tube_striker")[2]) / run.time(), fold = half_fold(run.body(), tube);
  const double work = run.row("internal_energy"), hourglass = run.row("hourglass_energy");
  std::printf(
      "C06 mean force %.2f kN, half fold %.2f mm, closest %.3f mm, hourglass %.2f %% of internal, greatest mean "
      "of a tenth %.1f kN, %lld steps\n",
      1e-3 * mean, 1e3 * fold, 1e3 * least, 100 * hourglass / work, 1e-3 * peak,
      static_cast<long long>(run.simulation().steps()));
  EXPECT_GE(mean, 8.5e3);
  EXPECT_LE(mean, 13.5e3);
  EXPECT_GE(fold, 7e-3);
  EXPECT_LE(fold, 11e-3);
  EXPECT_GE(least, 0.5 * tube.thickness);
  EXPECT_LE(hourglass, 0.05 * work);
  // The striker's work is all there is.
  const double stored = work + run.row("kinetic_energy") + hourglass + run.row("viscosity_energy") +
                        run.row("contact_energy") + run.row("friction_energy") + run.row("contact_dissipation");
  EXPECT_NEAR(stored, mean * run.time() * tube.speed, 0.02 * stored);
  EXPECT_LE(run.momentum_residual(), 1e-13);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Case F09: a column of water stands on a clamped elastic plate from the start on.
#include "water_case.hpp"

namespace tenon::testing {
namespace {

constexpr double span = 1, thickness = 0.05, depth = 2, E = 67.5e9, nu = 0.34, plate_density = 2700;

ParticlesOnMesh scene() {
  const double spacing = span / 20, foot = 0.5 * thickness;
  ParticlesOnMesh s;
  WaterShape water;
  water.low = {0, foot, 0}, water.high = {span, foot + depth, 0};
  water.spacing = spacing, water.sound = 10 * std::sqrt(2 * earth * depth);
  s = with_water(water);
  // Mirrors at the sides: walls of particles would carry a share of the weight, by the gradient of the pressure in
  // them.
  s.sph.domain.axes[0].low = 0, s.sph.domain.axes[0].high = span;
  s.sph.artificial_viscosity.alpha = 0.3;
  s.sph.fluid.density_diffusion = 0;
  PlateShape plate;
  plate.length_x = span, plate.length_y = 1, plate.elements_x = 20, plate.elements_y = 1;
  s.mesh = beside(
      {{"plate", placed(placed(generate(plate), rotated({1, 0, 0}, 0.5 * std::numbers::pi)), shifted({0, 0, -0.5}))}});
  s.mechanics.blocks = {of_material("plate", elastic_material(E, nu, plate_density))};
  s.mechanics.blocks[0].shell.thickness = thickness;
  PrescribedMotion ends, plane;
  ends.node_sets = {"plate_x_min", "plate_x_max"};
  plane.node_sets = {"plate_y_min", "plate_y_max"}, plane.components = {false, false, true},
  plane.rotations = {true, true, false};
  s.mechanics.motions = {ends, plane};
  s.mechanics.loads.body_forces = {gravity({0, -earth, 0})};
  s.end = 1;
  return s;
}

TEST(WaterColumn, BendsAClampedPlate) {
  ParticlesOnMeshRun run(scene());
  const Mesh& mesh = run.body().mesh();
  const auto middle = [&] {
    double u = -1e300;
    for (const LocalIndex n : mesh.owned_nodes) {
      const auto i = static_cast<std::size_t>(n);
      const Vec3& X = mesh.coordinates[i];
      if (std::abs(X[0] - 0.5 * span) < 1e-6) u = std::max(u, X[1] - run.body().current_coordinates()[i][1]);
    }
    return mesh.comm.max(u);
  };
  const auto impulse = [&] {
    double total = 0;
    for (const auto& [name, share] : run.contact().amounts())
      if (name == "contact_plate_water_impulse_y") total = mesh.comm.sum(share);
    return total;
  };
  double sum = 0, from = 0, before = 0, start = 0, greatest = 0;
  run.run([&] {
    const double t = run.time(), u = middle();
    if (t > 0.3) {
      if (from == 0)
        from = t, start = impulse();
      else
        sum += (t - before) * u;
    }
    greatest = std::max(greatest, u);
    before = t;
  });
  const double stiffness = E * thickness * thickness * thickness / (12 * (1 - nu * nu));
  const double water = of_water * earth * depth, load = water + plate_density * earth * thickness;
  const double exact = load * span * span * span * span / (384 * stiffness), mean = sum / (run.time() - from);
  const double pressure = std::abs(impulse() - start) / (run.time() - from) / span;
  std::printf(
      "F09: mean deflection %.4e m of %.4e m (%+.2f %%), greatest %.3e m, pressure %.1f of %.1f Pa (%+.2f %%), ledger "
      "%.1e, %lld steps\n",
      mean, exact, 100 * (mean / exact - 1), greatest, pressure, water, 100 * (pressure / water - 1),
      run.ledger_error(), static_cast<long long>(run.simulation().steps()));
  EXPECT_NEAR(mean, exact, 0.05 * exact);
  EXPECT_NEAR(pressure, water, 0.03 * water);
  EXPECT_LE(run.ledger_error(), 1e-11);
}

}  // namespace
}  // namespace tenon::testing

// SPDX-License-Identifier: BSD-3-Clause
// Case C03: a stack of two blocks whose meshes do not match is pressed. Exact: the same stress everywhere.
#include "depth.hpp"

namespace tenon::testing {
namespace {

constexpr double side = 0.1, height = 0.05, modulus = 1e9, density = 1000, pressure = 1e6;
const double slowest = std::sqrt(modulus / density) * std::numbers::pi / (4 * height);  // rad/s

struct Stack {
  int refine = 1;
  bool skewed = false;  // lines of the interface meshes cross under an angle
};

/// Moves the inner nodes along x and y, nothing on the sides: the meshes of the interface become irregular.
MeshData skew(MeshData mesh, double strength) {
  for (Vec3& x : mesh.coordinates) {
    const double s = std::sin(std::numbers::pi * x[0] / side), t = std::sin(std::numbers::pi * x[1] / side);
    x = x + Vec3{strength * side * s * t, -0.7 * strength * side * s * t, 0};
  }
  return mesh;
}

ContactScene scene(const Stack& stack) {
  const int n = stack.refine;
  ContactScene s;
  MeshData under = brick({0, 0, 0}, {side, side, height}, {4 * n, 4 * n, 3 * n});
  MeshData over = brick({0, 0, height}, {side, side, 2 * height}, {3 * n, 3 * n, 2 * n});
  if (stack.skewed) under = skew(std::move(under), 0.08), over = skew(std::move(over), -0.1);
  s.mesh = beside({{"under", std::move(under)}, {"over", std::move(over)}});
  const MaterialDescription m = elastic_material(modulus, 0, density);
  MechanicsOptions& o = s.mechanics;
  o.blocks = {of_material("under", m), of_material("over", m)};
  o.hourglass.form = HourglassOptions::Form::stiffness;
  for (const char* body : {"under", "over"}) {
    const std::string name(body);
    o.motions.push_back(symmetry(name + "_x_min", {1, 0, 0}));
    o.motions.push_back(symmetry(name + "_y_min", {0, 1, 0}));
  }
  o.motions.push_back(symmetry("under_z_min", {0, 0, 1}));
  SurfaceLoad load;
  load.side_sets = {"over_z_max"}, load.value[0] = SpaceTimeFunction::constant(pressure), load.label = "pressure";
  o.loads.surface_loads = {load};
  o.loads.damping.mass = 2 * slowest;  // critical in the slowest mode
  s.end = 60 / slowest;
  return s;
}

/// Present area of the loaded top as seen along the load, m^2; on one rank.
double loaded_area(ContactRun& run) {
  double area = 0;
  for (const Triangle& t : triangles_of(run.body(), "over_z_max")) area += 0.5 * cross(t[1] - t[0], t[2] - t[0])[2];
  return area;
}

struct Result {
  double deviation, top, resultant;
};

/// Greatest relative deviation of the stress along z, mean settlement of the top, force between the blocks.
Result press(const Stack& stack, const char* what) {
  ContactRun run(scene(stack));
  // By the change of momentum of the upper block, on which nothing acts but the load, damping and the lower one.
  double before = 0, force = 0, from = 0;
  run.run(run.simulation().end_time(), [&] {
    const double p = run.momentum("over")[2];
    force = pressure * side * side + (p - before) / (run.time() - from) + slowest * (p + before);
    before = p, from = run.time();
  });
  const Mesh& mesh = run.body().mesh();
  const std::vector<double> stress = field(run.body(), "stress");
  Result r{};
  for (std::size_t e = 0; e < stress.size() / 6; ++e)
    r.deviation = std::max(r.deviation, std::abs(stress[6 * e + 2] + pressure) / pressure);
  const NodeSet& top = *mesh.find_node_set("over_z_max");
  for (const LocalIndex n : top.nodes)
    r.top += (run.body().current_coordinates()[static_cast<std::size_t>(n)][2] - 2 * height) /
             static_cast<double>(top.nodes.size());
  r.resultant = force;
  std::printf(
      "C03 %-28s stress off by at most %.2e, top %.6f of -1e-4 m, resultant of the last step off by %.1e, %lld steps\n",
      what, r.deviation, r.top / -1e-4, r.resultant / (pressure * side * side) - 1,
      static_cast<long long>(run.simulation().steps()));
  EXPECT_LE(run.ledger_error(), 1e-11);
  EXPECT_LE(run.momentum_residual(), 1e-13);
  EXPECT_LE(run.angular_residual(), 1e-13);
  EXPECT_NEAR(r.top, -1e-4, 0.005e-4);
  EXPECT_LE(r.deviation, 0.08);
  // The damper takes none of the force that contact tells: it would be 18 %. (Where the run still settles, the load
  // that the change of momentum is compared with is off by less than half a percent.)
  EXPECT_NEAR(norm(run.force("under_over")) / r.resultant, 1, 5e-3) << what;
  return r;
}

// Brought to rest by kinetic relaxation, with no damping force on any node: what contact tells is the load on the top,
// whose area changes a little where lines of the meshes are skewed.
TEST(ContactPatch, ResultantAtRest) {
  for (const bool skewed : {false, true}) {
    ContactScene s = scene({1, skewed});
    s.mechanics.loads.damping = {};
    s.mechanics.loads.relaxation.emplace().tolerance = 1e-12;
    s.end = 400 / slowest;
    ContactRun run(s);
    double residual = 1;
    while (!run.done() && residual > 1e-11) {
      run.step();
      for (const HistoryValue& value : run.body().history_values())
        if (value.column == "relaxation_residual") residual = value.local;
    }
    const double load = pressure * loaded_area(run), force = norm(run.force("under_over"));
    std::printf("C03 at rest%s: resultant off by %.1e of the load, forces in balance to %.1e after %lld steps\n",
                skewed ? ", skewed" : "", force / load - 1, residual, static_cast<long long>(run.simulation().steps()));
    // On skewed meshes some impulses remain as the iteration of contact leaves them (a ten-thousandth).
    EXPECT_LE(residual, skewed ? 1e-5 : 1e-11);
    EXPECT_NEAR(force, load, (skewed ? 1e-6 : 1e-10) * load);
  }
}

TEST(ContactPatch, NonMatchingFaces) {
  const double coarse = press({1, false}, "3x3x2 over 4x4x3").deviation;
  const double fine = press({2, false}, "6x6x4 over 8x8x6").deviation;
  EXPECT_LE(std::max(coarse, fine), 1e-4);  // what the iteration leaves; nothing to grow
}

TEST(ContactPatch, SkewedFaces) {
  const double coarse = press({1, true}, "the same, skewed").deviation;
  const double fine = press({2, true}, "the same, skewed, finer").deviation;
  EXPECT_LE(fine, coarse);  // it must not grow
}

}  // namespace
}  // namespace tenon::testing

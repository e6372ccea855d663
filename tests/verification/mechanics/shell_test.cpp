// SPDX-License-Identifier: BSD-3-Clause
// Shells in motion: patches, rigid rotation, bending frequency, hourglass modes, a fold, energies.
#include <numbers>

#include "shell_case.hpp"

namespace tenon::testing {
namespace {

constexpr double pi = std::numbers::pi;

/// Five quadrilaterals of the patch of [MH85], 0.24 x 0.12; the last four nodes are inside. `inner` are their ids.
MeshData patch() {
  MeshData mesh;
  mesh.source = "patch";
  mesh.coordinates = {{0, 0, 0},       {0.24, 0, 0},    {0.24, 0.12, 0}, {0, 0.12, 0},
                      {0.04, 0.02, 0}, {0.18, 0.03, 0}, {0.16, 0.08, 0}, {0.08, 0.08, 0}};
  for (std::int64_t n = 1; n <= 8; ++n) mesh.node_labels.push_back(n);
  mesh.blocks.push_back(
      {"patch", 1, ElementKind::quad4, {0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7, 4, 5, 6, 7}, {1, 2, 3, 4, 5}});
  return mesh;
}

/// The patch after one step in which all nodes take the displacement and rotation of a field (from rest to there).
std::unique_ptr<Mechanics> moved_patch(std::function<Vec3(const Vec3&)> u, std::function<Vec3(const Vec3&)> turn) {
  MechanicsOptions options;
  options.viscosity = {0, 0};
  options.initial_velocity_function = std::move(u);
  options.initial_spin_function = std::move(turn);
  auto body = shell_body(whole_mesh(patch()), elastic_material(1e6, 0.25, 1), section(0.001, 3), options);
  body->initialize();
  body->advance(1);
  return body;
}

// A01, membrane: u = 1e-3 (x + y/2, y + x/2), taken a millionfold smaller.
TEST(Shell, MembranePatch) {
  constexpr double small = 1e-6;
  const auto u = [](const Vec3& x) {
    return Vec3{small * 1e-3 * (x[0] + 0.5 * x[1]), small * 1e-3 * (x[1] + 0.5 * x[0]), 0};
  };
  const auto body = moved_patch(u, {});
  const std::vector<double> s = field(*body, "stress");
  const double exact[6] = {4000.0 / 3, 4000.0 / 3, 0, 400, 0, 0};
  for (std::size_t e = 0; e < 5; ++e)
    for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(s[6 * e + c] / small, exact[c], 1e-5) << e << " " << c;
  for (std::size_t n = 4; n < 8; ++n)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(body->internal_force()[n].v[c], 0, 1e-8 * small * 1333 * 0.001 * 0.1) << "node " << n;
}

// A01, constant curvature: w = 1e-3 (x^2 + x y + y^2)/2; moments of E t^3/12 kappa, no force inside.
TEST(Shell, BendingPatch) {
  constexpr double small = 1e-6;
  const auto w = [](const Vec3& x) { return Vec3{0, 0, small * 0.5e-3 * (x[0] * x[0] + x[0] * x[1] + x[1] * x[1])}; };
  const auto turn = [](const Vec3& x) {
    return Vec3{small * 1e-3 * (x[1] + 0.5 * x[0]), -small * 1e-3 * (x[0] + 0.5 * x[1]), 0};
  };
  const auto body = moved_patch(w, turn);
  // Surface stresses 0.667, 0.667, -+0.2; the outermost of three Gauss points lies at sqrt(3/5) of it.
  const double outer = std::sqrt(0.6);
  const std::vector<double> top = field(*body, "stress_top"), bottom = field(*body, "stress_bottom");
  const double exact[6] = {2.0 / 3, 2.0 / 3, 0, 0.2, 0, 0};
  for (std::size_t e = 0; e < 5; ++e)
    for (std::size_t c = 0; c < 6; ++c) {
      EXPECT_NEAR(top[6 * e + c] / small, -outer * exact[c], 1e-6) << e << " " << c;
      EXPECT_NEAR(bottom[6 * e + c] / small, outer * exact[c], 1e-6) << e << " " << c;
    }
  for (std::size_t n = 4; n < 8; ++n)
    EXPECT_NEAR(body->internal_force()[n].v[2], 0, 1e-6 * small * 0.667 * 0.001 * 0.001) << "node " << n;
}

// A02: a warped, stressed shell turned once round a skew axis, in steps of 1 and of 10 degrees.
void turn_around(int steps) {
  const auto warped = [](double r, double s) { return Vec3{r + 0.2 * r * s, s - 0.1 * r * r, 0.1 * r * s + 0.05 * r}; };
  MechanicsOptions options;
  PrescribedMotion m = motion(PrescribedMotion::Kind::rotation, {"all"});
  m.axis = {1, 2, 3}, m.centre = {0.3, -0.2, 0.1};
  m.factor = TimeFunction::table({{0, 0}, {1, 2 * pi}});
  options.motions = {m};
  options.time_step.fixed = 1.0 / steps;
  options.viscosity = {0, 0};
  const auto body =
      shell_body(shared_mesh(shell_grid({2, 2, ShellGrid::Cells::mixed}, warped)), steel(), section(0.01), options);
  body->initialize();
  double greatest = 0;
  for (int s = 0; s < steps; ++s) {
    body->advance(body->time_step());
    for (const char* name : {"stress_top", "stress_bottom"})
      for (const double x : field(*body, name)) greatest = std::max(greatest, std::abs(x));
  }
  EXPECT_LT(greatest, 210e9 * 1e-12 * steps) << steps << " steps";
  EXPECT_NEAR(energy_rows(*body)["hourglass_energy"], 0, 1e-12);
}

TEST(Shell, FullTurnLeavesNoStress) {
  turn_around(360);
  turn_around(36);
}

// A05: first bending mode of a cantilever 1.0 x 0.1 x t, 40 x 1 shells; frequency from the zero crossings of the tip.
double frequency(double t, int elements) {
  constexpr double length = 1, k = 1.8751040687119611;
  const double sigma = (std::cosh(k) + std::cos(k)) / (std::sinh(k) + std::sin(k));
  const auto shape = [=](double x) {
    return 0.05 * (std::cosh(k * x) - std::cos(k * x) - sigma * (std::sinh(k * x) - std::sin(k * x)));
  };
  const auto slope = [=](double x) {
    return 0.05 * k * (std::sinh(k * x) + std::sin(k * x) - sigma * (std::cosh(k * x) - std::cos(k * x)));
  };
  MechanicsOptions options;
  options.initial_velocity_function = [=](const Vec3& x) { return Vec3{0, 0, shape(x[0])}; };
  options.initial_spin_function = [=](const Vec3& x) { return Vec3{0, -slope(x[0]), 0}; };
  options.motions = {hold("r0", "xyzrxryrz")};
  const auto body = shell_body(shared_mesh(shell_grid({elements, 1},
                                                      [](double r, double s) {
                                                        return Vec3{length * r, 0.1 * s, 0};
                                                      })),
                               steel(), section(t), options);
  body->initialize();
  Ledger ledger(*body);
  double before = 0, crossing[3]{};
  int found = 0;
  while (found < 3) {
    body->advance(body->time_step());
    const double now = displacement_of(*body, "r1s0")[2];
    if (before * now < 0) crossing[found++] = body->time() - body->time_step() * now / (now - before);
    if (now != 0) before = now;
  }
  EXPECT_LT(ledger.error(), 1e-12);
  return 1 / (crossing[2] - crossing[0]);
}

TEST(Shell, BendingFrequency) {
  EXPECT_NEAR(frequency(0.1, 40) / 82.904, 1, 0.01) << "thickness 0.1 m, Timoshenko";
  EXPECT_NEAR(frequency(0.05, 40) / 41.776, 1, 0.01) << "thickness 0.05 m, Euler and Bernoulli";
}

// Order two of the frequency, by three meshes (A05).
TEST(Shell, BendingFrequencyConverges) {
  const double f[3] = {frequency(0.05, 5), frequency(0.05, 10), frequency(0.05, 20)};
  EXPECT_GT(std::log2(std::abs((f[1] - f[0]) / (f[2] - f[1]))), 1.8);
}

// A14: velocities in the pattern of an hourglass mode stay bounded and make no energy.
TEST(Shell, HourglassModesStayBounded) {
  for (int direction = 0; direction < 3; ++direction) {
    MechanicsOptions options;
    options.viscosity = {0, 0};
    const auto pattern = [](const Vec3& x) {
      return (static_cast<int>(std::lround(x[0] * 4)) + static_cast<int>(std::lround(x[1] * 4))) % 2 == 0 ? 1.0 : -1.0;
    };
    options.initial_velocity_function = [=](const Vec3& x) {
      Vec3 v{};
      v[static_cast<std::size_t>(direction)] = 0.1 * pattern(x);
      return v;
    };
    const auto body = shell_body(shared_mesh(shell_grid({4, 4},
                                                        [](double r, double s) {
                                                          return Vec3{r, s, 0};
                                                        })),
                                 steel(), section(0.05), options);
    body->initialize();
    Ledger ledger(*body);
    double first = 0, greatest = 0;
    for (int s = 0; s < 2000; ++s) {
      body->advance(body->time_step());
      const Vec3 u = displacement_of(*body, "r0s0");
      const double moved = norm(u);
      greatest = std::max(greatest, moved);
      if (s < 60) first = std::max(first, moved);
    }
    EXPECT_LT(greatest, 5 * first) << "direction " << direction;
    EXPECT_LT(ledger.error(), 1e-12);
  }
}

/// Rotating freely, plates and folds keep their energy, and drilling does not drift.
TEST(Shell, FoldTurnsFreely) {
  for (const double angle : {0.0, 0.5 * pi}) {
    const auto fold = [=](double r, double s) {
      return r <= 0.5 ? Vec3{r, s, 0} : Vec3{0.5 + (r - 0.5) * std::cos(angle), s, (r - 0.5) * std::sin(angle)};
    };
    MechanicsOptions options;
    options.initial_velocities.push_back({"", "", {}, {0, -25, 8, 25, 0, -12, -8, 12, 0}, {0.5, 0.5, 0}});
    const auto body = shell_body(shared_mesh(shell_grid({4, 4}, fold)), steel(), section(0.02), options);
    body->initialize();
    Ledger ledger(*body);
    const double start = energy_rows(*body)["kinetic_energy"];
    run_to(*body, 0.05);
    EXPECT_LT(ledger.error(), 1e-12);
    EXPECT_NEAR(energy_rows(*body)["kinetic_energy"] / start, 1, 5e-3) << "fold by " << angle;
    EXPECT_LT(energy_rows(*body)["hourglass_energy"], 1e-3 * start);
    const auto corner = [&](const char* set, bool now) {
      const auto n = static_cast<std::size_t>(body->mesh().find_node_set(set)->nodes.front());
      return now ? body->current_coordinates()[n] : body->mesh().coordinates[n];
    };
    const double before = norm(corner("r1s1", false) - corner("r0s0", false));
    EXPECT_NEAR(norm(corner("r1s1", true) - corner("r0s0", true)) / before, 1, 5e-3);
  }
}

/// A strip pulled beyond yield thins as volume is kept; its energy is that of the curve.
TEST(Shell, PlasticTensionThins) {
  MaterialDescription metal = copper();
  metal.thermal.reset();
  MechanicsOptions options;
  PrescribedMotion pull = motion(PrescribedMotion::Kind::displacement, {"r1"});
  pull.components = {true, false, false};
  pull.value[0] = TimeFunction::table({{0, 0}, {2e-2, 0.02}});
  options.motions = {pull, hold("r0", "x"), hold("s0", "y"), hold("all", "z")};
  const auto body = shell_body(shared_mesh(shell_grid({2, 2, ShellGrid::Cells::mixed},
                                                      [](double r, double s) {
                                                        return Vec3{0.1 * r, 0.1 * s, 0};
                                                      })),
                               metal, section(0.002), options);
  body->initialize();
  Ledger ledger(*body);
  run_to(*body, 2e-2);
  EXPECT_LT(ledger.error(), 1e-12);
  // sigma = 400e6 + 100e6 ep with ln(1.2) = ep + sigma/E.
  const double total = std::log(1.2), ep = (total - 400e6 / 117e9) / (1 + 100e6 / 117e9), sigma = 400e6 + 100e6 * ep;
  const std::vector<double> stress = field(*body, "stress"), eqps = field(*body, "eqps"), t = field(*body, "thickness");
  for (std::size_t e = 0; e < t.size(); ++e) {
    EXPECT_NEAR(stress[6 * e] / sigma, 1, 5e-3);
    EXPECT_NEAR(eqps[e] / ep, 1, 5e-3);
    EXPECT_NEAR(t[e] / (0.002 * std::exp(-0.5 * ep - 0.35 * sigma / 117e9)), 1, 2e-3);
  }
}

}  // namespace
}  // namespace tenon::testing
